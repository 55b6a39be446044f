/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What `twinbox --version -v` adds: what pictures are drawn by. */
#pragma once
#include <stdio.h>

/* A line for each kind of context: Mesa's version and rasteriser, or why it cannot be used. The one that `render` takes
   by default is marked. */
void print_contexts(FILE *file);
