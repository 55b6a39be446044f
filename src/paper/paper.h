/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The study of the paper (Avatavului, Ifrim, Voncila 2023), from seed to tables: networks trained in every reading of
   the paper, one factor at a time; their rates of right predictions; their runs in place of the solver; laws of physics
   in the loss; transfer learning; the systems that the paper cites. Every network is trained on several splits of the
   launches.

     const PaperOptions options = {.scenes = "scenes", .folder = "out/paper", .seed = 1, .draw = draw};
     Pieces pieces = {0};
     if (!paper_run(&options, &pieces, &progress, &error)) ... */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "runs/pieces.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct PaperOptions {
    const char *scenes; /* folder of single.yaml, stack.yaml, pyramid.yaml, pyramid_settled.yaml */
    const char *folder; /* created if missing */
    bool quick;         /* fewer networks, launches, iterations */
    uint64_t seed;
    Shard shard; /* zero: the whole study */
    /* Draws what the tables show, and writes the report. */
    bool (*draw)(const struct PaperOptions *study, Error *error);
} PaperOptions;

/* Writes folder/table1.csv, networks.csv, constants.csv, rates.csv, closed_loop.csv, laws.csv, transfer.csv,
   system_scores.csv, study.csv and folder/networks/NAME-SEED.npz, then draws; a shard does its parts only, and of the
   files writes the networks that it trains. Finished parts are kept: the same study, by the same program, continues
   where it was interrupted. ERROR_INPUT for a scene that cannot be read; ERROR_INTERRUPTED if progress_report() stops
   it. *pieces tells what was done; it has no plan. */
bool paper_run(const PaperOptions *options, Pieces *pieces, const Progress *progress, Error *error);
