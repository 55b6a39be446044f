/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The figures of result_figures.h: each reads its table and writes its page. A page without a width is one that its
   table has no rows for. False with error set where the table is not in order. */
#pragma once
#include "chart/gnuplot_page.h"

bool figure_loss(const char *folder, GnuplotPage *page, Error *error);
bool figure_factors(const char *folder, GnuplotPage *page, Error *error);
bool figure_rates(const char *folder, GnuplotPage *page, Error *error);
bool figure_closed_loop(const char *folder, GnuplotPage *page, Error *error);
bool figure_laws(const char *folder, GnuplotPage *page, Error *error);
bool figure_transfer(const char *folder, GnuplotPage *page, Error *error);
