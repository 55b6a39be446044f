# SPDX-License-Identifier: GPL-3.0-or-later
# The modules that a page runs (live/live.h), by clang for WebAssembly whatever the compiler of the program is. Without the
# option TWINBOX_LIVE they are empty.
set(module_folder ${CMAKE_CURRENT_BINARY_DIR}/live)
file(MAKE_DIRECTORY ${module_folder}/include)

# Fixed arithmetic: nothing contracted, nothing reordered, and no relaxed vectors, whose results are the machine's choice. The
# instructions are those of browsers that a page needs. With them, clang 14 wants to be told how errno is found.
set(module_flags --target=wasm32-wasi -std=c17 -D_XOPEN_SOURCE=700 -DNDEBUG -msimd128 -mbulk-memory -mnontrapping-fptoint -msign-ext
    -ftls-model=local-exec -ffp-contract=off -fno-trapping-math -fvisibility=hidden -ffunction-sections -fdata-sections -Wall -Wextra -ffile-prefix-map=${PROJECT_SOURCE_DIR}=.)
# The stack comes first, so that one that is too small traps instead of overwriting data. Memory ends at 1 GiB, beyond which
# malloc() fails: a page must not take the machine's.
set(module_link_flags --target=wasm32-wasi -fuse-ld=lld -mexec-model=reactor -Wl,--gc-sections,--strip-all,--stack-first,-z,stack-size=262144
    -Wl,--max-memory=1073741824,--export=_initialize)

# A linked module is made a tenth smaller. The features are those of module_flags; float operations stay as they are.
set(module_shrink_flags -O2 --enable-simd --enable-bulk-memory --enable-nontrapping-float-to-int --enable-sign-ext)

# Debian: clang-19, lld, wasi-libc, libclang-rt-19-dev-wasm32, binaryen. By clang 14, interior takes a sixth longer. Sets
# TWINBOX_LIVE_FOUND, TWINBOX_WASM_CLANG, the first one that links a program, and TWINBOX_WASM_OPT.
find_program(TWINBOX_WASM_OPT wasm-opt)
mark_as_advanced(TWINBOX_WASM_OPT)
if(NOT DEFINED TWINBOX_LIVE_FOUND OR NOT TWINBOX_WASM_OPT)
    set(found OFF)
    find_path(TWINBOX_WASM_XXHASH xxhash.h HINTS ${XXHASH_INCLUDEDIR})
    mark_as_advanced(TWINBOX_WASM_XXHASH)
    file(WRITE ${module_folder}/probe.c
         "#include <math.h>\n#include <stdlib.h>\nvoid _start(void) { free(malloc((size_t)sin(getenv(\"x\") != NULL))); }\n")
    foreach(name clang-19 clang clang-14)
        find_program(clang_${name} ${name} NO_CACHE)
        if(found OR NOT clang_${name} OR NOT TWINBOX_WASM_XXHASH OR NOT TWINBOX_WASM_OPT)
            continue()
        endif()
        execute_process(COMMAND ${clang_${name}} --target=wasm32-wasi -fuse-ld=lld -nostartfiles -o ${module_folder}/probe.wasm
                                ${module_folder}/probe.c -lm
                        RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET)
        if(NOT failed)
            set(found ON)
            set(TWINBOX_WASM_CLANG ${clang_${name}} CACHE INTERNAL "clang for WebAssembly")
        endif()
    endforeach()
    set(TWINBOX_LIVE_FOUND ${found} CACHE INTERNAL "what makes WebAssembly modules is installed")
endif()
option(TWINBOX_LIVE "Build the module for live pages (default: if what it needs is installed)"
       ${TWINBOX_LIVE_FOUND})
set(module_needs "clang, lld, wasi-libc, libclang-rt-dev-wasm32 and binaryen (tests/setup installs them)")
if(TWINBOX_LIVE AND NOT TWINBOX_LIVE_FOUND)
    message(FATAL_ERROR "TWINBOX_LIVE needs ${module_needs}; then configure in a fresh folder")
endif()

# What is compiled: the rooms below `live`, without files, threads, YAML and zip; of `methods` all but what needs them.
file(GLOB module_methods RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} CONFIGURE_DEPENDS methods/*.c)
list(FILTER module_methods EXCLUDE REGEX "/(adapter|exec|playback|registry)|_avx2")
list(TRANSFORM module_methods REPLACE "\\.c$" "")
set(module_sources ${module_methods}
    base/base base/hash base/json_write base/npy base/npz base/parse base/path base/settings base/stream base/yaml
    engine/box engine/broad_phase engine/contact_problem engine/world
    live/bundle live/describe live/live live/module/npz_bundle live/module/wasi
    nets/gns_net nets/kernels nets/kernels_scalar nets/net_file nets/network nets/scene_net_layers nets/subspace_net
    runs/contact_finder runs/framing runs/launch_check runs/record runs/simulate runs/trajectory runs/verdict runs/verdict_sound
    runs/verdict_words
    scenes/parameters scenes/scene scenes/scene_read scenes/scene_world)
# Where most of the time is spent; the rest is made small.
set(module_fast
    engine/box engine/broad_phase engine/contact_problem engine/world methods/block_lu methods/interior
    methods/interior_point methods/interior_scalar methods/islands methods/engine methods/soft_step
    methods/sweeps_lanes
    nets/kernels_scalar)

if(TWINBOX_LIVE)
    # Only this header of the host: those of its C library would be taken for wasi-libc's.
    configure_file(${TWINBOX_WASM_XXHASH}/xxhash.h ${module_folder}/include/xxhash.h COPYONLY)
    # module_object(<name of the source> <object> <flags>...)
    function(module_object name object)
        add_custom_command(
            OUTPUT ${object}
            COMMAND ${CMAKE_C_COMPILER_LAUNCHER} ${TWINBOX_WASM_CLANG} ${module_flags} ${ARGN} -I${CMAKE_CURRENT_SOURCE_DIR}
                    -isystem ${module_folder}/include -MD -MF ${object}.d -o ${object} -c ${CMAKE_CURRENT_SOURCE_DIR}/${name}.c
            DEPENDS ${name}.c DEPFILE ${object}.d COMMENT "Building ${name}.c for pages" VERBATIM)
    endfunction()
    set(objects)
    foreach(name ${module_sources})
        string(REPLACE "/" "_" object ${name})
        set(object ${module_folder}/${object}.o)
        if(name IN_LIST module_fast)
            module_object(${name} ${object} -O2)
        else()
            module_object(${name} ${object} -Oz)
        endif()
        list(APPEND objects ${object})
    endforeach()
    module_object(live/module/module_methods ${module_folder}/networks.o -Oz)
    module_object(live/module/module_methods ${module_folder}/plain.o -Oz -DLIVE_PLAIN)
    foreach(module networks plain)
        add_custom_command(
            OUTPUT ${module_folder}/${module}.wasm
            COMMAND ${TWINBOX_WASM_CLANG} ${module_link_flags} -o ${module_folder}/${module}.linked ${objects}
                    ${module_folder}/${module}.o -lm
            COMMAND ${TWINBOX_WASM_OPT} ${module_shrink_flags} -o ${module_folder}/${module}.wasm ${module_folder}/${module}.linked
            DEPENDS ${objects} ${module_folder}/${module}.o COMMENT "Linking ${module}.wasm" VERBATIM)
    endforeach()
else()
    message(STATUS "No live pages (TWINBOX_LIVE): they need ${module_needs}")
    file(WRITE ${module_folder}/networks.wasm "")
    file(WRITE ${module_folder}/plain.wasm "")
endif()
embed(live_modules.c live/live.h "unsigned char" live_ ${module_folder} networks.wasm plain.wasm)
