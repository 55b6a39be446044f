# SPDX-License-Identifier: GPL-3.0-or-later
# Makes the staged files of a package what Debian's policy wants: licences in one file, a changelog, compressed pages.
set(share ${CPACK_TEMPORARY_DIRECTORY}/usr/share)
set(documents ${share}/doc/${CPACK_PACKAGE_NAME})
file(REMOVE ${documents}/LICENSE ${documents}/OFL.txt)

if(CPACK_PACKAGE_NAME STREQUAL "twinbox")
    # Indented by a space, empty lines as dots.
    file(READ ${CPACK_TWINBOX_SOURCE}/src/pixels/font/OFL.txt font_licence)
    string(REGEX REPLACE "\n+$" "" font_licence "${font_licence}")
    string(REGEX REPLACE "\n" "\n " font_licence " ${font_licence}")
    string(REGEX REPLACE "\n *\n" "\n .\n" font_licence "${font_licence}")
    configure_file(${CMAKE_CURRENT_LIST_DIR}/copyright.in ${documents}/copyright @ONLY)
else() # no font, but a library
    file(COPY_FILE ${CMAKE_CURRENT_LIST_DIR}/copyright_compare ${documents}/copyright)
endif()

string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC) # of SOURCE_DATE_EPOCH, if it is set
file(WRITE ${documents}/changelog.Debian
     "${CPACK_PACKAGE_NAME} (${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}) unstable; urgency=medium\n\n"
     "  * What has changed: /usr/share/doc/${CPACK_PACKAGE_NAME}/CHANGELOG.md.\n\n"
     " -- ${CPACK_PACKAGE_CONTACT}  ${date}\n")
file(GLOB_RECURSE pages ${share}/man/*.[1-9])
execute_process(COMMAND gzip -9nf ${documents}/changelog.Debian ${pages} COMMAND_ERROR_IS_FATAL ANY)
file(CHMOD_RECURSE ${share} FILE_PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ DIRECTORY_PERMISSIONS
     OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
