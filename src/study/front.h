/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which methods nobody beats. */
#pragma once
#include "study/chart_csv.h"

/* m/s: how far from converged the reference itself can be (reference/reference.h). Smaller errors are equal. */
#define FRONT_RESOLUTION 1e-4

/* a is surely faster, and not less accurate: its upper quartile of time lies below b's lower one, and its mean error
   is at most b's, as far as errors can be told apart. Where the quartile intervals overlap the two are not ordered, and
   neither beats the other. Rows of different scene, protocol or phase are not compared; one without quartiles of time
   or without an error beats nobody and is beaten by nobody. Nor do the two take part that solve nothing, the constant
   and the playback of what was recorded, and the reference, which has no error by definition. */
bool front_beats(const ChartRow *a, const ChartRow *b);

/* on_front[count]: rows with time and error that no other row beats. */
void front_mark(const ChartRow *rows, int count, bool *on_front);
