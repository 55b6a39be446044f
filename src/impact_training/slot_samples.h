/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a slot network learns from: contact problems of impacts, with their converged solutions. */
#pragma once
#include "common/error.h"
#include "common/progress.h"
#include "impact_training/unrolled.h"
#include "reference/reference.h"
#include "solvers/scene_view.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct SlotSample {
    ContactProblem problem; /* with arrays of its own */
    int launch, since;      /* number of the launch; steps since the bomb's first touch */
    /* After slot_samples_label: */
    ReferenceVelocity *reference; /* [body_count] */
    ContactImpulse *goal;         /* [contact_count] the reference's impulses */
    UnrolledProblem unrolled;
    /* After slot_samples_look: */
    SceneView view;
    float *inputs; /* [slot_network_inputs] */
} SlotSample;

/* Zero-initialise. */
typedef struct SlotSamples {
    SlotSample *items;
    int count;
    size_t capacity;
} SlotSamples;

void slot_samples_free(SlotSamples *samples);

/* Appends a copy of a problem. False when memory is short. */
bool slot_samples_add(SlotSamples *samples, const ContactProblem *problem, int launch, int since);

/* Moves all of `from` to the end of the samples. False when memory is short. */
bool slot_samples_take(SlotSamples *samples, SlotSamples *from);

/* Solves those from `first` on by the reference, until max_visits of contacts are done. */
bool slot_samples_label(SlotSamples *samples, int first, int max_visits, const Progress *progress, Error *error);

/* Shows those from `first` on to a network: their views and, where the projections are there, inputs. */
bool slot_samples_look(SlotSamples *samples, int first, const SlotNetwork *network, Error *error);
