/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The whole study of Avatavului, Ifrim, Voncila (2023), from seed to tables: networks trained in every reading of the
   paper, one factor at a time; how often they are right; what they do in the solver's place; laws of physics in the loss;
   transfer learning. */
#pragma once
#include "common/error.h"
#include "common/progress.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct PaperOptions {
    const char *scenes; /* folder of single.yaml, stack.yaml, pyramid.yaml, pyramid_settled.yaml */
    const char *folder; /* made where it is missing */
    bool quick;         /* fewer networks, launches, iterations */
    uint64_t seed;
} PaperOptions;

/* Writes folder/table1.csv, networks.csv, rates.csv, closed_loop.csv, laws.csv, transfer.csv, study.csv and
   folder/networks/NAME.npz. What is done is kept in folder/parts-KEY, so that the same study, by the same program, goes on
   where it was cut off. ERROR_INPUT for a scene that cannot be read, or where progress asks to stop. */
bool paper_run(const PaperOptions *options, const Progress *progress, Error *error);
