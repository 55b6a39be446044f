# SPDX-License-Identifier: GPL-3.0-or-later
# `cpack` in the build folder makes a Debian package: dependencies by dpkg-shlibdeps, so a package is for the Debian that
# it is built on. With SOURCE_DATE_EPOCH set, two builds give the same bytes.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_STRIP_FILES ON)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/debian_files.cmake)
set(CPACK_TWINBOX_SOURCE ${PROJECT_SOURCE_DIR})

set(CPACK_PACKAGE_CONTACT "Twinbox developers <twinbox@example.org>" CACHE STRING "Maintainer of the Debian package")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "rigid-box physics by solvers and neural networks, side by side")
set(CPACK_PACKAGE_DESCRIPTION
    "Twinbox runs scenes of rigid boxes with a bit-exact engine, other contact
solvers and neural networks, and draws the runs side by side, offscreen, as
PNG frames, videos and figures. It compares runs and picture sequences for
visual regression, measures speed, accuracy and stability, and trains the
networks.")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
if(TWINBOX_PARTS STREQUAL "all")
    # Loaded or started at run time.
    set(CPACK_DEBIAN_PACKAGE_DEPENDS "libegl1, libgl1-mesa-dri")
    set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "ffmpeg")
    if(TWINBOX_OSMESA)
        set(CPACK_DEBIAN_PACKAGE_SUGGESTS libosmesa6)
    endif()
    set(CPACK_DEBIAN_PACKAGE_CONFLICTS twinbox-compare)
else()
    set(CPACK_PACKAGE_NAME twinbox-compare)
    set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "visual regression: compares folders of PNG files")
    set(CPACK_PACKAGE_DESCRIPTION
        "The commands compare and approve of twinbox, for pictures: which pixels of
two folders of PNG files differ, with limits, masks, and reports for people
and CI systems.")
    set(CPACK_DEBIAN_PACKAGE_CONFLICTS twinbox)
endif()
include(CPack)
