/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the files of this room share. */
#pragma once
#include "picture/picture.h"
#include "player/contact_chunk.h"
#include "player/player.h"

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
    Bytes viewer; /* its script */
} Player;

/* Finds what a reader looks for: where runs part, distances, hashes. */
bool player_find_marks(Player *player, Error *error);

/* Packs all states, then all contacts, or leaves these out if the page would be too large. ERROR_INPUT if it is even so. */
bool player_pack(Player *player, Error *error);

bool player_pack_viewer(Player *player, Error *error);

/* Frees all that a player holds. */
void player_free(Player *player);

/* What the page's script (page/codec.js) reads first: JSON. */
void player_put_data(FILE *file, const Player *player);

/* The whole page. The context is a Player. */
void player_put_page(FILE *file, const void *player);
