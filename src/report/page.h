/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The fixed parts of report.html (src/report/page), embedded in the binary by common/tools/embed.cmake. */
#pragma once

extern const char report_page_css[], report_page_html[], report_help_html[];
extern const char report_stage_js[], report_list_js[], report_page_js[]; /* one scope, in this order */
