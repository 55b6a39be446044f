/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A trained scene network beside momentum in the same time, on held-out launches. */
#pragma once
#include "impact_training/slot_samples.h"

typedef struct SceneNetVerdict {
    int samples;
    double network;       /* m/s: mean error of the network and its sweeps, without sweeps by the stopping rule */
    double at_equal_time; /* m/s: of momentum with `sweeps` */
    double at_20;         /* m/s: of momentum with 20 sweeps */
    int sweeps;           /* of momentum, that take as long as the network and its sweeps: 1 .. 200 */
    double microseconds;  /* of a step by the network and its sweeps */
} SceneNetVerdict;

/* Solves the samples by the method scene-net and by momentum, in turns, and keeps the shortest time of each. The errors
   are the same on every machine; `sweeps` depends on it. */
bool scene_net_verdict(const SlotNetwork *network, const SlotSamples *held_out, SceneNetVerdict *verdict, Error *error);
