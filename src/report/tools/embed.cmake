# SPDX-License-Identifier: GPL-3.0-or-later
# Writes the FILES of folder FROM as C strings into OUTPUT: page.css becomes report_page_css.
set(text "#include \"report/page.h\"\n")
foreach(file ${FILES})
    file(READ "${FROM}/${file}" bytes HEX)
    string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
    string(REPLACE "." "_" name ${file})
    string(APPEND text "const char report_${name}[] = {${bytes}0};\n")
endforeach()
file(WRITE "${OUTPUT}" "${text}")
