/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "regression/tolerance.h"

#include "common/parse.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static bool given(const Tolerance *tolerance, unsigned limits) { return (tolerance->given & limits) != 0; }

void tolerance_override(Tolerance *tolerance, const Tolerance *over) {
    tolerance->given |= over->given;
    if (given(over, LIMIT_FUZZY)) tolerance->fuzzy = over->fuzzy, tolerance->share = over->share;
    if (given(over, LIMIT_TOLERANCE)) tolerance->tolerance = over->tolerance;
    if (given(over, LIMIT_BEYOND)) tolerance->beyond = over->beyond;
    if (given(over, LIMIT_FLIP_MEAN)) tolerance->flip_mean = over->flip_mean;
    if (given(over, LIMIT_FLIP_P99)) tolerance->flip_p99 = over->flip_p99;
    if (given(over, LIMIT_ANTIALIAS)) tolerance->antialias = over->antialias;
}

bool tolerance_holds(const Tolerance *tolerance, const ImageDifference *difference, const FlipSummary *flip) {
    double counted = (double)difference->counted;
    if (difference->pixels == 0) return true;
    if (!given(tolerance, LIMIT_FUZZY | LIMIT_TOLERANCE | LIMIT_BEYOND | LIMITS_FLIP)) return false;
    if (given(tolerance, LIMIT_FUZZY) &&
        (difference->largest > tolerance->fuzzy || (double)difference->pixels > tolerance->share * counted))
        return false;
    if (given(tolerance, LIMIT_TOLERANCE | LIMIT_BEYOND) && (double)difference->beyond > tolerance->beyond * counted)
        return false;
    return (!given(tolerance, LIMIT_FLIP_MEAN) || flip->mean <= tolerance->flip_mean) &&
           (!given(tolerance, LIMIT_FLIP_P99) || flip->p99 <= tolerance->flip_p99);
}

static void add(ToleranceText *words, const char *format, ...) PRINTF_LIKE(2, 3);
static void add(ToleranceText *words, const char *format, ...) {
    size_t used = strlen(words->text);
    if (used > 0) used += (size_t)snprintf(words->text + used, sizeof words->text - used, ", ");
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(words->text + used, sizeof words->text - used, format, arguments);
    va_end(arguments);
}

ToleranceText tolerance_words(const Tolerance *tolerance) {
    ToleranceText words = {""};
    if (given(tolerance, LIMIT_FUZZY))
        add(&words, "differences of at most %d in at most %g%% of the pixels", tolerance->fuzzy,
            100 * tolerance->share);
    if (given(tolerance, LIMIT_TOLERANCE | LIMIT_BEYOND))
        add(&words, "differences above %d in at most %g%% of the pixels", tolerance->tolerance,
            100 * tolerance->beyond);
    if (given(tolerance, LIMIT_FLIP_MEAN)) add(&words, "mean FLIP of at most %g", tolerance->flip_mean);
    if (given(tolerance, LIMIT_FLIP_P99)) add(&words, "99th percentile of FLIP of at most %g", tolerance->flip_p99);
    if (tolerance->antialias) add(&words, "edges may move within a pixel");
    if (words.text[0] == '\0') add(&words, "none");
    return words;
}

bool tolerance_parse_flip(Tolerance *tolerance, const char *text) {
    static const char mean[] = "mean=", p99[] = "p99=";
    bool percentile = strncmp(text, p99, sizeof p99 - 1) == 0;
    if (percentile)
        text += sizeof p99 - 1;
    else if (strncmp(text, mean, sizeof mean - 1) == 0)
        text += sizeof mean - 1;
    double limit;
    if (!parse_double(text, &limit) || limit < 0 || limit > 1) return false;
    *(percentile ? &tolerance->flip_p99 : &tolerance->flip_mean) = limit;
    tolerance->given |= percentile ? LIMIT_FLIP_P99 : LIMIT_FLIP_MEAN;
    return true;
}
