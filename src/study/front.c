/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/front.h"

#include <math.h>
#include <string.h>

static bool comparable(const ChartRow *a, const ChartRow *b) {
    return a->phase == b->phase && a->protocol == b->protocol && strcmp(a->scene, b->scene) == 0;
}

static bool takes_part(const ChartRow *row) {
    static const char *const apart[] = {"constant", "playback", "reference"};
    for (int i = 0; i < 3; i++)
        if (strcmp(row->method, apart[i]) == 0) return false;
    return !isnan(row->us_solver) && !isnan(row->us_solver_q1) && !isnan(row->us_solver_q3) && !isnan(row->error_mean);
}

bool front_beats(const ChartRow *a, const ChartRow *b) {
    return comparable(a, b) && takes_part(a) && takes_part(b) && a->us_solver_q3 < b->us_solver_q1 &&
           a->error_mean <= fmax(b->error_mean, FRONT_RESOLUTION);
}

void front_mark(const ChartRow *rows, int count, bool *on_front) {
    for (int i = 0; i < count; i++) {
        on_front[i] = takes_part(&rows[i]);
        for (int k = 0; on_front[i] && k < count; k++) on_front[i] = !front_beats(&rows[k], &rows[i]);
    }
}
