/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of the larger commands: compare, train. */
#pragma once
#include "base/base.h"
#include "base/file.h"
#include "base/json.h"
#include "cli/cli.h"
#include "cli/json_output.h"
#include "cli/options.h"
#include "methods/methods.h"
#include "regression/limits.h"
#include "regression/mask.h"
#include "regression/regression.h"
#include "regression/report.h"
#include "runs/compare_runs.h"
#include "runs/divergence.h"
#include "runs/trajectory.h"
#include "runs/verdict.h"
#include "scenes/scenes.h"

/* twinbox compare: its options and results. */

typedef struct CompareOptions {
    const char *paths[65], *report; /* two, or one and those that are compared with it */
    int count, megabytes;
    int max_pixels;
    const char *limit; /* --tolerance, as given: of pictures in `tolerance`, of runs in `poses` */
    Tolerance tolerance;
    PoseTolerance poses;
    bool chaos;              /* --tolerance chaos */
    const char *scene, *csv; /* of runs */
    const char *rules;       /* a file; NULL: not given */
    bool flat, strict, json;
    Mask mask;
} CompareOptions;

/* Two runs and how they differ. */
typedef struct RunComparison {
    const CompareOptions *options;
    Trajectory *runs[2];
    TrajectoryDifference difference;
    bool same_world; /* or what follows is not known: */
    bool passed;
    bool found_contacts; /* one of the runs had none: those of both are found again */
    TrajectoryParting parting;
    double *distance; /* [frames of both] */
    Growth growth, shifted;
    Chaos chaos;     /* distance NULL: no scene given */
    char *text;      /* what is printed */
    double seconds;  /* that it took */
    ReportLink link; /* of the report, to a page that plays both; empty: none */
} RunComparison;

/* What differs without being compared, as words. */
enum { RUN_OTHERS_MAX = 4 };
typedef struct RunOther {
    const char *what; /* "bomb" */
    char values[2][TRAJECTORY_VERDICT_SIZE];
} RunOther;
int compare_runs_others(const RunComparison *comparison, RunOther others[RUN_OTHERS_MAX]);

JsonOutputWrite compare_runs_write_json; /* of a RunComparison */

/* Compares the two runs of the options, once; to be freed, also on failure. */
bool compare_runs_make(RunComparison *comparison, Error *error);
void compare_runs_free(RunComparison *comparison);

/* The one case of a report; the kind of the first difference, and ", first in the solver" or "". */
ReportCase compare_runs_case(const void *comparison, int i);
const char *compare_runs_cause(const RunComparison *comparison, char *kind, size_t size);

/* Writes run.html into the folder, which plays both runs if they differ, and sets `link`. */
bool compare_runs_page(RunComparison *comparison, const char *folder, Error *error);

/* Compares the first input with all others, runs or folders of them, and prints the result. */
bool compare_many(const CompareOptions *options, Error *error);

/* Writes report.html, junit.xml, results.json and, if the runs differ, run.html, which plays both. */
bool compare_runs_report(RunComparison *comparison, const char *folder, Error *error);

/* Whether the file is read as a trace (runs/run_files.h). */
static inline bool is_trace(const char *path) { return file_name_ends_with(path, ".csv"); }

/* Compares two runs and prints the result. False if they differ, or with error set. */
bool compare_runs(const CompareOptions *options, Error *error);

/* Prints the result of a comparison of pictures. */
bool compare_print(const Regression *regression, Error *error); /* false with error set if out of memory */

/* The same as JSON: what results.json of a report has. */
bool compare_json_pictures(const Regression *regression, Error *error);

/* The kinds of network that `twinbox train` trains. To add a kind, define train_NAME (train_launches.c has those that
   learn from launches of scenes), and add one line KIND(NAME) here. */

/* The first is the default of --kind. */
#define TRAIN_KINDS(KIND) \
    KIND(pair_net)        \
    KIND(scene_net)       \
    KIND(sain)            \
    KIND(hybrid)          \
    KIND(gns)             \
    KIND(subspace)

/* What to train, as on the command line. */
typedef struct TrainRequest {
    const struct TrainKind *kind;
    const char *input, *output;
    const char *values[OPTIONS_MAX]; /* texts of the kind's options; NULL: neither given nor a standard; "": a flag */
    const struct Scene *scene;       /* of kinds that read one */
} TrainRequest;

typedef struct TrainKind {
    const char *name, *input, *summary; /* input: what the help calls the file to train on; NULL: none */
    const char *file_kind;              /* of the file that is written (npz_check_kind) */
    const Option *options;              /* in the order of a command; those not given have the value `standard` */
    bool (*train)(const TrainRequest *request, Error *error);
    bool reads_scene; /* input is a scene, which the request then has */
} TrainKind;

#define TRAIN_KIND_DECLARED(name) extern const TrainKind train_##name;
TRAIN_KINDS(TRAIN_KIND_DECLARED)
#undef TRAIN_KIND_DECLARED

/* All kinds, ended by NULL. */
extern const TrainKind *const train_kinds[];

/* Reads the values into the Options of the kind. */
bool train_read(const TrainRequest *request, void *options, Error *error);

/* Of a text for train_describe(). */
enum { TRAIN_COMMAND_SIZE = 2048 };

/* The command line that trains the same network again, to be stored in it. */
void train_describe(const TrainRequest *request, char *command, size_t size);
