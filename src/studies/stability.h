/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where each method fails: studies along one parameter of a scene, and maps over two.

     const StabilityOptions options = {.folder = "out/stability", .scenes = "scenes", .quick = true};
     stability_run(&options, &pieces, progress, error);
     stability_figures_write(options.folder, NULL, progress, error); */
#pragma once
#include "base/base.h"
#include "base/csv.h"
#include "base/machine.h"
#include "methods/methods.h"
#include "runs/pieces.h"
#include "runs/verdict.h"
#include "scenes/scenes.h"

#include <stdbool.h>
#include <stdint.h>

/* The range of a parameter that is scanned. */

enum { BORDER_SEEDS = 3, BORDERS_MAX = 32, BORDER_POINTS_MAX = 128 };

/* Resolution: linear 1/100 of the range, logarithmic a factor of 1.05; at least 1 for whole numbers. */
typedef struct BorderScan {
    double from, to; /* from < to; logarithmic: from > 0 */
    int points;      /* 2 .. BORDER_POINTS_MAX, including both ends */
    bool logarithmic, whole;
    bool fails_low; /* expected to fail at low values; reverses the order of the list */
    bool either;    /* fails_low is set if the lowest value of the coarse scan fails and the highest holds */
} BorderScan;

/* The table of stability studies: which scene, which parameter, which range. */

/* A scan of one parameter of a scene of scenes/stability. */
typedef struct StabilityStudy {
    const char *name;  /* of the study, in tables */
    const char *title; /* in figures, whose axis names the parameter */
    const char *scene; /* file name without folder and extension */
    const char *parameter;
    BorderScan scan;
    SceneSetting fixed;    /* another parameter that is set; name "": none */
    bool stands;           /* judged by its own verdict, also if it is struck */
    bool iterations;       /* scans the scene's iterations: only for methods that use them */
    bool unshifted;        /* without seeds: a tiny shift has no effect, as it is rounded away or nothing comes near */
    bool rests;            /* also records drift and energy of every run */
    bool quick;            /* part of a quick run */
    double weight;         /* s for all methods on two cores, approximately */
    const char *file;      /* path of another scene instead; `stands`: it is not struck */
    double (*rigid)(void); /* the value up to which rigid boxes hold, in closed form; NULL: unknown */
} StabilityStudy;

typedef struct StabilityAxis {
    const char *parameter;
    BorderScan scan; /* only its coarse scan is used */
    int quick_points;
} StabilityAxis;

/* A grid over two parameters. */
typedef struct StabilityMap {
    const char *name, *scene;
    StabilityAxis x, y;
    bool stands, iterations, quick; /* as above */
    double weight;
    const char *file; /* as above */
} StabilityMap;

extern const StabilityStudy stability_studies[];
extern const StabilityMap stability_maps[];
extern const int stability_study_count, stability_map_count;

/* The study of this name, or NULL. */
const StabilityStudy *stability_study_find(const char *name);

/* The study of one scene file: borders along its parameters and, with two of them, their map. */

enum { STABILITY_MAX_VARY = 2, STABILITY_OWN_NAME_SIZE = 40 };

typedef struct StabilityOwn {
    char names[STABILITY_MAX_VARY + 1][STABILITY_OWN_NAME_SIZE];                  /* of the studies, then of the map */
    char titles[STABILITY_MAX_VARY][SCENE_NAME_SIZE + SCENE_PARAMETER_SIZE + 16]; /* "Scene NAME, by PARAMETER" */
    char parameters[STABILITY_MAX_VARY][SCENE_PARAMETER_SIZE];                    /* varied */
    bool stepped[STABILITY_MAX_VARY];           /* the range has a step: these values and no fewer */
    int study_count, map_count;                 /* of the arrays below */
    StabilityStudy studies[STABILITY_MAX_VARY]; /* SCENE_PARAMETER */
    StabilityMap maps[1];                       /* SCENE_PARAMETER_PARAMETER */
} StabilityOwn;

/* Makes the studies of the scene at `path` for texts "NAME", "NAME=FROM:TO" or "NAME=FROM:TO:STEP"; without FROM and TO
   a parameter's bounds. A range without STEP whose ends differ by more than a factor of 20 is logarithmic. The result
   points into itself and to `path`. ERROR_INPUT: no or unknown parameters, more than STABILITY_MAX_VARY, a parameter
   twice, a range that is not within the parameter's bounds, a unit that tables cannot hold, a value of the scan for
   which the scene is refused. */
bool stability_own_make(StabilityOwn *own, const char *path, const char *const *texts, int count, bool quick,
                        Error *error);

/* The stability study: where each method fails. Tables: borders between holding and failing along one parameter
   (stability.csv), maps over two parameters (maps.csv), methods that do not apply to a scene (refusals.csv), network
   outputs that were rejected and steps that fell back (fallbacks.csv), drift of undisturbed bodies (rest.csv), runs
   beside which the reference did not converge (unconverged.csv). */

enum { STABILITY_MAX_NAMES = 64 };

typedef struct StabilityOptions {
    const char *folder;  /* of the tables; created if missing */
    const char *scenes;  /* the folder that contains stability/ */
    const char *methods; /* contenders_parse; NULL: those of the study */
    bool quick;          /* few studies, small maps */
    int name_count;      /* of studies and maps to run; 0: all */
    const char *names[STABILITY_MAX_NAMES];
    const StabilityOwn *own; /* the studies of a scene file instead of the table's; NULL: the table's */
    Shard shard;
    /* Draws the tables in the folder; NULL: nothing is drawn. */
    bool (*draw)(const struct StabilityOptions *options, Error *error);
} StabilityOptions;

/* Runs the studies and maps, writes the tables and draws; a shard does its pieces only. An interrupted run is resumed
   at the unfinished pieces. The tables do not depend on the number of threads. ERROR_INPUT also for an unknown name,
   ERROR_INTERRUPTED if progress stops the run. *pieces tells what was done; it has no plan any more. */
bool stability_run(const StabilityOptions *options, Pieces *pieces, const Progress *progress, Error *error);

/* The figures of a stability study, drawn from its tables. */

/* Reads folder/stability.csv and folder/maps.csv, of the studies of a scene file or, with own NULL, of the table, and
   draws, as .png, .svg and a caption .txt of one line, which also explains the words of the figure,
     map-NAME   one per map: a panel per method with a border, a tile per cell; the caption names methods
                that hold or fail everywhere
     borders    how far each method holds in each study (studies/stability_internal.h)
   into the folder. Readable for the colour-blind, in grey and in black and white. The same tables give the same files.

   A table without rows gives no figure. An invalid table is an error "path:line:column: error: text" before anything is
   drawn. ERROR_INTERRUPTED if progress, which may be NULL, requests a stop;
   figures already drawn stay. */
bool stability_figures_write(const char *folder, const StabilityOwn *own, const Progress *progress, Error *error);

/* Continues Verdict: cells without a verdict. */
enum { CELL_NOT_APPLICABLE = VERDICTS, CELL_MISSING, VERDICT_LOOKS };

/* The tables of a stability study: their rows and layouts (base/csv.h), used by the study, the figures and the
   command line. Names are plain (csv_plain_length); a setting is stored as given and may contain the path of a
   network. */

enum {
    STABILITY_MAX_CELLS = 200000,
    STABILITY_MAX_BORDERS = 2000,
    STABILITY_MAX_RUNS = 100000,
    STABILITY_MAX_PANELS = 512,
    STABILITY_SETTING_SIZE = 128
};

/* maps.csv: a cell of a map. unconverged.csv: an unshifted run beside converged runs with steps that did not converge:
   a cell of a map, or a run of a study along one parameter: `map` is the study, y its fixed parameter or, without one,
   NAN and "". */
typedef struct MapCell {
    const char *map, *method, *setting, *x_parameter, *x_unit, *y_parameter, *y_unit;
    double x, y;
    int verdict;               /* a Verdict, or CELL_NOT_APPLICABLE */
    double frame, body, value; /* maps.csv: as in VerdictReading, or NAN */
    const char *unit;          /* maps.csv */
    int steps, not_converged;  /* unconverged.csv: as in ConvergedRun */
    double residual;           /* unconverged.csv: m/s, NAN: not finite */
} MapCell;

/* stability.csv: a border of a method: the last value that holds and the first that fails. */
typedef struct BorderRow {
    const char *study, *method, *setting, *parameter, *unit;
    double holds_at; /* NAN: nothing holds */
    double fails_at; /* NAN: no decided value fails; with a failing verdict, values beyond holds_at are undecided */
    int verdict;     /* how it fails; if it holds over the whole range, how it holds; or CELL_NOT_APPLICABLE */
} BorderRow;

/* refusals.csv: why a method does not apply. */
typedef struct RefusalRow {
    const char *study, *method, *setting, *reason;
} RefusalRow;

/* rest.csv and fallbacks.csv: a run without a shift, at a value of the parameter. */
typedef struct RunRow {
    const char *study, *method, *setting, *parameter, *unit;
    double value;
    int steps;
    int verdict;                                              /* rest.csv */
    double drift, energy;                                     /* rest.csv: VerdictReading's drift and gained, or NAN */
    int not_finite, outside_cone, beyond_training, by_sweeps; /* fallbacks.csv: as in Fallbacks */
} RunRow;

/* engines.csv: a program of the method exec, in a study; the table is there if there is such a method. */
typedef struct EngineRow {
    const char *study, *method, *setting;
    const char *engine, *version; /* as the program states; "": it did not get so far */
    int runs, failed;             /* without a shift; of them, those whose adapter failed */
    const char *reason;           /* of the failure at the lowest value */
    /* value of the parameter at which two equal runs had different ends; NAN: none of the repeated runs */
    double differs;
} EngineRow;

/* Refused: a map whose name is not a file name, maps (or methods of a map) whose rows are not together, and more than
   STABILITY_MAX_PANELS methods of maps; rows that give a study another parameter, and verdicts that contradict their
   values: a method that fails somewhere cannot hold, and one that does not apply has no values. */
extern const CsvLayout map_layout, border_layout, refusal_layout, rest_layout, fallback_layout, engine_layout,
    unconverged_layout;

static inline const MapCell *map_cell(const CsvTable *table, int i) { return (const MapCell *)table->rows + i; }
static inline const BorderRow *border_row(const CsvTable *table, int i) { return (const BorderRow *)table->rows + i; }

bool border_same_method(const BorderRow *a, const BorderRow *b);

/* What studies of struck scenes show, for captions and pages. */
extern const char stability_struck_words[];

/* The study of row i is one of a struck scene, of `own` or, if it is NULL, of the table of studies. */
bool border_is_struck(const CsvTable *table, int i, const StabilityOwn *own);

/* Writes at which values of a study or map the reference did not converge, by unconverged.csv, into text: "at rows 22,
   26 (12 of 900 steps, residual up to 3e-07 m/s)". Names the first twelve values. False, and "", if there are none. */
enum { UNCONVERGED_TEXT_SIZE = 512 };
bool stability_unconverged(const CsvTable *table, const char *study, char text[UNCONVERGED_TEXT_SIZE]);

/* What follows from such steps, for captions and pages. */
extern const char stability_unconverged_words[];

bool border_same_study(const BorderRow *a, const BorderRow *b);

bool map_cell_same_method(const MapCell *a, const MapCell *b);

/* "engine:k=10,warm=off", of a program its `name` (methods/methods.h); for figures the same, plain; and
   "Height (boxes)" for an axis. */
enum { STABILITY_TEXT_SIZE = CSV_NAME_SIZE + 2 * STABILITY_SETTING_SIZE + 8 };
void stability_method_name(char text[STABILITY_TEXT_SIZE], const char *method, const char *setting);
void stability_method_text(char text[STABILITY_TEXT_SIZE], const char *method, const char *setting);
void stability_axis_text(char text[STABILITY_TEXT_SIZE], const char *parameter, const char *unit);

/* The figure of a stability map: one panel per method, one tile per cell. */

enum { MAP_MAX_VALUES = 128, MAP_MAX_METHODS = 24 };

/* A map's cells, arranged by method, x and y. */
typedef struct MapPanels {
    const MapCell *first; /* row of the map; the table outlives the map */
    int x_count, y_count, panel_count;
    double x[MAP_MAX_VALUES], y[MAP_MAX_VALUES]; /* values of all methods, ascending */
    const MapCell *methods[MAP_MAX_METHODS];     /* first row of each */
    unsigned char looks[MAP_MAX_METHODS][MAP_MAX_VALUES]
                       [MAP_MAX_VALUES];                       /* [panel][x][y]; CELL_MISSING without a row */
    int fell[MAP_MAX_METHODS][MAP_MAX_VALUES][MAP_MAX_VALUES]; /* boxes, of what falls */
} MapPanels;

/* Gathers the map whose rows start at *row and advances *row past them. ERROR_INPUT, with path:line:column: a repeated
   cell, more than MAP_MAX_VALUES values or MAP_MAX_METHODS methods. */
bool map_panels_gather(MapPanels *map, const CsvTable *table, int *row, Error *error);

/* Finds all borders along a parameter: the values where a method changes from holding to failing.

   A coarse scan finds changes between neighbouring values, bisection narrows each to the resolution. Both sides of a
   border and their outward neighbours are repeated with other seeds, which shift the start by a tiny amount. A value
   for which the seeds disagree is undecided; it cannot be a side of a border, so the search moves outward to the next
   value on which all seeds agree. A border wider than the resolution thus encloses undecided values. A change and its
   reversal within one step of the scan are found only next to a border. */

typedef struct BorderProbe {
    /* The verdict at a value; seed 0 .. BORDER_SEEDS - 1. */
    bool (*evaluate)(void *context, double value, int seed, Verdict *verdict, Error *error);
    void *context;
    int seeds; /* to evaluate: 1 .. BORDER_SEEDS */
} BorderProbe;

typedef struct Border {
    double holds_at, fails_at; /* neighbouring values, or NaN */
    Verdict verdict;           /* at fails_at, the worst of the seeds */
} Border;

/* Never empty. Without a border it has one entry: if all values hold, holds_at is the last value and the verdict the
   worst found; if all fail, fails_at is the first value. If the values up to the end are undecided, the last entry has
   the last value that holds, fails_at = NaN and the worst verdict beyond it. If all values are undecided, both are
   NaN. */
typedef struct BorderList {
    int count;
    Border items[BORDERS_MAX]; /* ordered from the end expected to hold to the end expected to fail */
} BorderList;

/* The distinct values of the coarse scan, ascending, rounded to 4 digits so that tables show exactly the value that was
   run. Returns their number. */
int border_scan_values(const BorderScan *scan, double values[BORDER_POINTS_MAX]);

/* False with error set if an evaluation fails, memory is short or there are more than BORDERS_MAX borders. */
bool border_search(BorderList *list, const BorderScan *scan, const BorderProbe *probe, Error *error);

/* One run of a stability study: a scene with parameter values, and a method; and the converged runs that verdicts need,
   each computed once for all methods. */

enum { STABILITY_PATH_SIZE = 4096 };

/* A parametric scene of the study. */
typedef struct StabilityPlace {
    const char *scenes; /* the folder that contains stability/ */
    const char *scene;  /* file name without folder and extension */
    const char *file;   /* or this file, if not NULL */
} StabilityPlace;

/* "scenes/stability/SCENE.yaml", or the file. ERROR_INPUT if it is too long. */
bool stability_path(char path[STABILITY_PATH_SIZE], const StabilityPlace *place, Error *error);

/* Reads the scene with these parameter values. The caller frees it. */
Scene *stability_scene(const StabilityPlace *place, const SceneSetting *settings, int count, Error *error);

/* The study's scene, in this folder, with a value of its parameter. The caller frees it. */
Scene *stability_study_scene(const StabilityStudy *study, const char *scenes, double value, Error *error);

/* Whether the study shows what the converged run does, beside what methods do: the scene is struck (runs/verdict.h),
   and its table does not say that it stands. */
bool stability_is_struck(const StabilityPlace *place, const Scene *scene, bool stands);

/* Runs the scene with the method until the verdict is final; allowed: as in VerdictRun. A method that fails is a
   verdict, not an error. False with error set if the method cannot be created, the launch is refused, too many
   bodies are near each other, or memory is short. */
bool verdict_run(VerdictReading *reading, const Scene *scene, const Method *method, double allowed, Error *error);

/* The converged run at a value of the scanned parameter. */
typedef struct ConvergedRun {
    double value;
    Verdict truth; /* of a struck scene */
    double gained; /* J: of a scene that is not struck, what position correction gives; 0: a step did not converge */
    int steps;     /* of this run and, if it is struck, of those that are shifted by a micrometre */
    Fallbacks fallbacks;
} ConvergedRun;

/* Finds the truth of a struck scene, which is the same afterwards: stands, falls or collapses (runs/verdict.h). It
   is undecided near the edge, where runs that are shifted by a micrometre differ in that, and where the converged
   run is not sound or has a step that did not converge. They always use a warm start, whatever the scene sets: it
   does not change the converged solution, but without it a stack of 40 boxes takes minutes. */
bool stability_truth(Scene *scene, ConvergedRun *run, Error *error);

/* The verdict of a study on a run: what the run does. The reference's is undecided where the truth is, or where a step
   of its run did not converge; what is not sound stays so. */
Verdict stability_compare(const VerdictReading *reading, Verdict truth, const Method *method);

/* Shifts the first dynamic body, or if there is none the bomb, along x: by 0 for seed 0, by +-1e-6 m for seeds 1 and
   2. */
void stability_shift(Scene *scene, int seed);

/* False, with the reason in error, if the method does not apply to the scene: it cannot be created, or its first step
   fails. */
bool stability_applies(const Method *method, const Scene *scene, Error *error);

/* True for a method that makes as many sweeps as the scene sets. */
bool stability_takes_iterations(const Method *method);

/* Counts runs and reports progress. Zero-initialise. */
typedef struct RunCounter {
    const Progress *progress; /* may be NULL */
    double done, expected;
    bool stopped;
} RunCounter;

/* Counts one run. Thread-safe. False with error set if progress stops the study. */
bool run_counter_add(RunCounter *counter, const char *what, Error *error);

/* A cache of converged runs. Shifted scenes use the run of the unshifted scene. Zero-initialise. Thread-safe; two
   threads may compute the same run, with the same result. */
typedef struct ConvergedRuns {
    int count;
    size_t capacity;
    ConvergedRun **runs; /* [count] */
} ConvergedRuns;

void converged_runs_free(ConvergedRuns *runs);

/* A run of a study: value: of the scanned parameter, to know the converged run by; seed: as of stability_shift(). */
typedef struct JudgedRun {
    const Method *method;
    int seed;
    double value;
    bool struck; /* as of stability_is_struck() */
} JudgedRun;

/* The verdict of a study on a run of the scene, which is the same afterwards. *beside: the converged run; NULL:
   none is needed, as the scene is not struck and the run does not explode. Else it may gain what the converged run
   does. */
bool stability_judge(Scene *scene, const JudgedRun *run, ConvergedRuns *runs, VerdictReading *reading,
                     const ConvergedRun **beside, Error *error);
