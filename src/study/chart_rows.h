/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What charts and tables of chart.csv read from its rows. */
#pragma once
#include "study/chart_csv.h"

#include <stdbool.h>

enum { CHART_FAMILY_SIZE = CHART_NAME_SIZE + 2 * CHART_SETTING_SIZE };

enum { CHART_TIMES_SIZE = CPU_NAME_SIZE + 80 };

/* Splits "k=20,warm=off" into numbers "k=20" and words "warm=off", appended to texts of 2 * CHART_SETTING_SIZE. */
void chart_split_setting(const char *setting, char *numbers, char *words);

/* The family of a row: its method with the words of its setting ("engine:warm=off"). Settings of one family differ in
   numbers only. */
void chart_row_family(const ChartRow *row, char family[CHART_FAMILY_SIZE]);

/* True if the boxes drifted by half a metre before the bomb came: the method was scored on another scene. */
bool chart_row_lost(const ChartRow *rows, int count, const ChartRow *row);

/* "Times measured on PROCESSOR.", and whether those of others are left out (twinbox merge --times first); "" if no row names
   one. */
void chart_times_note(char note[CHART_TIMES_SIZE], const ChartRow *rows, int count);

/* Whether the times of a scene are left out: rows of other scenes have times, and name their processor. */
bool chart_scene_untimed(const ChartRow *rows, int count, const char *scene);
