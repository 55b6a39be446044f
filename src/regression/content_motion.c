/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The offset by which content moved: whole pixels from several guesses, then part of a pixel by least squares. */
#include "pixels/png.h"
#include "regression/compare.h"
#include "regression/content.h"

#include <math.h>
#include <stdlib.h>

enum { CHANNELS = 4, STEPS_MAX = 40, PROFILE_MAX = 2048, PATCHES_MAX = 2 };

typedef struct Search {
    const Patch *const *patches;
    int patch_count;
    Motion best; /* of the starts */
} Search;

static int level_at(const Image *image, int x, int y, int c) {
    x = x < 0 ? 0 : x >= image->width ? image->width - 1 : x;
    y = y < 0 ? 0 : y >= image->height ? image->height - 1 : y;
    return image->pixels[4 * ((size_t)y * (size_t)image->width + (size_t)x) + (size_t)c];
}

/* The squared difference of a pixel from a place in another picture; beyond the picture, from its edge. */
static double difference_at(const Image *a, int x, int y, const Image *b, int right, int down) {
    double sum = 0;
    for (int c = 0; c < CHANNELS; c++) {
        const double difference = level_at(a, x, y, c) - level_at(b, x + right, y + down, c);
        sum += difference * difference;
    }
    return sum;
}

/* What appears came from there, what vanishes went there; the rest did both. */
static double left_over(const Patch *patch, int right, int down) {
    const Image *a = patch->pictures[0], *b = patch->pictures[1];
    double sum = 0;
    for (int i = 0; i < patch->count; i++) {
        const Dot *dot = &patch->dots[i];
        const double came = dot->kind == DOT_VANISHES ? 0 : difference_at(b, dot->x, dot->y, a, -right, -down);
        const double went = dot->kind == DOT_APPEARS ? 0 : difference_at(a, dot->x, dot->y, b, right, down);
        sum += dot->kind == DOT_APPEARS || dot->kind == DOT_VANISHES ? came + went : (came + went) / 2;
    }
    return sum;
}

/* Of two regions, what is explained of the worse one. */
static void content_motion_judge(const Search *search, Motion *motion) {
    motion->explained = 1;
    for (int i = 0; i < search->patch_count; i++) {
        const double left = left_over(search->patches[i], (int)motion->right, (int)motion->down);
        motion->explained = fmin(motion->explained, 1 - left / fmax(search->patches[i]->total, 1));
    }
}

/* Of two that explain as much, the smaller one. */
static bool is_better(const Motion *a, const Motion *b) {
    if (a->explained != b->explained) return a->explained > b->explained;
    return fabs(a->right) + fabs(a->down) < fabs(b->right) + fabs(b->down);
}

static void try_start(Search *search, double right, double down) {
    Motion start = {rint(right), rint(down), 0};
    if (start.right == 0 && start.down == 0) return;
    content_motion_judge(search, &start);
    if (is_better(&start, &search->best)) search->best = start;
}

/* The shift of one profile that is most like the other. */
static int best_shift(const double *a, const double *b, int count) {
    double least = INFINITY;
    int best = 0;
    for (int k = 0; k < 2 * count - 1; k++) {
        const int shift = k % 2 == 0 ? k / 2 : -(k + 1) / 2; /* 0, -1, 1, -2, ... */
        double sum = 0;
        for (int i = 0; i < count && sum < least; i++) {
            const int j = i + shift;
            sum += fabs((j < 0 || j >= count ? 0 : b[j]) - a[i]);
            if (i < shift) sum += b[i];
            if (i >= count + shift) sum += b[i];
        }
        if (sum < least) least = sum, best = shift;
    }
    return best;
}

/* By column or by row of a region, and the one behind it: how much the pixels differ from those before. */
static void edge_profile(const Image *image, const ImageRegion *region, bool by_row, int count, double *profile) {
    enum { SAMPLES = 256 }; /* of a line */
    const int length = by_row ? region->right - region->left : region->bottom - region->top;
    for (int i = 0; i < count; i++) {
        profile[i] = 0;
        for (int k = 0; k < length; k += length / SAMPLES + 1) {
            const int x = region->left + (by_row ? k : i), y = region->top + (by_row ? i : k);
            for (int c = 0; c < CHANNELS; c++)
                profile[i] += abs(level_at(image, x, y, c) - level_at(image, x - !by_row, y - by_row, c));
        }
    }
}

/* The shift of the edges: inside an even thing that moved by a part of its size, nothing differs. */
static int edge_shift(const Patch *patch, bool by_row) {
    double profiles[2][PROFILE_MAX];
    const ImageRegion *region = &patch->region;
    const int count = 1 + (by_row ? region->bottom - region->top : region->right - region->left);
    for (int i = 0; i < 2; i++) edge_profile(patch->pictures[i], region, by_row, count, profiles[i]);
    return best_shift(profiles[0], profiles[1], count);
}

/* The shift of a corner of what was there to that of what is there now, and of its edges. Each shift to the right is
   tried with each one down. */
static void add_sides(Search *search) {
    const Patch *patch = search->patches[0];
    const ViewRect a = patch->box[0], b = search->patches[search->patch_count - 1]->box[1];
    const int width = patch->region.right - patch->region.left, height = patch->region.bottom - patch->region.top;
    int right[3] = {0}, down[3] = {0};
    if (a.right >= a.left && b.right >= b.left) {
        right[1] = b.left - a.left;
        down[1] = b.top - a.top;
    }
    if (search->patch_count == 1 && width < PROFILE_MAX && height < PROFILE_MAX) {
        right[2] = edge_shift(patch, false);
        down[2] = edge_shift(patch, true);
    }
    for (int i = 0; i < 9; i++) try_start(search, right[i % 3], down[i / 3]);
}

/* To a neighbour while that explains more. */
static void descend(const Search *search, Motion *motion) {
    for (int i = 0; i < STEPS_MAX; i++) {
        Motion best = *motion;
        for (int k = 0; k < 9; k++) {
            Motion tried = {motion->right + k % 3 - 1, motion->down + k / 3 - 1, 0};
            if (k == 4) continue;
            content_motion_judge(search, &tried);
            if (tried.explained > best.explained) best = tried;
        }
        if (best.explained <= motion->explained) return;
        *motion = best;
    }
}

/* Normal equations of the part of a pixel that remains, and the squared difference. */
typedef struct Remainder {
    double xx, xy, yy, x, y, square;
} Remainder;

/* An edge lies in one pixel: if it moves, that pixel changes by the step from one of its neighbours to the other. */
static double step_across(const Image *image, int x, int y, int right, int down, int c) {
    return level_at(image, x + right, y + down, c) - level_at(image, x - right, y - down, c);
}

/* sign: 1 for what came to (x, y) of b from a, -1 for what went from there. */
static void add_remainder(const Image *a, const Image *b, int x, int y, int right, int down, double sign, double weight,
                          Remainder *sum) {
    for (int c = 0; c < CHANNELS; c++) {
        const int u = x + right, v = y + down;
        const double e = sign * (level_at(b, x, y, c) - level_at(a, u, v, c));
        const double gx = (step_across(a, u, v, 1, 0, c) + step_across(b, x, y, 1, 0, c)) / 2;
        const double gy = (step_across(a, u, v, 0, 1, c) + step_across(b, x, y, 0, 1, c)) / 2;
        sum->xx += weight * gx * gx, sum->xy += weight * gx * gy, sum->yy += weight * gy * gy;
        sum->x -= weight * gx * e, sum->y -= weight * gy * e;
        sum->square += weight * e * e;
    }
}

static Remainder remainder_of(const Patch *patch, int right, int down) {
    Remainder sum = {0};
    for (int k = 0; k < patch->count; k++) {
        const Dot *dot = &patch->dots[k];
        const double weight = dot->kind == DOT_APPEARS || dot->kind == DOT_VANISHES ? 1 : 0.5;
        if (dot->kind != DOT_VANISHES)
            add_remainder(patch->pictures[0], patch->pictures[1], dot->x, dot->y, -right, -down, 1, weight, &sum);
        if (dot->kind != DOT_APPEARS)
            add_remainder(patch->pictures[1], patch->pictures[0], dot->x, dot->y, right, down, -1, weight, &sum);
    }
    return sum;
}

/* By least squares, the part of a pixel that explains what whole pixels leave. */
static Motion refined(const Search *search, Motion base) {
    static const double RIDGE = 1e-6;
    Remainder parts[PATCHES_MAX], all = {0};
    for (int i = 0; i < search->patch_count; i++) {
        const Remainder *part = &parts[i];
        parts[i] = remainder_of(search->patches[i], (int)base.right, (int)base.down);
        all.xx += part->xx, all.xy += part->xy, all.yy += part->yy, all.x += part->x, all.y += part->y;
    }
    const double ridge = RIDGE * (all.xx + all.yy) + 1, xx = all.xx + ridge, yy = all.yy + ridge;
    const double determinant = xx * yy - all.xy * all.xy;
    const double x = (yy * all.x - all.xy * all.y) / determinant, y = (xx * all.y - all.xy * all.x) / determinant;
    if (fabs(x) > 1 || fabs(y) > 1) return base;
    Motion found = {base.right + x, base.down + y, 1};
    for (int i = 0; i < search->patch_count; i++) {
        const Remainder *part = &parts[i];
        const double left =
            part->square - 2 * (x * part->x + y * part->y) + x * x * part->xx + 2 * x * y * part->xy + y * y * part->yy;
        found.explained = fmin(found.explained, 1 - left / fmax(search->patches[i]->total, 1));
    }
    return found;
}

/* The smallest offset towards this one that explains as much, by steps that halve: of an even area, all larger ones
   do. */
static Motion shrunk(const Search *search, Motion found) {
    enum { LONGEST = 1 << 11 };
    for (int step = LONGEST; step > 0; step /= 2)
        for (int axis = 0; axis < 2; axis++)
            for (;;) {
                Motion tried = found;
                double *along = axis == 0 ? &tried.right : &tried.down;
                if (fabs(*along) < step) break;
                *along -= copysign(step, *along);
                content_motion_judge(search, &tried);
                if (tried.explained < found.explained) break;
                found = tried;
            }
    return found;
}

Motion content_motion(const Patch *const *patches, int count, const Motion *hint) {
    static const double EXACT = MOTION_EXACT, HOPELESS = 0.1;
    Search search = {.patches = patches, .patch_count = count};
    try_start(&search, hint->right, hint->down);
    add_sides(&search);
    Motion best = search.best;
    if (best.explained < HOPELESS) return refined(&search, (Motion){0, 0, 0});
    descend(&search, &best);
    best = shrunk(&search, best);
    if (best.explained < EXACT) best = refined(&search, best);
    const Motion part = best.explained < EXACT ? refined(&search, (Motion){0, 0, 0}) : best;
    return part.explained > best.explained ? part : best;
}
