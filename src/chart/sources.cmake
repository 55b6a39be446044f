# SPDX-License-Identifier: GPL-3.0-or-later
# The style of chart.html is built in, so that the binary needs no files.
twinbox_embed(twinbox_chart chart_page.c chart/chart_html.h char "" ${CMAKE_CURRENT_LIST_DIR}/page chart.css)
