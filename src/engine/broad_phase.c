/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The broad phase: pairs of bounds that overlap, by sort and sweep or by comparing all. */
#include "base/base.h"
#include "engine/boxes.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

Bounds bounds_of_box(const Box *box) {
    Vec2 reach = mat22_multiply(mat22_abs(box->rotation), box->half);
    /* Eight roundings of numbers that do not exceed |position| + half extent. */
    float size = fabsf(box->position.x) + fabsf(box->position.y) + reach.x + reach.y;
    float slack = 8.0f * FLT_EPSILON * size;
    Vec2 wide = vec2(reach.x + slack, reach.y + slack);
    return (Bounds){vec2_sub(box->position, wide), vec2_add(box->position, wide)};
}

bool broad_phase_find(PairList *list, const Bounds *bounds, const bool *fixed, int count) {
    list->count = 0;
    for (int a = 0; a < count; a++) {
        for (int b = a + 1; b < count; b++) {
            if (!bounds_overlap(&bounds[a], &bounds[b]) || (fixed[a] && fixed[b])) continue;
            if (!array_reserve((void **)&list->pairs, &list->capacity, list->count + 1, sizeof *list->pairs))
                return false;
            list->pairs[list->count++] = (BodyPair){a, b};
        }
    }
    return true;
}

struct SweptBounds {
    float low, high;               /* along the axis */
    float across_low, across_high; /* along the other */
    int body;
    int first_strip, last_strip;
    bool fixed;
};

void sort_and_sweep_free(SortAndSweep *sweep) {
    free(sweep->sorted);
    free(sweep->in_strip);
    free(sweep->starts);
    free(sweep->found.pairs);
    *sweep = (SortAndSweep){0};
}

/* True to sort along the other axis: fewer bounds overlap along the axis with the larger spread of centres. */
static bool other_axis_is_better(const SortAndSweep *sweep, const Bounds *bounds, int count) {
    float x = 0, y = 0, xx = 0, yy = 0;
    for (int i = 0; i < count; i++) {
        float center_x = bounds[i].low.x + bounds[i].high.x, center_y = bounds[i].low.y + bounds[i].high.y;
        x += center_x;
        y += center_y;
        xx += center_x * center_x;
        yy += center_y * center_y;
    }
    float spread_x = xx - x * x / (float)count, spread_y = yy - y * y / (float)count;
    /* By a clear margin, or the axis would alternate and the list be sorted from scratch. */
    const float well_beyond = 2.0f;
    return sweep->along_y ? spread_x > well_beyond * spread_y : spread_y > well_beyond * spread_x;
}

static void refresh(SortAndSweep *sweep, const Bounds *bounds, const bool *fixed, int count) {
    if (count < sweep->count) sweep->count = 0;
    for (; sweep->count < count; sweep->count++) sweep->sorted[sweep->count].body = sweep->count;
    for (int i = 0; i < count; i++) {
        SweptBounds *item = &sweep->sorted[i];
        const Bounds *of = &bounds[item->body];
        item->fixed = fixed[item->body];
        item->low = sweep->along_y ? of->low.y : of->low.x;
        item->high = sweep->along_y ? of->high.y : of->high.x;
        item->across_low = sweep->along_y ? of->low.x : of->low.y;
        item->across_high = sweep->along_y ? of->high.x : of->high.y;
    }
}

/* Insertion sort: linear in a list that is almost sorted. Ends early, with the rest as it was, after `most` moves;
   called again, it goes on there, as what is sorted makes no moves. */
static bool insertion_sort(SweptBounds *items, int count, size_t most, size_t *moved) {
    for (int i = 1; i < count; i++) {
        SweptBounds item = items[i];
        int at = i;
        for (; at > 0 && items[at - 1].low > item.low; at--) items[at] = items[at - 1];
        items[at] = item;
        *moved += (size_t)(i - at);
        if (*moved > most) return false;
    }
    return true;
}

/* Merge sort, for a list in any order. Both sorts are stable, so that it matters to no bit where one takes over. */
static void merge_sort(SweptBounds *items, SweptBounds *scratch, int count, size_t *moved) {
    SweptBounds *from = items, *to = scratch;
    for (int length = 1; length < count; length *= 2) {
        for (int first = 0; first < count; first += 2 * length) {
            const int left = count - first, both = left < 2 * length ? left : 2 * length;
            const SweptBounds *run = from + first; /* two neighbouring runs that are sorted, into one */
            for (int i = 0, left_at = 0, middle = both < length ? both : length, right_at = middle; i < both; i++)
                to[first + i] = right_at == both || (left_at < middle && run[left_at].low <= run[right_at].low)
                                    ? run[left_at++]
                                    : run[right_at++];
        }
        SweptBounds *sorted = to;
        to = from;
        from = sorted;
        *moved += (size_t)count;
    }
    if (from != items) memcpy(items, from, (size_t)count * sizeof *items);
}

static bool sort(SortAndSweep *sweep) {
    const int few_moves = 16; /* of each item */
    const size_t count = (size_t)sweep->count;
    sweep->moved = 0;
    if (insertion_sort(sweep->sorted, sweep->count, (size_t)few_moves * count, &sweep->moved)) return true;
    /* Bodies that are no numbers have no order: how they lie then is that of insertion sort. */
    for (int i = 0; i < sweep->count; i++)
        if (isnan(sweep->sorted[i].low)) return insertion_sort(sweep->sorted, sweep->count, SIZE_MAX, &sweep->moved);
    if (!array_reserve((void **)&sweep->in_strip, &sweep->in_strip_capacity, count, sizeof *sweep->in_strip))
        return false;
    merge_sort(sweep->sorted, sweep->in_strip, sweep->count, &sweep->moved);
    return true;
}

/* Strips of twice the average height of the bounds; a single strip if a body would be in too many. */
static void cut_strips(SortAndSweep *sweep) {
    float low = INFINITY, high = -INFINITY, heights = 0;
    for (int i = 0; i < sweep->count; i++) {
        const SweptBounds *item = &sweep->sorted[i];
        low = item->across_low < low ? item->across_low : low;
        high = item->across_high > high ? item->across_high : high;
        heights += item->across_high - item->across_low;
    }
    float strips = 0.5f * (high - low) * (float)sweep->count / heights;
    sweep->strip_count = strips >= 1.0f && strips <= (float)sweep->count ? (int)strips : 1;
    sweep->strips_begin = low;
    sweep->strips_per_metre = (float)sweep->strip_count / (high - low);
}

static int strip_at(const SortAndSweep *sweep, float across) {
    float strip = (across - sweep->strips_begin) * sweep->strips_per_metre;
    if (!(strip > 0.0f)) return 0;
    return strip < (float)sweep->strip_count ? (int)strip : sweep->strip_count - 1;
}

/* Copies each body into every strip that it overlaps. */
static bool fill_strips(SortAndSweep *sweep) {
    cut_strips(sweep);
    int *starts = sweep->starts;
    memset(starts, 0, ((size_t)sweep->strip_count + 2) * sizeof *starts);
    for (int i = 0; i < sweep->count; i++) {
        SweptBounds *item = &sweep->sorted[i];
        item->first_strip = strip_at(sweep, item->across_low);
        item->last_strip = strip_at(sweep, item->across_high);
        for (int strip = item->first_strip; strip <= item->last_strip; strip++) starts[strip + 2]++;
    }
    for (int strip = 0; strip < sweep->strip_count; strip++) starts[strip + 2] += starts[strip + 1];
    size_t total = (size_t)starts[sweep->strip_count + 1];
    if (!array_reserve((void **)&sweep->in_strip, &sweep->in_strip_capacity, total, sizeof *sweep->in_strip))
        return false;
    for (int i = 0; i < sweep->count; i++) {
        const SweptBounds *item = &sweep->sorted[i];
        for (int strip = item->first_strip; strip <= item->last_strip; strip++)
            sweep->in_strip[starts[strip + 1]++] = *item;
    }
    return true;
}

static bool sweep_strip(PairList *found, const SweptBounds *items, int count, int strip) {
    for (int i = 0; i < count && found->count <= BROAD_PHASE_MAX_PAIRS; i++) {
        SweptBounds item = items[i];
        if (!array_reserve((void **)&found->pairs, &found->capacity, found->count + (size_t)(count - i),
                           sizeof *found->pairs))
            return false;
        for (int k = i + 1; k < count && items[k].low <= item.high; k++) {
            const SweptBounds *other = &items[k];
            int first_common = item.first_strip > other->first_strip ? item.first_strip : other->first_strip;
            /* Branchless: this branch mispredicts. */
            found->pairs[found->count] =
                item.body < other->body ? (BodyPair){item.body, other->body} : (BodyPair){other->body, item.body};
            found->count += (size_t)((item.across_low <= other->across_high) & (other->across_low <= item.across_high) &
                                     (first_common == strip) & !(item.fixed & other->fixed));
        }
    }
    return true;
}

/* Sorts by one of the two bodies; stable. */
static void order_by(int *starts, int count, bool by_a, const PairList *from, BodyPair *to) {
    memset(starts, 0, ((size_t)count + 1) * sizeof *starts);
    for (size_t i = 0; i < from->count; i++) starts[(by_a ? from->pairs[i].a : from->pairs[i].b) + 1]++;
    for (int i = 0; i < count; i++) starts[i + 1] += starts[i];
    for (size_t i = 0; i < from->count; i++) {
        BodyPair pair = from->pairs[i];
        to[starts[by_a ? pair.a : pair.b]++] = pair;
    }
}

bool sort_and_sweep_find(SortAndSweep *sweep, PairList *list, const Bounds *bounds, const bool *fixed, int count) {
    sweep->too_many = false;
    const int few = 24; /* up to here testing every pair is faster */
    if (count <= few) return broad_phase_find(list, bounds, fixed, count);
    size_t items = (size_t)count;
    if (!array_reserve((void **)&sweep->sorted, &sweep->sorted_capacity, items, sizeof *sweep->sorted) ||
        !array_reserve((void **)&sweep->starts, &sweep->starts_capacity, items + 2, sizeof *sweep->starts))
        return false;
    if (other_axis_is_better(sweep, bounds, count)) sweep->along_y = !sweep->along_y;
    refresh(sweep, bounds, fixed, count);
    if (!sort(sweep) || !fill_strips(sweep)) return false;
    sweep->found.count = 0;
    for (int strip = 0; strip < sweep->strip_count; strip++) {
        const int start = sweep->starts[strip], end = sweep->starts[strip + 1];
        if (!sweep_strip(&sweep->found, sweep->in_strip + start, end - start, strip)) return false;
    }
    sweep->too_many = sweep->found.count > BROAD_PHASE_MAX_PAIRS;
    if (sweep->too_many ||
        !array_reserve((void **)&list->pairs, &list->capacity, sweep->found.count, sizeof *list->pairs))
        return false;
    list->count = sweep->found.count;
    order_by(sweep->starts, count, false, &sweep->found, list->pairs);
    PairList by_b = *list;
    *list = sweep->found;
    sweep->found = by_b;
    order_by(sweep->starts, count, true, &sweep->found, list->pairs);
    return true;
}
