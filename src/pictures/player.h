/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A page that plays runs side by side: one HTML file that needs no network and no other file. It has every state of its
   frames bit by bit, and contacts rounded (pictures/player_internal.h). The script that draws it is in
   pictures/player. */
#pragma once
#include "base/base.h"
#include "live/live.h"
#include "methods/methods.h"
#include "pictures/picture.h"
#include "runs/trajectory.h"

#include <stdint.h>

/* Browsers take long to open larger pages. */
#define PLAYER_MAX_BYTES 64000000

/* What makes runs of a page live: it steps them itself, and its readers can launch them again (live/live.h). */
typedef struct PlayerLive {
    const char *methods[RENDER_PANELS_MAX]; /* of the runs; NULL: this run is recorded */
    const void *bundle;                     /* live_pack() */
    size_t bundle_size;
    LiveModule module;
} PlayerLive;

typedef struct PlayerOptions {
    int first, last;                       /* frames of the runs, inclusive; last -1: to the end */
    int every;                             /* shows every n-th of these frames; 0, 1: all */
    int64_t most_bytes;                    /* of the page; 0: PLAYER_MAX_BYTES */
    const char *title;                     /* NULL: the scene of the first run */
    const char *files[RENDER_PANELS_MAX];  /* where the runs are, for the command that the page copies; NULL: unknown */
    const char *scenes[RENDER_PANELS_MAX]; /* the same of runs without files: no path of the machine; NULL */
    const char *set;                       /* settings of these scenes: "name=value,name=value"; "", NULL: none */
    const char *names[RENDER_PANELS_MAX];  /* of runs; NULL: the method */
    ColourChoices colours;
    const PlayerLive *live; /* NULL: all runs are recorded */
    /* The description of a run's method ("engine:k=20"). NULL, or returns NULL: the method has no description. */
    const MethodDescription *(*describe)(const char *method);
} PlayerOptions;

typedef struct PlayerResult {
    int frames;         /* of the longest run in the page */
    int64_t bytes;      /* of the page */
    bool left_contacts; /* contacts were left out: with them the page would be too large */
} PlayerResult;

/* Writes the page of 1 to RENDER_PANELS_MAX runs with equal time steps; of different scenes, too: then the page says
   what it cannot compare. The same runs and options give the same bytes. ERROR_INPUT if the page would be too large,
   with a value of `every` that suffices, or if a frame is beyond the last one. */
bool player_write(const Trajectory *const *runs, int count, const PlayerOptions *options, const char *path,
                  PlayerResult *result, Error *error);

/* What follows the name of a page in a link to a moment: "#t=0.55&body=7"; without a body (-1) "#t=0.55". */
enum { PLAYER_LINK_SIZE = 64 };
void player_link(char text[PLAYER_LINK_SIZE], double time, int body);
