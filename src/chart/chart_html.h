/* SPDX-License-Identifier: GPL-3.0-or-later */
/* chart.html: the charts of a study; their points, and a table of them, link to pages of runs. */
#pragma once
#include "common/error.h"

extern const char chart_css[]; /* src/chart/page */

/* Writes folder/chart.html from chart.csv, chart_pages.csv (study/launch_page.h) and the charts' .svg files there. Without a
   script: a picture with links above its points, which a table repeats for the keyboard. */
bool chart_html_write(const char *folder, Error *error);
