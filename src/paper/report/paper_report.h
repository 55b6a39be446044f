/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The report of the paper's study (Avatavului, Ifrim, Voncila 2023): report.md.in of this folder, filled in
   (template.h). */
#pragma once
#include "common/error.h"

/* folder: of a study (paper/study/paper.h) whose figures are drawn (paper/figures). Computes folder/findings
   (paper/findings/findings.h), and writes report.md, which links the figures, and report.html, which needs no other
   file to be read; its links to pages of runs lead to figures/strip-SCENE.html. The same folder gives the same bytes.

   ERROR_INPUT where a CSV file or a figure is missing or damaged, with path:line:column for CSV files; then neither
   report is written. */
bool paper_report_write(const char *folder, Error *error);
