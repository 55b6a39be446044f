# SPDX-License-Identifier: GPL-3.0-or-later
# Writes the shaders FILES of folder FROM as C strings into OUTPUT: shape.vert becomes shader_shape_vert.
set(text "#include \"render/shaders.h\"\n")
foreach(file ${FILES})
    file(READ "${FROM}/${file}" source)
    # GLSL wants #version before all else but comments; C wants its quotes, backslashes and line ends escaped.
    string(REPLACE "\\" "\\\\" source "${source}")
    string(REPLACE "\"" "\\\"" source "${source}")
    string(REPLACE "\n" "\\n\"\n\"" source "${source}")
    string(REPLACE "." "_" name ${file})
    string(APPEND text "const char shader_${name}[] =\n\"${source}\";\n")
endforeach()
file(WRITE "${OUTPUT}" "${text}")
