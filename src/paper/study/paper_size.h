/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sizes of the whole study, and of the quick one, which runs every part briefly. */
#pragma once
#include "paper/study/pair_rates.h"
#include "paper/study/paper_data.h"
#include "study/closed_loop.h"

enum { PAPER_WEIGHTS = 5, PAPER_LAUNCHES = 8 };

typedef struct PaperSize {
    PaperDataSize data;
    int iterations; /* of every training, at most */
    int rate_launches, closed_launches, repetitions;
    Sampling sampling;
    int seeds, law_iterations, transfer_iterations; /* of the outlook */
    double weights[PAPER_WEIGHTS];                  /* of laws, ended by 0 */
    int launches[PAPER_LAUNCHES];                   /* of transfer, ended by 0 */
    const char *transfer_x[3];                      /* single, stack, pyramid */
    /* Of the scores of systems (paper/systems/system_scores.h). */
    int system_launches, system_frames, system_timed_frames, system_repetitions;
} PaperSize;

extern const PaperSize paper_whole_size, paper_quick_size;
