# SPDX-License-Identifier: GPL-3.0-or-later
# Writes the font FILE as bytes of C into OUTPUT.
file(READ "${FILE}" bytes HEX)
string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
file(WRITE "${OUTPUT}" "#include \"figure/plot_font.h\"\nconst unsigned char plot_font[] = {${bytes}};\n"
                       "const size_t plot_font_size = sizeof plot_font;\n")
