/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The report of the paper's study (Avatavului, Ifrim, Voncila 2023), from what the study left on disk. */
#pragma once
#include "common/error.h"

/* Reads table1.csv, networks.csv, rates.csv, closed_loop.csv, laws.csv, transfer.csv and study.csv of a folder, and its
   figures/NAME.png with their captions, figures/NAME.txt, for NAME = loop, narrow-phase, data, scenes
   (paper/figures/engine_figures.h), loss, factors, rates, closed-loop, laws, transfer. Writes report.md, which
   links the figures, and report.html, which needs no other file. Every figure that is not named as the paper's is
   computed from the tables, and so is every claim; the same folder gives the same bytes.

   ERROR_INPUT where a file is missing or damaged, with path:line:column for what is wrong in a table; then neither
   report is written. */
bool paper_report_write(const char *folder, Error *error);
