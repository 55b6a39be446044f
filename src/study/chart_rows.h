/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What charts and tables of chart.csv read from its rows. */
#pragma once
#include "study/chart_csv.h"

#include <stdbool.h>

enum { CHART_FAMILY_SIZE = CHART_NAME_SIZE + 2 * CHART_SETTING_SIZE };

/* Splits "k=20,warm=off" into numbers "k=20" and words "warm=off", appended to texts of 2 * CHART_SETTING_SIZE. */
void chart_split_setting(const char *setting, char *numbers, char *words);

/* The family of a row: its method with the words of its setting ("engine:warm=off"). Settings of one family differ in
   numbers only. */
void chart_row_family(const ChartRow *row, char family[CHART_FAMILY_SIZE]);

/* True if the boxes drifted by half a metre before the bomb came: the method was scored on another scene. */
bool chart_row_lost(const ChartRow *rows, int count, const ChartRow *row);
