# SPDX-License-Identifier: GPL-3.0-or-later
# -DTWINBOX_PARTS=compare: libraries that few systems have are linked in, where they are installed as archives; what no
# command reaches is left out, whatever it refers to.
target_compile_definitions(twinbox_rooms PRIVATE TWINBOX_COMPARE_ONLY)
target_compile_options(twinbox_rooms PRIVATE -ffunction-sections -fdata-sections)
target_link_options(twinbox_rooms PUBLIC LINKER:--gc-sections LINKER:--as-needed)
find_library(JANSSON_ARCHIVE libjansson.a)
execute_process(COMMAND ${CMAKE_C_COMPILER} -print-file-name=libgomp.a OUTPUT_VARIABLE gomp OUTPUT_STRIP_TRAILING_WHITESPACE)
target_link_libraries(twinbox_rooms PUBLIC $<IF:$<BOOL:${JANSSON_ARCHIVE}>,${JANSSON_ARCHIVE},PkgConfig::JANSSON>)
if(CMAKE_C_COMPILER_ID STREQUAL "GNU" AND IS_ABSOLUTE "${gomp}")
    target_compile_options(twinbox_rooms PRIVATE -fopenmp)
    target_link_libraries(twinbox_rooms PUBLIC ${gomp})
else()
    target_link_libraries(twinbox_rooms PUBLIC OpenMP::OpenMP_C)
endif()
