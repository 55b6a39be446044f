/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A scene with some of its held-out launches. */
#pragma once
#include "study/frozen.h"

enum { LAUNCHED_MAX = 64 };

typedef struct Launched {
    Scene *scene;
    int count;
    Scene *launches;      /* [count] launches_for_scoring() */
    SnapshotList *states; /* [count] empty until sampled */
} Launched;

/* count: at most LAUNCHED_MAX. ERROR_INPUT for a scene that cannot be read, or without a bomb or a family of launches. On
   failure nothing is to be freed. */
bool launched_begin(Launched *launched, const char *path, int count, Error *error);
void launched_free(Launched *launched);
