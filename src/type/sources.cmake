# SPDX-License-Identifier: GPL-3.0-or-later
# The renderer's font, built in: as files, for PDF and SVG, and as outlines.
set(font_folder ${PROJECT_SOURCE_DIR}/src/gl/font)
twinbox_embed(twinbox_type embedded_fonts.c type/embedded_fonts.h "unsigned char" font_ ${font_folder}
              Inter-Regular-subset.otf Inter-Regular.otf)

set(outline_fonts ${font_folder}/Inter-Regular.otf ${font_folder}/Inter-SemiBold.otf
                  ${font_folder}/Inter-Regular-subset.otf)
add_executable(make_outlines ${CMAKE_CURRENT_LIST_DIR}/tools/make_outlines.c)
target_include_directories(make_outlines PRIVATE ${PROJECT_SOURCE_DIR}/src)
target_link_libraries(make_outlines PRIVATE PkgConfig::FREETYPE)
add_custom_command(
    OUTPUT type_outlines.c
    COMMAND make_outlines ${outline_fonts} type_outlines.c
    DEPENDS make_outlines ${outline_fonts}
    VERBATIM)
target_sources(twinbox_type PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/type_outlines.c)
