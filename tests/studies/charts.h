/* SPDX-License-Identifier: GPL-3.0-or-later */
#pragma once
#include "testing.h"

#define CHART_HEADER                                                  \
    "scene,method,setting,protocol,phase,launches,us_solver,us_step," \
    "error_mean,error_median,error_p95,error_worst,share_right,penetration_max,drift,energy,moved"

/* Writes a table with the header of a chart that names no processor; the lines follow it as they are. */
static inline const char *write_chart(const char *lines) {
    const char *path = temporary_path("chart.csv");
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fprintf(file, CHART_HEADER "\n%s", lines);
    assert_int_equal(fclose(file), 0);
    return path;
}
