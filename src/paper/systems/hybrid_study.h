/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the memory of hybrid learns over the launches, what it costs and what it saves. */
#pragma once
#include "paper/systems/system.h"

enum { HYBRID_ROWS_MAX = 500 };

/* system_hybrid.csv: a learning (tabulation_training/) at some number of launches. Shares are of the launches since the row
   before, each answered by the memory as it was before the launch. Errors and times are of launches that it has not
   learned, by the memory so far. NAN where nothing was answered. */
typedef struct HybridRow {
    int scene;        /* of paper_scene_names */
    double tolerance; /* m/s */
    int changes; /* 1: a learning whose family changes half way: from then on bombs have a random rotation and spin; 0: not */
    int turned;           /* 1: they have */
    double launches;      /* so far */
    double share;         /* of the steps with an impact: answered */
    double share_all;     /* of all steps with the bomb */
    double error;         /* m/s: RMS velocity error of answers against the converged solution, mean */
    double error_95;      /* their 95% quantile */
    double us_answer;     /* microseconds of an answered step, with key and search */
    double us_solve;      /* of the same steps by interior:near=0.001 */
    double us_question;   /* what a step that is not answered takes beyond that */
    double us_step;       /* of a step with an impact, answered or not */
    double us_step_solve; /* of the same by interior:near=0.001 */
    double
        online_error; /* m/s: of the second form (tabulation_training/online_net.h) on the entries since the row before, each
                            before it was trained on it, mean; NAN: not run */
    double online_us; /* processor time of such a training step, without the solution that it is trained on */
    double entries, kib;
    double learning_ms; /* spent on learning so far */
    double saved_ms;    /* solving less answering, questions and learning so far */
    double paid;        /* the launch from which on saved_ms was never below 0 again; NAN: it still is */
} HybridRow;

extern const CsvLayout hybrid_layout;

/* Parts of the study, ended by a name of NULL. */
extern const SystemPart hybrid_parts[];

bool hybrid_claim(const Claims *claims, Error *error);
