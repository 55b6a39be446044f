# SPDX-License-Identifier: GPL-3.0-or-later
# The style of stability.html is built in, so that the binary needs no files.
twinbox_embed(twinbox_stability stability_page.c stability/stability_html.h char "" ${CMAKE_CURRENT_LIST_DIR}/page
              stability.css)
