/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The limits of a comparison: how they are read and told, and whether a difference is within them. */
#include "regression/limits.h"

#include "base/base.h"
#include "regression/image_compare.h"

#include <stdlib.h>
#include <string.h>

bool pixel_limit_parse(PixelLimit *limit, const char *text) {
    int64_t pixels;
    const char *rest;
    if (parse_leading_int(text, 0, INT64_MAX, &pixels, &rest) && strcmp(rest, "px") == 0)
        *limit = (PixelLimit){(double)pixels, true};
    else if (parse_double(text, &limit->most) && limit->most >= 0 && limit->most <= 1)
        limit->number = false;
    else
        return false;
    return true;
}

void tolerance_override(Tolerance *tolerance, const Tolerance *over) {
    tolerance->given |= over->given;
    if ((over->given & LIMIT_TOLERANCE) != 0) tolerance->tolerance = over->tolerance;
    if ((over->given & LIMIT_BEYOND) != 0) tolerance->beyond = over->beyond;
    if ((over->given & LIMIT_ANTIALIAS) != 0) tolerance->antialias = over->antialias;
}

bool tolerance_holds(const Tolerance *tolerance, const ImageDifference *difference) {
    const PixelLimit *limit = &tolerance->beyond;
    if (difference->pixels == 0) return true;
    if ((tolerance->given & (LIMIT_TOLERANCE | LIMIT_BEYOND)) == 0) return false;
    return (double)difference->beyond <= (limit->number ? limit->most : limit->most * (double)difference->counted);
}

ToleranceText tolerance_words(const Tolerance *tolerance) {
    const PixelLimit *limit = &tolerance->beyond;
    ToleranceText words = {""};
    if ((tolerance->given & (LIMIT_TOLERANCE | LIMIT_BEYOND)) != 0) {
        text_add(words.text, sizeof words.text, "differences above %d in at most ", tolerance->tolerance);
        if (limit->number)
            text_add(words.text, sizeof words.text, "%.0f pixel%s", limit->most, limit->most == 1 ? "" : "s");
        else
            text_add(words.text, sizeof words.text, "%g%% of the pixels", 100 * limit->most);
    }
    if (tolerance->antialias) text_join(words.text, sizeof words.text, ", ", "edges may move within a pixel");
    if (words.text[0] == '\0') text_add(words.text, sizeof words.text, "none");
    return words;
}
