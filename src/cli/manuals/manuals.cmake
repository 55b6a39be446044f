# SPDX-License-Identifier: GPL-3.0-or-later
# Manual pages of all commands, by help2man. In build/man.
find_program(HELP2MAN help2man)
if(TWINBOX_SANITIZE)
    return() # one build has them
endif()
if(NOT HELP2MAN)
    message(STATUS "No manual pages: help2man is not installed")
    return()
endif()

set(script ${CMAKE_CURRENT_LIST_DIR}/command.sh)
set(commands_header ${PROJECT_SOURCE_DIR}/src/cli/cli.h)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${commands_header})
set(manuals "")

# add_manual(<name> <summary> [<command>])
function(add_manual name summary)
    set(output ${PROJECT_BINARY_DIR}/man/man1/${name}.1)
    add_custom_command(
        OUTPUT ${output}
        COMMAND ${CMAKE_COMMAND} -E make_directory ${PROJECT_BINARY_DIR}/man/man1
        COMMAND sh ${script} ${output} ${PROJECT_VERSION} $<TARGET_FILE:twinbox> "${summary}" ${ARGN}
        DEPENDS ${script} twinbox
        VERBATIM)
    set(manuals ${manuals} ${output} PARENT_SCOPE)
    install(FILES ${output} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 OPTIONAL)
endfunction()

set(summary "rigid-box physics engine and neural networks, side by side")
if(TWINBOX_PARTS STREQUAL "compare")
    set(summary "visual regression of pictures")
endif()
add_manual(twinbox "${summary}")
file(READ ${commands_header} text)
string(REGEX MATCHALL "COMMAND\\([a-z]+, *\"[^\"]*\"" lines "${text}")
foreach(line ${lines})
    string(REGEX MATCH "COMMAND\\(([a-z]+), *\"([^\"]*)\"" line "${line}")
    set(command ${CMAKE_MATCH_1})
    set(summary ${CMAKE_MATCH_2})
    if(NOT TWINBOX_PARTS STREQUAL "compare" OR command MATCHES "^(compare|approve)$")
        add_manual(twinbox-${command} "${summary}" ${command})
    endif()
endforeach()

add_custom_target(manuals ALL DEPENDS ${manuals})
install(CODE "if(NOT EXISTS \"${PROJECT_BINARY_DIR}/man/man1/twinbox.1\")
                  message(STATUS \"No manual pages, as they are not built: cmake --build BUILD --target manuals\")
              endif()")
