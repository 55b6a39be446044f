/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/stability_plan_print.h"

#include "common/cpu_name.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

/* A file system that many nodes share; its server makes or opens about as many files in a second. */
static const double files_a_second = 1000;

static void print_time(double seconds) {
    if (seconds < 120)
        printf("%7.3g s  ", seconds);
    else if (seconds < 2 * 3600)
        printf("%7.3g min", seconds / 60);
    else
        printf("%7.3g h  ", seconds / 3600);
}

static void print_bytes(double bytes) {
    static const char *const units[] = {"bytes", "KB", "MB", "GB", "TB"};
    int unit = 0;
    for (; bytes >= 1000 && unit < 4; unit++) bytes /= 1000;
    printf("%.3g %s", bytes, units[unit]);
}

static void print_cores(const PiecesEstimate *estimate, int cores) {
    double seconds[PIECES_LIMITS];
    const PiecesLimit limit = pieces_times(estimate, cores, files_a_second, seconds);
    printf("%7d  %8" PRId64 "  ", cores, estimate->pieces < cores ? estimate->pieces : cores);
    print_time(fmax(fmax(seconds[LIMIT_COMPUTING], seconds[LIMIT_LONGEST]), seconds[LIMIT_FILES]));
    print_time(seconds[LIMIT_MERGE]);
    printf(" %s\n", pieces_limit_names[limit]);
}

void stability_plan_print(const PiecesEstimate *estimate) {
    static const int cores[] = {1, 10, 1000, 100000};
    char cpu[CPU_NAME_SIZE];
    cpu_name(cpu);
    printf("pieces: %" PRId64 ", of which %d were measured on one core each of %s\n", estimate->pieces,
           estimate->measured, cpu);
    printf("a piece: %.3g s and ", estimate->seconds);
    print_bytes(estimate->bytes);
    printf(" on average, %.3g s at most\n", estimate->longest);
    printf("all: %.4g s on one core; %" PRId64 " files, ", estimate->total, estimate->pieces);
    print_bytes(estimate->bytes * (double)estimate->pieces);
    printf("\n\nif the shared file system makes or opens %.0f files a second:\n", files_a_second);
    printf("  cores    in use    shards       merge     limit\n");
    for (size_t i = 0; i < sizeof cores / sizeof *cores; i++) print_cores(estimate, cores[i]);
}
