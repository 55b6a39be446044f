/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training samples of a slot network: contact problems of impacts with their converged solutions. */
#pragma once
#include "common/error.h"
#include "common/progress.h"
#include "impact_training/unrolled.h"
#include "reference/reference.h"
#include "solvers/scene_view.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

typedef struct SlotSample {
    ContactProblem problem; /* owns its arrays */
    int launch, since;      /* number of the launch; steps since the bomb's first touch */
    /* After slot_samples_label: */
    ReferenceVelocity *reference; /* [body_count] */
    ContactImpulse *goal;         /* [contact_count] impulses of the reference */
    UnrolledProblem unrolled;
    /* After slot_samples_compute_inputs: */
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

/* Appends a copy of a problem. False if out of memory. */
bool slot_samples_add(SlotSamples *samples, const ContactProblem *problem, int launch, int since);

/* Moves all of `from` to the end of the samples. False if out of memory. */
bool slot_samples_move(SlotSamples *samples, SlotSamples *from);

/* Solves the samples from index `first` by the reference. */
bool slot_samples_label(SlotSamples *samples, int first, const Progress *progress, Error *error);

/* Computes the view and the network inputs of the samples from index `first`. The inputs are valid only if the network
   has projections. */
bool slot_samples_compute_inputs(SlotSamples *samples, int first, const SlotNetwork *network, Error *error);

/* Labelled samples as bytes, without view and inputs, which follow from the network. Whether writing failed is for the stream
   to tell. */
void slot_samples_write(const SlotSamples *samples, FILE *out);

/* Appends what slot_samples_write() wrote. ERROR_INPUT, naming the file `path`, if the bytes are damaged, or the problems do not
   have a bomb and `bodies` bodies. */
bool slot_samples_read(SlotSamples *samples, const char *data, size_t size, int bodies, const char *path, Error *error);
