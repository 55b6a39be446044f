/* SPDX-License-Identifier: GPL-3.0-or-later */
/* stability.html: the maps of a study as tables, whose cells link to pages of runs. */
#pragma once
#include "common/error.h"

extern const char stability_css[]; /* src/stability/page */

/* Writes folder/stability.html from maps.csv and map_pages.csv (stability/map_pages.h) there. */
bool stability_html_write(const char *folder, Error *error);
