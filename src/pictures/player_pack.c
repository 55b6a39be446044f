/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The states of some stored frames of a run, without loss; player/codec.js is the decoder.

   For vx, vy, omega, x, y, angle in turn: each body's values in the order of frames, as the difference of the float's
   bits from those of a prediction. That of a velocity is its value in the frame before. That of a pose is the one that
   a step with the new velocity leads to, x + dt * vx in float: this is how the engine moves bodies, so most differences
   are 0. In the first frame of a chunk the prediction is 0, so that each chunk can be decoded by itself. */
#include "base/base.h"
#include "engine/engine.h"
#include "pictures/picture.h"
#include "pictures/player_internal.h"
#include "runs/trajectory.h"

#include <libdeflate.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

bool bytes_deflate(Bytes *bytes, const void *data, size_t size, Error *error) {
    enum { LEVEL = 10 }; /* the highest, 12, takes 2.5 times as long for pages that are 1.5% smaller */
    struct libdeflate_compressor *compressor = libdeflate_alloc_compressor(LEVEL);
    const size_t bound = compressor != NULL ? libdeflate_deflate_compress_bound(compressor, size) : 0;
    *bytes = (Bytes){.data = compressor != NULL ? malloc(bound) : NULL};
    if (bytes->data != NULL) bytes->size = libdeflate_deflate_compress(compressor, data, size, bytes->data, bound);
    libdeflate_free_compressor(compressor);
    return bytes->data != NULL || error_memory(error, "page");
}

enum { PAIR_BITS = 13, BASE = 91 };

/* `$` to `~`, with `#` in place of `<`. */
static void put_digit(FILE *file, uint32_t digit) {
    putc_unlocked(digit == '<' - '$' ? '#' : '$' + (int)digit, file); /* an error stays in the file, for the caller */
}

void bytes_put_digits(FILE *file, const void *data, size_t size) {
    const uint8_t *bytes = data;
    uint32_t bits = 0;
    int count = 0;
    for (size_t i = 0; i < size; i++) {
        bits |= (uint32_t)bytes[i] << count;
        count += 8;
        if (count < PAIR_BITS) continue;
        const uint32_t pair = bits & ((1u << PAIR_BITS) - 1);
        put_digit(file, pair % BASE);
        put_digit(file, pair / BASE);
        bits >>= PAIR_BITS;
        count -= PAIR_BITS;
    }
    if (count > 0) put_digit(file, bits % BASE);
    if (count > PAIR_BITS / 2) put_digit(file, bits / BASE);
}

static double digits_size(double bytes) { return 2 * ceil(8 * bytes / PAIR_BITS); }

enum { COMPONENTS = 6, POSES = 3 }; /* velocities first, then poses */

static float component(const Trajectory *run, size_t i, int which) {
    switch (which) {
    case 0: return run->velocity[i].x;
    case 1: return run->velocity[i].y;
    case 2: return run->angular_velocity[i];
    case 3: return run->position[i].x;
    case 4: return run->position[i].y;
    default: return run->angle[i];
    }
}

static uint32_t bits_of(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* Stored frames [begin, end) of a run. */
static bool state_chunk(Bytes *chunk, const Trajectory *run, const PlayerFrames *frames, int begin, int end,
                        Error *error) {
    const size_t bodies = (size_t)run->bodies, length = (size_t)(end - begin), count = bodies * length;
    const float dt = player_dt(frames, run);
    uint8_t *planes = malloc(COMPONENTS * count * sizeof(float) + 1);
    if (planes == NULL) return error_memory(error, "page");
    for (int which = 0; which < COMPONENTS; which++)
        for (size_t body = 0; body < bodies; body++)
            for (size_t k = 0; k < length; k++) {
                const size_t at = (size_t)player_frame(frames, begin + (int)k) * bodies + body;
                float predicted = 0;
                if (k > 0) {
                    const float before = component(run, at - (size_t)frames->every * bodies, which);
                    predicted = which < POSES ? before : before + dt * component(run, at, which - POSES);
                    /* A NaN has no bits that all machines agree on: then the value before is the prediction. */
                    if (which >= POSES && isnan(predicted)) predicted = before;
                }
                bytes_put(planes + (size_t)which * count * sizeof(float), count, body * length + k,
                          bytes_zigzag(bits_of(component(run, at, which)) - bits_of(predicted)));
            }
    const bool ok = bytes_deflate(chunk, planes, COMPONENTS * count * sizeof(float), error);
    free(planes);
    return ok;
}

enum {
    KEYS = 3,          /* a, b, feature */
    VALUES = 7,        /* point, normal, impulses, mode */
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

static Rounded round_contact(const TrajectoryContact *contact, ContactMode mode, Vec2 center,
                             const ContactUnits *units) {
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
    rounded.values[6] = (int32_t)mode;
    return rounded;
}

/* The contact with these keys from `from` on; NULL: not among the next ones. */
static const Rounded *find_same(const Rounded *before, size_t count, size_t *from, const uint32_t keys[KEYS]) {
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

/* Puts a frame's contacts as numbers `at` and following of `total` into the columns. */
static void put_frame(uint8_t *columns, size_t total, size_t at, const Rounded *now, size_t count,
                      const Rounded *before, size_t before_count) {
    for (size_t i = 0, from = 0; i < count; i++) {
        const Rounded *same = find_same(before, before_count, &from, now[i].keys);
        for (size_t key = 0; key < KEYS; key++) bytes_put(columns + key * 4 * total, total, at + i, now[i].keys[key]);
        for (size_t value = 0; value < VALUES; value++) {
            const uint32_t old = same != NULL ? (uint32_t)same->values[value] : 0;
            bytes_put(columns + (KEYS + value) * 4 * total, total, at + i,
                      bytes_zigzag((uint32_t)now[i].values[value] - old));
        }
    }
}

/* Stored frames [begin, end) of a run. */
static bool contact_chunk(Bytes *chunk, const Trajectory *run, const PlayerFrames *frames, int begin, int end,
                          const ContactUnits *units, Error *error) {
    const size_t length = (size_t)(end - begin);
    size_t most = 0, total = 0, before_count = 0;
    for (int stored = begin; stored < end; stored++) {
        const int step = step_of(run, frames, stored);
        const size_t count = (size_t)(run->contact_start[step + 1] - run->contact_start[step]);
        total += count;
        if (count > most) most = count;
    }
    const size_t size = 4 * (length + (KEYS + VALUES) * total);
    uint8_t *planes = malloc(size + 1);
    Rounded *rows = malloc(2 * (most + 1) * sizeof *rows), *now = rows, *before = rows != NULL ? rows + most + 1 : NULL;
    bool ok = planes != NULL && rows != NULL;
    for (size_t k = 0, at = 0; ok && k < length; k++) {
        const int stored = begin + (int)k, step = step_of(run, frames, stored);
        const size_t first = (size_t)run->contact_start[step], count = (size_t)run->contact_start[step + 1] - first;
        const Vec2 *centers = run->position + (size_t)player_frame(frames, stored) * (size_t)run->bodies;
        for (size_t i = 0; i < count; i++) {
            const TrajectoryContact *contact = &run->contacts[first + i];
            const ContactMode mode = trajectory_mode(run, step, (int64_t)(first + i));
            now[i] = round_contact(contact, mode, centers[contact->b], units);
        }
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

/* The chunks of all runs, within the size of a page. */

enum { HEAD = 256 << 10 }; /* bytes for all that is no chunk of a run; a frame of a run has hash and distance besides */

static double fixed_size(const Player *player) {
    const double per_frame = digits_size(sizeof(uint64_t) + sizeof(float));
    const double per_body = digits_size(2 * sizeof(float)) + 1;
    double size = HEAD;
    for (int i = 0; i < player->picture.count; i++)
        size += per_frame * player->runs[i].frames + per_body * player->picture.runs[i]->bodies;
    return size;
}

/* `done` of all chunks take `size` bytes, with HEAD, which stays if frames are left out. The prediction of poses is
   worse then: they take up to twice the room, but no more than if no state could be packed. */
static bool refuse(const Player *player, double size, int done, int chunks, Error *error) {
    double unpacked = fixed_size(player);
    for (int i = 0; i < player->picture.count; i++)
        unpacked += digits_size(6.0 * sizeof(float)) * player->runs[i].frames * player->picture.runs[i]->bodies;
    const double all = HEAD + (size - HEAD) * chunks / done, worst = fmin(2 * all, unpacked);
    const int every = player->frames.every * (int)ceil((worst - HEAD) / (player->most_bytes - HEAD));
    return error_input(
        error, "page",
        "it would take about %.3g MB, more than %.3g; use --every %d, or keep a part of the run with --frames",
        all / 1e6, player->most_bytes / 1e6, every);
}

static int chunk_end(const PlayerRun *run, int chunk) {
    const int end = (chunk + 1) * PLAYER_CHUNK;
    return end < run->frames ? end : run->frames;
}

static bool pack_states(Player *player, double *size, Error *error) {
    int chunks = 0, done = 0;
    for (int i = 0; i < player->picture.count; i++) chunks += player->runs[i].chunks;
    for (int i = 0; i < player->picture.count; i++) {
        PlayerRun *run = &player->runs[i];
        if (run->chunks == 0) continue;
        run->states = calloc((size_t)run->chunks, sizeof *run->states);
        if (run->states == NULL) return error_memory(error, "page");
        for (int k = 0; k < run->chunks; k++) {
            if (!state_chunk(&run->states[k], player->picture.runs[i], &player->frames, k * PLAYER_CHUNK,
                             chunk_end(run, k), error))
                return false;
            *size += digits_size((double)run->states[k].size);
            if (*size > player->most_bytes) return refuse(player, *size, done + 1, chunks, error);
            done++;
        }
    }
    return true;
}

static void free_chunks(Bytes **chunks, int count) {
    for (int k = 0; *chunks != NULL && k < count; k++) free((*chunks)[k].data);
    free(*chunks);
    *chunks = NULL;
}

static bool pack_contacts_of(Player *player, int index, double *size, Error *error) {
    PlayerRun *run = &player->runs[index];
    run->contacts = calloc((size_t)run->chunks, sizeof *run->contacts);
    if (run->contacts == NULL) return error_memory(error, "page");
    for (int k = 0; k < run->chunks && *size <= player->most_bytes; k++) {
        if (!contact_chunk(&run->contacts[k], player->picture.runs[index], &player->frames, k * PLAYER_CHUNK,
                           chunk_end(run, k), &player->units, error))
            return false;
        *size += digits_size((double)run->contacts[k].size);
    }
    return true;
}

bool player_pack(Player *player, Error *error) {
    double size = fixed_size(player);
    if (size > player->most_bytes) return refuse(player, size, 1, 1, error);
    if (!pack_states(player, &size, error)) return false;
    for (int i = 0; i < player->picture.count; i++)
        if (!player_run_is_live(player, i) && !player->picture.runs[i]->no_contacts &&
            !pack_contacts_of(player, i, &size, error))
            return false;
    player->left_contacts = size > player->most_bytes;
    for (int i = 0; player->left_contacts && i < player->picture.count; i++)
        free_chunks(&player->runs[i].contacts, player->runs[i].chunks);
    return true;
}

void player_free(Player *player) {
    for (int i = 0; i < player->picture.count; i++) {
        free_chunks(&player->runs[i].states, player->runs[i].chunks);
        free_chunks(&player->runs[i].contacts, player->runs[i].chunks);
        free(player->runs[i].hashes);
        free(player->runs[i].distances);
    }
    free(player->viewer.data);
    free(player->data.data);
    free(player->module.data);
    free(player->bundle.data);
    picture_free(&player->picture);
}
