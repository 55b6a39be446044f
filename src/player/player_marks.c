/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where runs part from the first one. */
#include "player/player_parts.h"
#include "trajectory/trajectory_states.h"

#include <math.h>
#include <stdlib.h>

static const double POINT = 2e-3; /* of a box: a tenth of a pixel where a box has 50 */
static const double SMALL = 1e-2; /* of common impulses: shorter arrows cannot be seen */

typedef bool IsThere(const Trajectory *first, const Trajectory *run, int frame, int body);

static bool differs(const Trajectory *first, const Trajectory *run, int frame, int body) {
    return !trajectory_same_state(first, run, frame, body);
}

static bool is_apart(const Trajectory *first, const Trajectory *run, int frame, int body) {
    return trajectory_has(first, frame, body) && trajectory_has(run, frame, body) &&
           trajectory_state_difference(first, run, frame, body).distance > EVENTS_VISIBLE_DISTANCE;
}

/* The first frame and body for which it holds; -1, -1: none. */
static void find(const Trajectory *first, const Trajectory *run, IsThere *is_there, int *frame, int *body) {
    const int frames = first->frames < run->frames ? first->frames : run->frames;
    for (*frame = 0; *frame < frames; ++*frame)
        for (*body = 0; *body < run->bodies; ++*body)
            if (is_there(first, run, *frame, *body)) return;
    *frame = *body = -1;
}

static void find_marks(Player *player, int index) {
    const Trajectory *first = player->picture.runs[0], *trajectory = player->picture.runs[index];
    PlayerRun *run = &player->runs[index];
    run->frames = player_frame_count(&player->frames, trajectory->frames);
    run->chunks = (run->frames + PLAYER_CHUNK - 1) / PLAYER_CHUNK;
    run->differs_frame = run->apart_frame = -1;
    run->compared = index == 0 || !trajectory_different_worlds(first, trajectory, run->why, sizeof run->why);
    if (index == 0 || !run->compared) return;
    find(first, trajectory, differs, &run->differs_frame, &run->differs_body);
    find(first, trajectory, is_apart, &run->apart_frame, &run->apart_body);
    run->differs_frame = player_stored(&player->frames, run->differs_frame);
    run->apart_frame = player_stored(&player->frames, run->apart_frame);
}

static bool measure_frames(Player *player, int index, Error *error) {
    PlayerRun *run = &player->runs[index];
    run->hashes = malloc((size_t)run->frames * sizeof *run->hashes);
    run->distances = malloc((size_t)run->frames * sizeof *run->distances);
    if (run->hashes == NULL || run->distances == NULL) return error_memory(error, "page");
    for (int i = 0; i < run->frames; i++) {
        const int frame = player_frame(&player->frames, i);
        run->hashes[i] = trajectory_frame_hash(player->picture.runs[index], frame);
        run->distances[i] =
            run->compared ? (float)picture_run_distance(&player->picture, index, moment_stored(frame)) : NAN;
    }
    return true;
}

bool player_find_marks(Player *player, Error *error) {
    for (int i = 0; i < player->picture.count; i++) find_marks(player, i);
    const double impulse = SMALL * player->measures.impulse;
    player->units = (ContactUnits){(float)(POINT * player->measures.box), impulse > 0 ? (float)impulse : 1};
    for (int i = 0; i < player->picture.count; i++) {
        if (player->runs[i].frames == 0)
            return error_input(error, "--frames", "run %d (%s) ends before frame %d", i + 1,
                               player->picture.runs[i]->method, player->frames.first);
        if (!measure_frames(player, i, error)) return false;
    }
    return true;
}
