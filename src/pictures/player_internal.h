/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of a page that plays runs: packed states and contacts, marks, the viewer. */
#pragma once
#include "base/base.h"
#include "base/json.h"
#include "pictures/picture.h"
#include "pictures/player.h"
#include "pixels/type.h"
#include "runs/trajectory.h"

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* Deflated bytes on their way into a page. */

typedef struct Bytes {
    uint8_t *data; /* freed by the caller; NULL: nothing */
    size_t size;
} Bytes;

/* Deflates (RFC 1951, as browsers' DecompressionStream("deflate-raw") reads it). False with error set when memory is
   short. */
bool bytes_deflate(Bytes *bytes, const void *data, size_t size, Error *error);

/* Writes bytes as digits of base 91, which need no escape in an element `script`: 13 bits, the first ones lowest, are
   two digits, the lower one first, as 91^2 > 2^13; up to 6 bits at the end are one. Base64 takes 8% more room.
   player/begin.js is the decoder. */
void bytes_put_digits(FILE *file, const void *data, size_t size);

/* Differences, small ones of either sign, as small numbers: 0, -1, 1, -2, ... become 0, 1, 2, 3, ... */
static inline uint32_t bytes_zigzag(uint32_t difference) { return difference << 1 ^ (0 - (difference >> 31)); }

/* Puts number i of `count` into four planes of `count` bytes each, the lowest bytes first: equal bytes of like numbers
   follow each other. */
static inline void bytes_put(uint8_t *planes, size_t count, size_t i, uint32_t number) {
    for (int plane = 0; plane < 4; plane++) planes[(size_t)plane * count + i] = (uint8_t)(number >> (8 * plane));
}

/* The frames of the runs that a page has: stored frame i is frame first + i * every. */

enum { PLAYER_CHUNK = 128 }; /* stored frames that are decoded together */

typedef struct PlayerFrames {
    int first, last, every; /* frames of the runs; last: of the longest */
} PlayerFrames;

static inline int player_frame(const PlayerFrames *frames, int stored) {
    return frames->first + stored * frames->every;
}

/* The number of stored frames of a run with this many frames. */
static inline int player_frame_count(const PlayerFrames *frames, int run_frames) {
    const int last = frames->last < run_frames - 1 ? frames->last : run_frames - 1;
    return last < frames->first ? 0 : (last - frames->first) / frames->every + 1;
}

/* The first stored frame that is not before a frame of the run; -1 for a frame (-1) that is not there, or not
   stored. */
static inline int player_stored(const PlayerFrames *frames, int frame) {
    if (frame < 0 || frame > frames->last) return -1;
    const int stored = frame <= frames->first ? 0 : (frame - frames->first + frames->every - 1) / frames->every;
    return player_frame(frames, stored) <= frames->last ? stored : -1;
}

/* s between stored frames. */
static inline float player_dt(const PlayerFrames *frames, const Trajectory *run) {
    return run->dt * (float)frames->every;
}

/* The contacts of some stored frames of a run, rounded; player/codec.js is the decoder. Those of a frame are of the
   step that follows from its poses; of the last frame, of its own step.

   A number per frame: of contacts. Then columns with a number per contact: bodies a and b, feature; and, as differences
   from the same contact in the frame before, the point's x and y from the centre of b in units of `length`, the
   normal's x and y in 1/256, the logarithm of the normal impulse, the tangent impulse in 1/64 of the normal one and a
   unit, and the mode. In a pile that rests, friction keeps its share of the normal impulse: so most differences are
   small. */

/* What is rounded away. */
typedef struct ContactUnits {
    float length;  /* m, of points */
    float impulse; /* N s: normal ones below it are rounded to 1/32 of it, larger ones to 1.6% */
} ContactUnits;

/* The fixed parts of the page (src/pictures/player), embedded in the binary by base/tools/embed.cmake. */

extern const char player_page_css[], player_body_html[], player_help_html[];
extern const char player_begin[], player_viewer[]; /* scripts; the first unpacks and runs the second */
extern const unsigned char player_begin_sha256[], player_viewer_sha256[];

typedef struct PlayerRun {
    int frames, chunks;              /* stored */
    Bytes *states;                   /* [chunks] */
    Bytes *contacts;                 /* [chunks]; NULL: not recorded, or left out */
    uint64_t *hashes;                /* [frames] of the states */
    float *distances;                /* [frames] m, largest distance from the first run; NaN: not compared */
    bool compared;                   /* its world is the first run's */
    char why[256];                   /* it is not */
    int differs_frame, differs_body; /* stored frame and body with the first different bit; -1: none */
    int apart_frame, apart_body;     /* the same, for a visible distance */
} PlayerRun;

typedef struct Player {
    const PlayerOptions *options;
    Picture picture; /* of the runs, in any size: their names, colours and distances */
    PlayerFrames frames;
    double most_bytes;      /* of the page */
    ScaleMeasures measures; /* of the first run */
    ContactUnits units;
    PlayerRun runs[RENDER_PANELS_MAX];
    bool left_contacts;
    Bytes viewer, data;   /* deflated player_viewer, and the JSON that it reads */
    Bytes module, bundle; /* deflated, of live runs */
} Player;

/* Whether the page steps this run itself: it is not stored. */
static inline bool player_run_is_live(const Player *player, int index) {
    return player->options->live != NULL && player->options->live->methods[index] != NULL;
}

/* Packs all states, then all contacts, or leaves these out if the page would be too large. ERROR_INPUT if it is even
   so. */
bool player_pack(Player *player, Error *error);

/* Frees all that a player holds. */
void player_free(Player *player);
