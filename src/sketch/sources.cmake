# SPDX-License-Identifier: GPL-3.0-or-later
# The renderer's font, built in: as a file, for gnuplot and PDF, and as outlines.
set(font_folder ${PROJECT_SOURCE_DIR}/src/gl/font)
set(font Inter-Regular-subset.otf)
twinbox_embed(twinbox_sketch plot_font.c sketch/plot_font.h "unsigned char" font_ ${font_folder} ${font})

add_executable(make_outlines ${CMAKE_CURRENT_LIST_DIR}/tools/make_outlines.c)
target_include_directories(make_outlines PRIVATE ${PROJECT_SOURCE_DIR}/src)
target_link_libraries(make_outlines PRIVATE PkgConfig::FREETYPE)
add_custom_command(
    OUTPUT type_outlines.c
    COMMAND make_outlines ${font_folder}/${font} type_outlines.c
    DEPENDS make_outlines ${font_folder}/${font}
    VERBATIM)
target_sources(twinbox_sketch PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/type_outlines.c)
