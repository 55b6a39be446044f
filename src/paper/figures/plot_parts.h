/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The plots of plots.h, each in plot_NAME.c. They read their table from the folder and write the page. The page's width
   stays 0 if the table has no rows to show. False with error set if the table is missing or damaged. */
#pragma once
#include "sketch/plot_page.h"

bool plot_loss(const char *folder, PlotPage *page, Error *error);
bool plot_factors(const char *folder, PlotPage *page, Error *error);
bool plot_rates(const char *folder, PlotPage *page, Error *error);
bool plot_closed_loop(const char *folder, PlotPage *page, Error *error);
bool plot_laws(const char *folder, PlotPage *page, Error *error);
bool plot_transfer(const char *folder, PlotPage *page, Error *error);

/* Of the systems that the paper cites (paper/systems/system.h). */
bool plot_sain(const char *folder, PlotPage *page, Error *error);
bool plot_hybrid(const char *folder, PlotPage *page, Error *error);
bool plot_gns(const char *folder, PlotPage *page, Error *error);
bool plot_subspace(const char *folder, PlotPage *page, Error *error);
