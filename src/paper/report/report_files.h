/* SPDX-License-Identifier: GPL-3.0-or-later */
/* report.md.in and report.css, built into the program (paper/sources.cmake). Each ends in a 0. */
#pragma once
#include <stddef.h>

extern const unsigned char paper_report_md_in[], paper_report_css[];
extern const size_t paper_report_md_in_size, paper_report_css_size;
