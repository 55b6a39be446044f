/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The chunks of all runs, within the size of a page. */
#include "player/player_parts.h"
#include "player/state_chunk.h"

#include <math.h>
#include <stdlib.h>

enum { HEAD = 256 << 10 }; /* bytes for all that is no chunk of a run; a frame of a run has hash and distance besides */

static double base64_size(double bytes) { return bytes * 4 / 3; }

static double fixed_size(const Player *player) {
    const double per_frame = base64_size(sizeof(uint64_t) + sizeof(float));
    const double per_body = base64_size(2 * sizeof(float)) + 1;
    double size = HEAD;
    for (int i = 0; i < player->picture.count; i++)
        size += per_frame * player->runs[i].frames + per_body * player->picture.runs[i]->bodies;
    return size;
}

/* If no state could be packed. */
static double unpacked_size(const Player *player) {
    double size = fixed_size(player);
    for (int i = 0; i < player->picture.count; i++)
        size += base64_size(6.0 * sizeof(float)) * player->runs[i].frames * player->picture.runs[i]->bodies;
    return size;
}

/* `done` of all chunks take `size` bytes. If frames are left out, the prediction of poses is worse: they take up to twice the
   room. */
static bool refuse(const Player *player, double size, int done, int chunks, Error *error) {
    const double all = size * chunks / done, worst = fmin(2 * all, unpacked_size(player));
    const int every = player->frames.every * ((int)(worst / player->most_bytes) + 1);
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
        run->states = calloc((size_t)run->chunks, sizeof *run->states);
        if (run->states == NULL) return error_memory(error, "page");
        for (int k = 0; k < run->chunks; k++) {
            if (!state_chunk(&run->states[k], player->picture.runs[i], &player->frames, k * PLAYER_CHUNK,
                             chunk_end(run, k), error))
                return false;
            *size += base64_size((double)run->states[k].size);
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
        *size += base64_size((double)run->contacts[k].size);
    }
    return true;
}

bool player_pack(Player *player, Error *error) {
    double size = fixed_size(player);
    if (size > player->most_bytes) return refuse(player, size, 1, 1, error);
    if (!pack_states(player, &size, error)) return false;
    for (int i = 0; i < player->picture.count; i++)
        if (!player->picture.runs[i]->no_contacts && !pack_contacts_of(player, i, &size, error)) return false;
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
    picture_free(&player->picture);
}
