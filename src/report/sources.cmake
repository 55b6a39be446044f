# SPDX-License-Identifier: GPL-3.0-or-later
# The parts of a comparison's page are built in, so that the binary needs no files.
twinbox_embed(twinbox_report page.c report/page.h char report_ ${CMAKE_CURRENT_LIST_DIR}/page
              page.css stage.js list.js page.js page.html help.html)
