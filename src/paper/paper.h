/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The networks of the paper's study (Avatavului, Ifrim, Voncila 2023): a baseline, and others that differ from it in
   one factor each. The paper's own words for the baseline: ten inputs made of differences of positions (3.1), one
   hidden layer of ten, two outputs, sigmoids throughout, outputs scaled to [0, 1] (3.2), the sweep of launches (3.3).
   */
#pragma once
#include "base/base.h"
#include "base/csv.h"
#include "base/machine.h"
#include "figures/sketch.h"
#include "learning/dataset.h"
#include "methods/pair.h"
#include "pictures/picture.h"
#include "runs/pieces.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/* Recorded launches of the single box and of the stack. DATA_PAPER has the paper's 201 places; the baseline has fewer,
   to keep the study short. */
typedef enum PaperData {
    DATA_SWEPT,
    DATA_RANDOM,
    DATA_MIXED,
    DATA_FINE,
    DATA_FINEST,
    DATA_PAPER,
    PAPER_DATA
} PaperData;

/* Words are those of learning/pair_training.h. Zero-initialised members are the baseline's: swept, labels by the
   engine, relative, pair, sigmoid, mse. */
typedef struct PaperNetwork {
    const char *name, *factor, *value; /* value: of the factor in which it differs from the baseline */
    PaperData data;
    DatasetLabels labels;
    PairView view;
    PairTarget target;
    const char *layers; /* "10-10-2" */
    const char *hidden, *output, *scale, *optimizer, *loss;
    int iterations; /* 0: 2000, as the paper's Table 1 */
    bool quick;     /* also part of the quick study */
} PaperNetwork;

enum { PAPER_NETWORK_NAME_SIZE = 64 };

extern const PaperNetwork paper_networks[];
extern const int paper_network_count;

/* With all defaults set. */
PaperNetwork paper_network(int i);

enum { PAPER_FACTORS_SIZE = 256 };

/* In how many factors two networks with all defaults differ; names: "data layers ". The first width follows from the
   inputs, the last is the outputs'; the scaling belongs to the output's activation. */
int paper_network_factors(const PaperNetwork *a, const PaperNetwork *b, char names[PAPER_FACTORS_SIZE]);

/* The datasets of the paper's study, each recorded at its first use. */

enum { PAPER_SCENES = 4, PAPER_TRAINING_SCENES = 2, PAPER_PATH_SIZE = 4096, PAPER_DATASETS_MAX = 32 };

/* single, stack, pyramid, pyramid_settled, NULL; the first two are trained on. */
extern const char *const paper_scene_names[PAPER_SCENES + 1];

/* Launches of each scene. */
typedef struct PaperDataSize {
    const char *swept, *mixed, *fine, *finest, *paper, *transfer; /* m: "-5:5:0.05" */
    int random, mixed_random;                                     /* launches drawn at random, in addition */
    /* Only every so many rows of single impulses are kept: there are ten times as many as of others. */
    int impulse_every, finest_every;
} PaperDataSize;

typedef struct StoredDataset {
    int first, count; /* scenes */
    DatasetOptions options;
    Dataset *dataset;
} StoredDataset;

/* Zero-initialise. */
typedef struct PaperDatasets {
    char scenes[PAPER_SCENES][PAPER_PATH_SIZE];
    const PaperDataSize *size;
    uint64_t seed;
    int count;
    StoredDataset items[PAPER_DATASETS_MAX];
} PaperDatasets;

/* scenes: the folder of the four scene files. */
bool paper_datasets_begin(PaperDatasets *datasets, const char *scenes, const PaperDataSize *size, uint64_t seed,
                          Error *error);
void paper_datasets_free(PaperDatasets *datasets);

/* The dataset of a network, owned by `datasets`. NULL with error set. */
const Dataset *paper_dataset(PaperDatasets *datasets, const PaperNetwork *network, Error *error);

/* system_scores.csv: every system with its ablations, and rivals, on held-out launches of the four scenes
   (launches_for_scoring). Each method runs on its own trajectory, from the start to the scene's last frame. */

enum { SYSTEM_SCORES_MAX = 400, SYSTEM_NAME_SIZE = 64 };

/* The word for rivals in the column `system`. */
#define SYSTEM_RIVAL "rival"

/* Sums and maxima are over all launches. NAN where a number is not applicable. */
typedef struct SystemScoreRow {
    const char *system, *method; /* PaperSystem.name, or SYSTEM_RIVAL; the method as on the command line */
    int scene;                   /* of paper_scene_names */
    double launches, frames;     /* how many; frames of each run */
    double frames_engine;        /* first frame in which a body is 0.1 m from its place in the engine's run; median over
                                    launches; `frames`: never */
    double frames_converged; /* the same of the run of the converged solver, over the launches of which it is known */
    double moved;            /* boxes that moved more than 0.5 m in the 5 s after the launch, mean (ChartRow) */
    double penetration_max;  /* m: the deepest contact */
    double energy_created;   /* J: the largest mechanical energy above that when the bomb was added; 0: never above */
    double momentum_error;   /* N s: momentum created per step (ContactSolution), mean */
    double fallback_share;   /* 0 to 1: steps with discarded outputs, beyond training, or solved by sweeps */
    double us_step;          /* microseconds per step of a held-out launch, everything counted: the whole step; of
                                    methods without contacts their own work (no_contacts in its description) */
    double us_step_engine;   /* of the engine, measured in turns with it */
    /* launches in which the converged run has an unconverged step before the method parts from it */
    double unconverged;
} SystemScoreRow;

extern const CsvLayout system_score_layout;

/* Strips: six moments of a held-out launch, the engine above, a system below; and a page of all runs. */

enum { STRIP_SCENES = 2, STRIP_SYSTEMS_MAX = RENDER_PANELS_MAX - 1 };

extern const char *const strip_scene_names[STRIP_SCENES + 1]; /* stack, pyramid, NULL */

struct PaperSystem;

/* Runs the scenes of the folder `scenes` and draws folder/strip-NAME-SCENE.png, .svg and .txt, a caption of one line,
   for each system; and folder/strip-SCENE.html, a page that plays the engine's run beside those of all systems
   (pictures/player.h). systems: at most STRIP_SYSTEMS_MAX, ended by NULL. quick: shorter runs. The folder must exist.
   False with error set if a scene cannot be read or a run fails; ERROR_INTERRUPTED if progress, which may be NULL,
   requests a stop. */
bool system_strips_draw(const struct PaperSystem *const *systems, const char *scenes, bool quick, const char *folder,
                        const Progress *progress, Error *error);

/* systems.csv: what the papers of the systems claim, and whether it holds here. Every verdict follows from measured
   numbers by a rule in code. */

typedef enum ClaimHolds { CLAIM_NO, CLAIM_PARTLY, CLAIM_YES } ClaimHolds;
enum { CLAIM_HOLDS = CLAIM_YES + 1, CLAIM_TEXT_SIZE = 400 };

typedef struct ClaimRow {
    const char *system, *claim, *source, *measured, *figure; /* at most CLAIM_TEXT_SIZE bytes each, one line */
    int holds;                                               /* ClaimHolds */
} ClaimRow;

extern const CsvLayout claim_layout;

/* What a system's claims are judged from besides its table, and where they go. */
typedef struct Claims {
    const char *system;           /* its name */
    const SystemScoreRow *scores; /* [score_count] of all systems and rivals */
    int score_count;
    FILE *lines; /* claim_state() writes to it */
} Claims;

/* Judges a claim from the system's table and states it. False with error set. */
typedef bool ClaimRule(const Claims *claims, const CsvTable *table, Error *error);

typedef struct Claim {
    /* of their paper, one short sentence: "With little data it learns faster than the network alone" */
    const char *claim;
    const char *source;   /* "Ajay et al. 2019, section V" */
    const char *measured; /* here: what was measured, in which scenes, and by which rule it holds */
    ClaimHolds holds;
} Claim;

/* Adds a row. The format gives the figure: numbers with their units, "3.1 times (stack), 1.4 times (pyramid)"; NaN
   becomes a dash. */
bool claim_state(const Claims *claims, const Claim *claim, Error *error, const char *format, ...) PRINTF_LIKE(4, 5);

/* A rule of two limits: yes from `yes` on, partly from `partly` on. NaN, which was not measured, does not hold. */
ClaimHolds claim_at_least(double value, double yes, double partly);
ClaimHolds claim_at_most(double value, double yes, double partly);

/* A rule of several cases: yes if all of them hold, no if none does. */
ClaimHolds claim_in_cases(int holding, int cases);

/* Writes folder/systems.csv from the systems' tables and folder/system_scores.csv. systems: ended by NULL. ERROR_INPUT
   where a table is missing or damaged, with path:line:column, or a text is too long. */
bool system_claims_write(const struct PaperSystem *const *systems, const char *folder, Error *error);

/* Those of one system, from folder/system_NAME.csv. */
bool system_claims_state(const struct PaperSystem *system, const char *folder, Claims *claims, Error *error);

/* The systems that the paper cites, as parts of its study. Each system is one constant PaperSystem: the methods that
   are scored, the study that measures its claims, the rules that judge them, and its figure. To add a system NAME:

   1. Write NAME.c, its row and layout in paper_internal.h, its rules in claims.c, its plot in plots_systems.c:

        const CsvLayout NAME_layout = CSV_LAYOUT("system_NAME", columns, NameRow, .min_rows = 1, .max_rows = 5000);
        static const SystemPart parts[] = {
            {"launches-stack", .weight = 20, .quick_weight = 0.3, .index = 1, .write = write_launches}, ..., {0}};

        const PaperSystem system_NAME = {.name = "NAME",
                                         .methods = SYSTEM_METHODS("NAME", "NAME:net=off"),
                                         .table = &NAME_layout,
                                         .parts = parts,
                                         .claims = NAME_claims,
                                         .plot = plot_NAME};

      A part writes rows of the table with piece_tables_print(lines, &NAME_layout, -1, &row, error)
      (studies/piece_tables.h). It is kept when it is done, and done once: a study that was cut off continues with the
      next part. So a part should take some seconds. The whole study of one system takes at most 90 s on two idle cores,
      the quick one 2 s; the quick one measures everything that claims need, with less. A part may use all threads
      (base/machine.h); times are measured on one (studies/piece_tables.h), by parts that say so (timed).
   2. Add a line to SYSTEMS below; the room of its training to those that paper may include from (src/layers.txt), if
      the study trains; and to tests: tests/paper/figures/system_NAME.csv with all that the figure can show, its names
      to `tables` and `figures` in tests/paper/test_plots.c, tests/paper/test_NAME_study.c, the table's layout to the
      end of `layouts` in tests/fuzz/fuzz_csv.c.

   The rest follows from the list: scores, the table of claims, strips, the figure system-NAME and the report. */

/* What the parts of a study share. */
typedef struct SystemStudy {
    const char *scenes; /* folder of single.yaml, stack.yaml, pyramid.yaml, pyramid_settled.yaml */
    bool quick;
    uint64_t seed;
} SystemStudy;

typedef struct SystemPart {
    const char *name;            /* of the system's parts; NULL ends the list */
    double weight, quick_weight; /* about the seconds on two cores */
    int index;                   /* handed to write */
    /* Writes rows of the system's table. False with error set; ERROR_INTERRUPTED if progress_report() stops it. */
    bool (*write)(const SystemStudy *study, int index, FILE *lines, const Progress *progress, Error *error);
    bool timed; /* its rows have times */
} SystemPart;

/* Draws a table of the study; width 0: it has no rows to show. */
typedef bool PlotWrite(const CsvTable *table, PlotPage *page, Error *error);

typedef struct PaperSystem {
    const char *name; /* "sain": in tables, and of files */
    const char *const
        *methods;           /* to score, as on the command line, ended by NULL: first the system as it ships, which the
                                   strips show, then its ablations. In a scene without their network they have no row */
    const CsvLayout *table; /* of system_NAME.csv */
    const SystemPart *parts;
    ClaimRule *const *claims; /* ended by NULL */
    PlotWrite *plot;
} PaperSystem;

#define SYSTEM_METHODS(...) ((const char *const[]){__VA_ARGS__, NULL})

/* SYSTEM(x) is system_x of this folder. In the order of tables and of the report. */
#define SYSTEMS(SYSTEM) SYSTEM(sain) SYSTEM(hybrid) SYSTEM(gns) SYSTEM(subspace)

#define SYSTEM_DECLARED(name) extern const PaperSystem system_##name;
SYSTEMS(SYSTEM_DECLARED)
#undef SYSTEM_DECLARED

/* The list; ends with NULL. */
extern const PaperSystem *const paper_systems[];

/* The whole study of Avatavului, Ifrim, Voncila (2023), from seed to tables: networks trained in every reading of the
   paper, one factor at a time; their rates of right predictions; their runs in place of the solver; laws of physics in
   the loss; transfer learning; the systems that the paper cites. */

typedef struct PaperOptions {
    const char *scenes; /* folder of single.yaml, stack.yaml, pyramid.yaml, pyramid_settled.yaml */
    const char *folder; /* created if missing */
    bool quick;         /* fewer networks, launches, iterations */
    uint64_t seed;
    const PiecesRun *run; /* whole, a shard, or a merge */
    /* Draws what the tables show, and writes the report. */
    bool (*draw)(const struct PaperOptions *study, Error *error);
} PaperOptions;

/* Writes folder/table1.csv, networks.csv, rates.csv, closed_loop.csv, laws.csv, transfer.csv, system_scores.csv,
   system_NAME.csv of each system, systems.csv, study.csv and folder/networks/NAME.npz, then draws; a shard does its
   parts only, and of the files writes the networks that it trains. Finished parts are kept: the same study, by the same
   program, continues where it was interrupted. ERROR_INPUT for a scene that cannot be read, and for a merge of times of
   different processors; ERROR_INTERRUPTED if progress_report() stops it. *pieces tells what was done; it has no
   plan. */
bool paper_run(const PaperOptions *options, Pieces *pieces, const Progress *progress, Error *error);
