/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "player/contact_chunk.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    KEYS = 3,          /* a, b, feature */
    VALUES = 6,        /* point, normal, impulses */
    SEARCH = 16,       /* contacts of the frame before that may be the same one, after the last that was */
    FRACTION_BITS = 5, /* of a logarithm: 32 steps per octave */
    MANTISSA_BITS = 23,
    SHIFT = MANTISSA_BITS - FRACTION_BITS,
    ONE = 127 << FRACTION_BITS, /* the logarithm of 1 */
    MOST = 1 << 30
};
static const double NORMAL = 256, SHARE = 64;

typedef struct Rounded {
    uint32_t keys[KEYS];
    int32_t values[VALUES];
} Rounded;

static int32_t round_to(double value) {
    return value >= MOST ? MOST : value <= -MOST ? -MOST : isnan(value) ? 0 : (int32_t)rint(value);
}

/* A logarithm by the bits of 1 + |impulse| / unit: the same on every machine. */
static int32_t round_impulse(float impulse, float unit) {
    const float shifted = 1 + fabsf(impulse) / unit;
    uint32_t bits;
    if (!isfinite(shifted)) return 0;
    memcpy(&bits, &shifted, sizeof bits);
    const int32_t steps = (int32_t)((bits + (1u << (SHIFT - 1))) >> SHIFT) - ONE;
    return impulse < 0 ? -steps : steps;
}

static Rounded round_contact(const TrajectoryContact *contact, Vec2 center, const ContactUnits *units) {
    Rounded rounded = {.keys = {(uint32_t)contact->a, (uint32_t)contact->b, contact->feature}};
    const double unit = (double)units->length;
    if (!isfinite(center.x) || !isfinite(center.y)) center = vec2(0, 0);
    rounded.values[0] = round_to(((double)contact->point.x - (double)center.x) / unit);
    rounded.values[1] = round_to(((double)contact->point.y - (double)center.y) / unit);
    rounded.values[2] = round_to(NORMAL * (double)contact->normal.x);
    rounded.values[3] = round_to(NORMAL * (double)contact->normal.y);
    rounded.values[4] = round_impulse(contact->normal_impulse, units->impulse);
    rounded.values[5] = round_to(SHARE * (double)contact->tangent_impulse /
                                 (fabs((double)contact->normal_impulse) + (double)units->impulse));
    return rounded;
}

/* The contact with these keys from `from` on; NULL: not among the next ones. */
static const Rounded *find(const Rounded *before, size_t count, size_t *from, const uint32_t keys[KEYS]) {
    for (size_t i = *from; i < count && i < *from + SEARCH; i++)
        if (memcmp(before[i].keys, keys, sizeof before[i].keys) == 0) {
            *from = i + 1;
            return &before[i];
        }
    return NULL;
}

/* The step whose contacts a stored frame has. */
static int step_of(const Trajectory *run, const PlayerFrames *frames, int stored) {
    const int frame = player_frame(frames, stored);
    return frame + 1 < run->frames ? frame + 1 : frame;
}

/* Rounds the contacts of a stored frame. Returns their number. */
static size_t round_frame(Rounded *rounded, const Trajectory *run, const PlayerFrames *frames, int stored,
                          const ContactUnits *units) {
    const int step = step_of(run, frames, stored);
    const size_t first = (size_t)run->contact_start[step], count = (size_t)run->contact_start[step + 1] - first;
    const Vec2 *centers = run->position + (size_t)player_frame(frames, stored) * (size_t)run->bodies;
    for (size_t i = 0; i < count; i++) {
        const TrajectoryContact *contact = &run->contacts[first + i];
        rounded[i] = round_contact(contact, centers[contact->b], units);
    }
    return count;
}

/* Puts a frame's contacts as numbers `at` and following of `total` into the columns. */
static void put_frame(uint8_t *columns, size_t total, size_t at, const Rounded *now, size_t count,
                      const Rounded *before, size_t before_count) {
    for (size_t i = 0, from = 0; i < count; i++) {
        const Rounded *same = find(before, before_count, &from, now[i].keys);
        for (size_t key = 0; key < KEYS; key++) bytes_put(columns + key * 4 * total, total, at + i, now[i].keys[key]);
        for (size_t value = 0; value < VALUES; value++) {
            const uint32_t old = same != NULL ? (uint32_t)same->values[value] : 0;
            bytes_put(columns + (KEYS + value) * 4 * total, total, at + i,
                      bytes_zigzag((uint32_t)now[i].values[value] - old));
        }
    }
}

static size_t count_contacts(const Trajectory *run, const PlayerFrames *frames, int begin, int end, size_t *most) {
    size_t total = 0;
    *most = 0;
    for (int stored = begin; stored < end; stored++) {
        const int step = step_of(run, frames, stored);
        const size_t count = (size_t)(run->contact_start[step + 1] - run->contact_start[step]);
        total += count;
        if (count > *most) *most = count;
    }
    return total;
}

bool contact_chunk(Bytes *chunk, const Trajectory *run, const PlayerFrames *frames, int begin, int end,
                   const ContactUnits *units, Error *error) {
    size_t most, length = (size_t)(end - begin), before_count = 0;
    const size_t total = count_contacts(run, frames, begin, end, &most), size = 4 * (length + (KEYS + VALUES) * total);
    uint8_t *planes = malloc(size + 1);
    Rounded *rows = malloc(2 * (most + 1) * sizeof *rows), *now = rows, *before = rows + most + 1;
    bool ok = planes != NULL && rows != NULL;
    for (size_t k = 0, at = 0; ok && k < length; k++) {
        const size_t count = round_frame(now, run, frames, begin + (int)k, units);
        bytes_put(planes, length, k, (uint32_t)count);
        put_frame(planes + 4 * length, total, at, now, count, before, before_count);
        Rounded *swapped = now;
        now = before, before = swapped;
        before_count = count;
        at += count;
    }
    ok = ok ? bytes_deflate(chunk, planes, size, error) : error_memory(error, "page");
    free(planes);
    free(rows);
    return ok;
}
