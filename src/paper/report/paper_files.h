/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the study leaves in its folder, read. NAN where a number is not applicable. */
#pragma once
#include "paper/report/document.h"
#include "paper/report/table.h"

enum { PAPER_TABLES = 7, PAPER_FIGURES = 10, PAPER_PATH_SIZE = 1024, PAPER_RUN_FRAMES = 600 };

typedef struct Table1Row {
    const char *network, *target, *optimizer;
    double iteration, test, train, constant; /* mean squared errors of normalised outputs */
} Table1Row;

typedef struct NetworkRow {
    const char *network, *factor, *value, *inputs, *data, *labels, *target, *layers, *hidden, *output, *scale,
        *optimizer;
    double parameters, test, constant, ratio, accuracy;
} NetworkRow;

typedef struct RateRow {
    const char *network, *scene, *definition, *phase;
    double rate, constant, engine[3]; /* with 1, 4, 10 sweeps */
} RateRow;

typedef struct ClosedLoopRow {
    const char *network, *scene;
    double frames, penetration, momentum, energy, us_step, us_engine;
} ClosedLoopRow;

typedef struct LawsRow {
    const char *laws;
    double weight, seed, test, constant, violations[4]; /* momentum, energy, approach, cone */
} LawsRow;

typedef struct TransferRow {
    const char *start;
    double seed, launches, error, constant; /* m/s */
} TransferRow;

typedef struct StudyRow {
    const char *key, *value;
} StudyRow;

typedef enum FigureName {
    FIGURE_LOOP,
    FIGURE_NARROW_PHASE,
    FIGURE_DATA,
    FIGURE_SCENES,
    FIGURE_LOSS,
    FIGURE_FACTORS,
    FIGURE_RATES,
    FIGURE_CLOSED_LOOP,
    FIGURE_LAWS,
    FIGURE_TRANSFER
} FigureName;

typedef struct PaperFiles {
    const Table1Row *table1;
    const NetworkRow *networks;
    const RateRow *rates;
    const ClosedLoopRow *closed_loop;
    const LawsRow *laws;
    const TransferRow *transfer;
    const StudyRow *study;
    int table1_count, network_count, rate_count, closed_loop_count, law_count, transfer_count, study_count;
    DocumentFigure figures[PAPER_FIGURES]; /* by FigureName; the pictures stay with the files */
    /* What the above points into. */
    Table tables[PAPER_TABLES];
    char paths[PAPER_TABLES][PAPER_PATH_SIZE], figure_paths[PAPER_FIGURES][64];
    char *captions[PAPER_FIGURES], *pictures[PAPER_FIGURES];
} PaperFiles;

/* On failure nothing is to be freed. */
bool paper_files_read(PaperFiles *files, const char *folder, Error *error);
void paper_files_free(PaperFiles *files);

/* Part of the above: figures/NAME.png and .txt. */
bool paper_figures_read(PaperFiles *files, const char *folder, Error *error);
