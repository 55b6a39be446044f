/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Noise and other colours, by sums over pixels. */
#include "regression/content.h"

#include <math.h>
#include <string.h>

void traits_add_pair(ContentTraits *traits, const uint8_t *a, const uint8_t *b, size_t next, bool both) {
    const double p = pixel_distance(a, a + next), q = pixel_distance(b, b + next);
    traits->product += p * q;
    traits->steps[0] += p * p, traits->steps[1] += q * q;
    if (!both) return;
    traits->pairs++;
    for (size_t c = 0; c < 3; c++) traits->shared += (b[c] - a[c]) * (b[next + c] - a[next + c]);
}

static void add_pixel(ContentTraits *traits, const uint8_t *a, const uint8_t *b) {
    const double from[MAPPED] = {a[0], a[1], a[2], 255};
    traits->pixels++;
    for (int c = 0; c < 3; c++) {
        const double difference = b[c] - a[c];
        traits->sum[c] += difference;
        traits->absolute += fabs(difference);
        traits->square += difference * difference;
        for (int i = 0; i < MAPPED; i++) traits->to[i][c] += from[i] * difference;
    }
    for (int i = 0; i < MAPPED; i++)
        for (int k = 0; k <= i; k++) traits->from[i][k] += from[i] * from[k];
}

void traits_add_row(ContentTraits *traits, const uint8_t *a, const uint8_t *b, const uint8_t *levels, int weak,
                    int width) {
    for (int x = 0; x < width; x++, a += 4, b += 4) {
        traits->levels[levels[x]]++;
        if (levels[x] > 0) add_pixel(traits, a, b);
        if (x + 1 < width && (levels[x] > weak || levels[x + 1] > weak))
            traits_add_pair(traits, a, b, 4, levels[x] > 0 && levels[x + 1] > 0);
    }
}

bool traits_are_small(const ContentTraits *traits, int level) {
    return traits->absolute <= 3.0 * level * traits->pixels;
}

bool traits_fill_areas(const ContentTraits *traits) { return traits->pairs > 1.7 * traits->pixels; }

bool traits_are_noise(const ContentTraits *traits) {
    enum { SMALL = 8 };
    static const double SHARED = 0.35, SCATTERED = 0.3, SPARSE = 0.05;
    double all = 0;
    for (int i = 0; i < 256; i++) all += (double)traits->levels[i];
    const double pixels = fmax(traits->pixels, 1), pairs = fmax(traits->pairs, 1);
    double common = 0; /* the square of the mean difference */
    for (int c = 0; c < 3; c++) common += traits->sum[c] * traits->sum[c] / (pixels * pixels);
    const bool apart = traits->shared / pairs - common < SHARED * (traits->square / pixels - common);
    return (traits_are_small(traits, SMALL) && apart) || (pairs < SCATTERED * pixels && pixels < SPARSE * all);
}

/* Solves from * x = to for a positive definite matrix, whose lower triangle is given, by Cholesky's decomposition. */
static void content_traits_solve(double from[MAPPED][MAPPED], double to[MAPPED][3]) {
    for (int i = 0; i < MAPPED; i++)
        for (int k = 0; k <= i; k++) {
            for (int j = 0; j < k; j++) from[i][k] -= from[i][j] * from[k][j];
            from[i][k] = k < i ? from[i][k] / from[k][k] : sqrt(from[i][i]);
        }
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < MAPPED; i++) {
            for (int j = 0; j < i; j++) to[i][c] -= from[i][j] * to[j][c];
            to[i][c] /= from[i][i];
        }
        for (int i = MAPPED; i-- > 0;) {
            for (int j = i + 1; j < MAPPED; j++) to[i][c] -= from[j][i] * to[j][c];
            to[i][c] /= from[i][i];
        }
    }
}

/* The share of the squared difference that no map of colours, linear with an offset, explains. */
static double unmapped(const ContentTraits *traits) {
    static const double RIDGE = 1e-3;
    double from[MAPPED][MAPPED], map[MAPPED][3], left = traits->square;
    memcpy(from, traits->from, sizeof from);
    memcpy(map, traits->to, sizeof map);
    for (int i = 0; i < MAPPED; i++) from[i][i] += RIDGE * (traits->from[i][i] + 1);
    content_traits_solve(from, map);
    for (int i = 0; i < MAPPED; i++)
        for (int c = 0; c < 3; c++) left -= map[i][c] * traits->to[i][c];
    return left / fmax(traits->square, 1);
}

bool traits_are_recoloured(const ContentTraits *traits) {
    static const double ALIKE = 0.7, LITTLE = 0.05, SEEN = 1e-4;
    return traits->product >= ALIKE * sqrt(traits->steps[0] * traits->steps[1]) && unmapped(traits) <= LITTLE &&
           traits->steps[0] > SEEN * traits->steps[1] && traits->steps[1] > SEEN * traits->steps[0];
}

int traits_floor(const ContentTraits *traits) {
    enum { MOST = 12, MANY = 50, TENTH = 10 };
    int64_t all = 0, above = 0;
    int level = 255;
    for (int i = 0; i < 256; i++) all += traits->levels[i];
    const int64_t differing = all - traits->levels[0];
    if (differing * MANY < all) return 0;
    for (; level > 0 && (above + traits->levels[level]) * TENTH <= differing; level--) above += traits->levels[level];
    if (level > MOST) return 0;
    for (above = 0, level *= 2, all = 255; all > level; all--) above += traits->levels[all];
    return above > 0 ? level : 0;
}
