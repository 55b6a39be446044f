# SPDX-License-Identifier: GPL-3.0-or-later
# Manual pages: of each command by help2man, of each file format from its Markdown page by cmark-gfm. In build/man.
find_program(HELP2MAN help2man)
find_program(CMARK_GFM cmark-gfm)
if(TWINBOX_SANITIZE)
    return() # one build has them
endif()
if(NOT HELP2MAN OR NOT CMARK_GFM)
    message(STATUS "No manual pages: help2man or cmark-gfm is not installed")
    return()
endif()

set(folder ${CMAKE_CURRENT_LIST_DIR})
set(commands_header ${PROJECT_SOURCE_DIR}/src/cli/cli.h)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${commands_header} ${folder}/pages.txt)
set(manuals "")
set(compare_commands compare approve) # of -DTWINBOX_PARTS=compare
set(compare_formats twinbox-rules twinbox-report)

# add_manual(<section> <name> SCRIPT <script> <arguments>... DEPENDS <files>...)
function(add_manual section name)
    cmake_parse_arguments(PARSE_ARGV 2 manual "" "" "DEPENDS;SCRIPT")
    set(output ${PROJECT_BINARY_DIR}/man/man${section}/${name}.${section})
    list(POP_FRONT manual_SCRIPT script)
    add_custom_command(
        OUTPUT ${output}
        COMMAND ${CMAKE_COMMAND} -E make_directory ${PROJECT_BINARY_DIR}/man/man${section}
        COMMAND sh ${script} ${output} ${PROJECT_VERSION} ${manual_SCRIPT}
        DEPENDS ${script} ${folder}/pages.txt ${manual_DEPENDS}
        VERBATIM)
    set(manuals ${manuals} ${output} PARENT_SCOPE)
    install(FILES ${output} DESTINATION ${CMAKE_INSTALL_MANDIR}/man${section} OPTIONAL)
endfunction()

set(summary "rigid-box physics engine and neural networks, side by side")
if(TWINBOX_PARTS STREQUAL "compare")
    set(summary "visual regression of pictures")
endif()
add_manual(1 twinbox SCRIPT ${folder}/command.sh $<TARGET_FILE:twinbox> "${summary}" DEPENDS twinbox ${folder}/help.awk ${folder}/code.awk)
file(READ ${commands_header} text)
string(REGEX MATCHALL "COMMAND\\([a-z]+, *\"[^\"]*\"" lines "${text}")
foreach(line ${lines})
    string(REGEX MATCH "COMMAND\\(([a-z]+), *\"([^\"]*)\"" line "${line}")
    set(command ${CMAKE_MATCH_1})
    if(TWINBOX_PARTS STREQUAL "compare" AND NOT command IN_LIST compare_commands)
        continue()
    endif()
    add_manual(1 twinbox-${command} SCRIPT ${folder}/command.sh $<TARGET_FILE:twinbox> "${CMAKE_MATCH_2}" ${command}
               DEPENDS twinbox ${folder}/help.awk ${folder}/code.awk)
endforeach()

file(STRINGS ${folder}/pages.txt lines)
foreach(line ${lines})
    string(REGEX MATCH "^([^|]*)\\|[^|]*\\|([^|]*)\\|" line "${line}")
    if(TWINBOX_PARTS STREQUAL "compare" AND NOT CMAKE_MATCH_1 IN_LIST compare_formats)
        continue()
    endif()
    add_manual(5 ${CMAKE_MATCH_1} SCRIPT ${folder}/format.sh ${PROJECT_SOURCE_DIR} ${CMAKE_MATCH_1}
               DEPENDS ${folder}/page.awk ${folder}/man.awk ${PROJECT_SOURCE_DIR}/${CMAKE_MATCH_2})
endforeach()

add_custom_target(manuals ALL DEPENDS ${manuals})
install(CODE "if(NOT EXISTS \"${PROJECT_BINARY_DIR}/man/man1/twinbox.1\")
                  message(STATUS \"No manual pages, as they are not built: cmake --build BUILD --target manuals\")
              endif()")
