# SPDX-License-Identifier: GPL-3.0-or-later
# The plugins of golden/ as any user installs them, with the same bytes each time: a tarball for npm, and a wheel for pip where
# there is Python. They are in clients/ of the build.
set(clients ${PROJECT_BINARY_DIR}/clients)
set(npm golden/npm/package.json golden/npm/twinbox-compare.js golden/npm/README.md)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${npm} golden/pytest/pyproject.toml
             golden/pytest/pytest_twinbox.py src/cli/packaging/wheel.py)
file(REMOVE_RECURSE ${clients})
file(COPY ${npm} DESTINATION ${clients}/package)
file(READ golden/npm/package.json npm)
string(JSON version GET "${npm}" version)
set(tarball twinbox-compare-${version}.tar)
execute_process(COMMAND ${CMAKE_COMMAND} -E tar cf ${tarball} --format=gnutar --mtime=1980-01-01 package/package.json
                        package/README.md package/twinbox-compare.js
                WORKING_DIRECTORY ${clients} COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND gzip -9n ${tarball} WORKING_DIRECTORY ${clients} COMMAND_ERROR_IS_FATAL ANY)
file(RENAME ${clients}/${tarball}.gz ${clients}/twinbox-compare-${version}.tgz)
find_program(TWINBOX_PYTHON NAMES python3)
if(TWINBOX_PYTHON)
    execute_process(COMMAND ${TWINBOX_PYTHON} src/cli/packaging/wheel.py golden/pytest/pyproject.toml ${clients}
                    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} COMMAND_ERROR_IS_FATAL ANY)
endif()
install(DIRECTORY ${clients}/ DESTINATION ${CMAKE_INSTALL_DATADIR}/twinbox FILES_MATCHING PATTERN *.tgz PATTERN *.whl
        PATTERN package EXCLUDE)
