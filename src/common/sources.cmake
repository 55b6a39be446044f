# SPDX-License-Identifier: GPL-3.0-or-later
# The style that all pages share is built in, so that the binary needs no files.
twinbox_embed(twinbox_common house_style.c common/house_page.h char "" ${CMAKE_CURRENT_LIST_DIR}/page house.css)
