# SPDX-License-Identifier: GPL-3.0-or-later
# Glyphs and shaders become C at build time. OpenGL itself is loaded at run time.
add_executable(make_atlas ${CMAKE_CURRENT_LIST_DIR}/tools/make_atlas.c)
target_include_directories(make_atlas PRIVATE ${PROJECT_SOURCE_DIR}/src)
target_link_libraries(make_atlas PRIVATE PkgConfig::FREETYPE)

set(fonts ${CMAKE_CURRENT_LIST_DIR}/font/Inter-Regular.otf
          ${CMAKE_CURRENT_LIST_DIR}/font/Inter-SemiBold.otf)
add_custom_command(
    OUTPUT font_atlas.c
    COMMAND make_atlas ${fonts} font_atlas.c
    DEPENDS make_atlas ${fonts}
    VERBATIM)
target_sources(twinbox_gl PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/font_atlas.c)

twinbox_embed(twinbox_gl shaders.c gl/shaders.h char shader_ ${PROJECT_SOURCE_DIR}/shaders
              rect.vert rect.frag shape.vert shape.frag text.vert text.frag)

# The contexts: only those that are built in.
foreach(kind osmesa egl)
    string(TOUPPER ${kind} name)
    if(TWINBOX_${name})
        set_property(SOURCE gl/context.c APPEND PROPERTY COMPILE_DEFINITIONS TWINBOX_${name})
    else()
        set_source_files_properties(gl/context_${kind}.c PROPERTIES HEADER_FILE_ONLY ON)
    endif()
endforeach()
