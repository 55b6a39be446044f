/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The launches that a round of training records, of several scenes. */
#pragma once
#include "relation/relation_network.h"
#include "relation_training/relation_recording.h"

/* sain with a network in memory. */
typedef struct RelationDriver {
    const RelationNetwork *network;
    RelationForm form;
} RelationDriver;

typedef struct RelationLaunches {
    Scene *const *scenes;
    int scene_count;
    int launches;                 /* of each scene */
    int rounds, round;            /* rounds have different launches, each over the whole family */
    bool held_out;                /* other launches than those of any round */
    const RelationDriver *driver; /* NULL: the engine and, every second launch, sweeps with momentum */
} RelationLaunches;

/* Appends to the problems, as relation_record(). ERROR_INPUT: a scene's bomb has no family of launches. */
bool relation_launches_record(const RelationLaunches *launches, ImpactProblems *problems, const Progress *progress,
                              Error *error);
