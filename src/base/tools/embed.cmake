# SPDX-License-Identifier: GPL-3.0-or-later
# Writes the FILES of folder FROM as arrays of TYPE ("char", "unsigned char") into OUTPUT. With PREFIX shader_, shape.vert
# becomes shader_shape_vert, ended by a 0; beside bytes (unsigned char) stands their number, NAME_size. HEADER declares them.
set(text "#include \"${HEADER}\"\n")
foreach(file ${FILES})
    file(READ "${FROM}/${file}" bytes HEX)
    string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
    string(TOLOWER "${PREFIX}${file}" name)
    string(MAKE_C_IDENTIFIER "${name}" name)
    string(APPEND text "const ${TYPE} ${name}[] = {${bytes}0};\n")
    if(TYPE STREQUAL "unsigned char")
        string(APPEND text "const size_t ${name}_size = sizeof ${name} - 1;\n")
    endif()
endforeach()
file(WRITE "${OUTPUT}" "${text}")
