# SPDX-License-Identifier: GPL-3.0-or-later
# The report's text and style are built in, so that the binary needs no files.
twinbox_embed(twinbox_paper report_files.c paper/report/report_files.h "unsigned char" paper_
              ${CMAKE_CURRENT_LIST_DIR}/report report.md.in report.css)
