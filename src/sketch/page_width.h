/* SPDX-License-Identifier: GPL-3.0-or-later */
#pragma once

/* mm: the page of a paper, and one of its two columns. */
#define FIGURE_PAGE_WIDTH 174.0
#define FIGURE_COLUMN_WIDTH 85.0
