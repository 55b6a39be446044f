/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The study of hybrid: errors and times of a memory on launches that it has not learned, while it learns others. */
#include "base/base.h"
#include "base/csv.h"
#include "base/file.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "learning/hybrid_training.h"
#include "learning/scene_training.h"
#include "methods/hybrid.h"
#include "methods/hybrid_memory.h"
#include "methods/methods.h"
#include "methods/pair.h"
#include "paper/paper.h"
#include "paper/paper_internal.h"
#include "paper/report_internal.h"
#include "scenes/scenes.h"
#include "studies/meter.h"
#include "studies/piece_tables.h"
#include "studies/statistics.h"

#include <math.h>
#include <stdlib.h>

/* The launches have numbers from UNLEARNED on, which no learning reaches. */
enum { TIMED = 20, QUICK_TIMED = 4, REPETITIONS = 9, QUICK_REPETITIONS = 3, UNLEARNED = 2 * HYBRID_LAUNCHES_MAX };

/* What is measured at each row of a learning. */
typedef struct HybridTimes {
    const Scene *scene;
    World *prefix;                    /* the scene just before its bomb appears */
    int steps, launches, repetitions; /* steps: of each launch, from the first touch */
    uint64_t seed;
} HybridTimes;

/* The rivals: hybrid, and interior by itself. */
enum { RIVALS = 2 };

typedef struct Measuring {
    const HybridTimes *times;
    AskedSteps asked;
    ContactSolver rivals[RIVALS];
    PairMoment solutions[RIVALS];
    double *values; /* [asked, RIVALS, repetitions] us */
    double *errors; /* [asked] of answers */
    int answers;
} Measuring;

static bool run_launches(Measuring *measuring, const HybridMemory *memory, bool turned, Error *error) {
    const HybridTimes *times = measuring->times;
    for (int i = 0; i < times->launches; i++) {
        const Launch launch = hybrid_launch(times->scene, times->seed, UNLEARNED + i, turned);
        if (!launch_steps_run(times->scene, times->prefix, &launch, memory, times->steps, &measuring->asked, error))
            return false;
    }
    return true;
}

static bool hybrid_study_reserve(Measuring *measuring, Error *error) {
    const size_t count = (size_t)measuring->asked.count + 1;
    measuring->values = malloc(count * RIVALS * (size_t)measuring->times->repetitions * sizeof(double));
    measuring->errors = malloc(count * sizeof(double));
    return (measuring->values != NULL && measuring->errors != NULL) || error_memory(error, "hybrid");
}

/* All steps by both rivals, once. */
static bool hybrid_study_pass(Measuring *measuring, int repetition, int64_t overhead, Error *error) {
    const int repetitions = measuring->times->repetitions;
    measuring->answers = 0;
    for (int i = 0; i < measuring->asked.count; i++) {
        const AskedStep *step = &measuring->asked.items[i];
        for (int r = 0; r < RIVALS; r++) {
            const ContactSolver *solver = &measuring->rivals[r];
            if (!pair_moment_reserve(&measuring->solutions[r], &step->problem)) return error_memory(error, "hybrid");
            ContactSolution solution = pair_moment_solution(&measuring->solutions[r]);
            const int64_t begin = meter_time();
            if (!solver->kind->solve(solver->state, &step->problem, &solution, error)) return false;
            const int64_t passed = meter_without(meter_time() - begin, overhead);
            measuring->values[(i * RIVALS + r) * repetitions + repetition] = 1e-3 * (double)passed;
        }
        if (step->entry >= 0)
            measuring->errors[measuring->answers++] = (double)velocity_error(
                &step->problem, measuring->solutions[0].velocities, measuring->solutions[1].velocities);
    }
    return true;
}

/* NAN for 0, by which nothing is divided. */
static double or_nan(int count) { return count > 0 ? (double)count : (double)NAN; }

static void hybrid_study_summarise(Measuring *measuring, HybridRow *row) {
    const int repetitions = measuring->times->repetitions, count = measuring->asked.count;
    double sums[2][RIVALS] = {{0}}; /* of steps that are not answered, and that are */
    for (int i = 0; i < count; i++)
        for (int r = 0; r < RIVALS; r++)
            sums[measuring->asked.items[i].entry >= 0][r] +=
                statistics_quantile(measuring->values + (i * RIVALS + r) * repetitions, repetitions, 0.5);
    const double answers = or_nan(measuring->answers), others = or_nan(count - measuring->answers), all = or_nan(count);
    row->error = statistics_mean(measuring->errors, measuring->answers);
    row->error_95 = statistics_quantile(measuring->errors, measuring->answers, 0.95);
    row->us_answer = sums[1][0] / answers;
    row->us_solve = sums[1][1] / answers;
    row->us_question = fmax(sums[0][0] - sums[0][1], 0) / others;
    row->us_step = (sums[0][0] + sums[1][0]) / all;
    row->us_step_solve = (sums[0][1] + sums[1][1]) / all;
}

static bool hybrid_study_measure(Measuring *measuring, Error *error) {
    const int64_t overhead = meter_time_overhead();
    bool ok = true;
    meter_pin();
    for (int r = 0; ok && r < measuring->times->repetitions; r++) ok = hybrid_study_pass(measuring, r, overhead, error);
    meter_unpin();
    return ok;
}

/* Runs some launches with the memory, then solves each step with an impact in turns by hybrid and by
   interior:near=0.001, with medians over repetitions. Fills the row's error and error_95 of answers and us_answer to
   us_step_solve; NAN where no step is answered, or none is not. */
static bool hybrid_measure(const HybridTimes *times, const HybridMemory *memory, HybridRow *row, Error *error) {
    Measuring measuring = {.times = times};
    const bool ok = hybrid_make(&measuring.rivals[0], memory, NULL, error) &&
                    hybrid_make(&measuring.rivals[1], NULL, NULL, error) &&
                    run_launches(&measuring, memory, row->turned != 0, error) &&
                    hybrid_study_reserve(&measuring, error) && hybrid_study_measure(&measuring, error);
    if (ok) hybrid_study_summarise(&measuring, row);
    for (int r = 0; r < RIVALS; r++) {
        solver_destroy(&measuring.rivals[r]);
        pair_moment_free(&measuring.solutions[r]);
    }
    asked_steps_free(&measuring.asked);
    free(measuring.values);
    free(measuring.errors);
    return ok;
}

/* A family changes after CHANGE launches; in the quick study after QUICK_CHANGE. */
enum {
    LAUNCHES = 1000,
    CHANGE = 500,
    QUICK_LAUNCHES = 60,
    QUICK_CHANGE = 50,
    IMPACT_STEPS = 14,
    ALL_STEPS = 66,
    MEMORY_LIMIT = 64 << 20
};

static const int checkpoints[] = {HYBRID_FIRST, 100, 200, 300, 400, 500, 600, 700, 800, 900, 1000};
enum { CHECKPOINTS = sizeof checkpoints / sizeof *checkpoints };

#define NUMBER(member) CSV_MEMBER(HybridRow, member, CSV_OPTIONAL, .minimum = -1e9, .maximum = 1e9)

static const CsvColumn columns[] = {
    {"scene", CSV_WORD, .offset = offsetof(HybridRow, scene), .words = paper_scene_names},
    {"tolerance", CSV_NUMBER, .offset = offsetof(HybridRow, tolerance), .minimum = 1e-6, .maximum = 1000},
    {"changes", CSV_INTEGER, .offset = offsetof(HybridRow, changes), .maximum = 1},
    {"turned", CSV_INTEGER, .offset = offsetof(HybridRow, turned), .maximum = 1},
    {"launches", CSV_NUMBER, .offset = offsetof(HybridRow, launches), .minimum = 1, .maximum = HYBRID_LAUNCHES_MAX},
    {"share", CSV_OPTIONAL, .offset = offsetof(HybridRow, share), .maximum = 1},
    {"share_all", CSV_OPTIONAL, .offset = offsetof(HybridRow, share_all), .maximum = 1},
    NUMBER(error),
    NUMBER(error_95),
    NUMBER(us_answer),
    NUMBER(us_solve),
    NUMBER(us_question),
    NUMBER(us_step),
    NUMBER(us_step_solve),
    NUMBER(entries),
    NUMBER(kib),
    NUMBER(learning_ms),
    NUMBER(saved_ms),
    NUMBER(paid),
};
const CsvLayout hybrid_layout =
    CSV_LAYOUT("system_hybrid", columns, HybridRow, .min_rows = 1, .max_rows = HYBRID_ROWS_MAX);

typedef struct Learning {
    int scene;
    float tolerance;
    int steps;
    bool changes;
} Learning;

/* Steps that a scene's launches are followed for: a pyramid has few impacts after the first steps. The tolerances are
   compared on the stack. */
static const Learning learnings[] = {
    {0, 0.1f, ALL_STEPS, false},    {1, 0.1f, ALL_STEPS, false},  {2, 0.1f, IMPACT_STEPS, false},
    {3, 0.1f, IMPACT_STEPS, false}, {0, 0.1f, ALL_STEPS, true},   {1, 0.1f, ALL_STEPS, true},
    {3, 0.1f, IMPACT_STEPS, true},  {1, 0.02f, ALL_STEPS, false}, {1, 0.5f, ALL_STEPS, false}};

/* A learning in progress. */
typedef struct Run {
    const SystemStudy *study;
    const Learning *learning;
    const Scene *scene;
    FILE *lines;
    int launches, change;
    HybridTimes times;
    HybridLaunch since[LAUNCHES]; /* [count] since the last row */
    int count;
    double learned, saved; /* s */
    double paid;           /* NAN: not yet */
} Run;

static bool is_checkpoint(const Run *run, int launch) {
    if (launch == run->launches) return true;
    for (int i = 0; i < CHECKPOINTS; i++)
        if (checkpoints[i] == launch) return true;
    return run->study->quick && launch == run->change;
}

static double or_zero(double x) { return isnan(x) ? 0 : x; }

/* Adds up the launches since the last row, in seconds. */
static void account(Run *run, HybridRow *row) {
    int64_t steps = 0;
    int asked = 0, answered = 0;
    for (int i = 0; i < run->count; i++) {
        const HybridLaunch *launch = &run->since[i];
        steps += launch->steps;
        asked += launch->asked;
        answered += launch->answered;
        run->learned += launch->learning;
        run->saved += 1e-6 * launch->answered * or_zero(row->us_solve - row->us_answer) -
                      1e-6 * (launch->asked - launch->answered) * or_zero(row->us_question) - launch->learning;
        if (run->saved < 0)
            run->paid = NAN;
        else if (isnan(run->paid))
            run->paid = launch->number;
    }
    run->count = 0;
    row->share = asked > 0 ? (double)answered / asked : NAN;
    row->share_all = steps > 0 ? (double)answered / (double)steps : NAN;
}

static bool add_row(Run *run, const HybridLaunch *launch, Error *error) {
    HybridRow row = {.scene = run->learning->scene,
                     .tolerance = (double)run->learning->tolerance,
                     .changes = run->learning->changes,
                     .turned = run->learning->changes && launch->number > run->change,
                     .launches = launch->number};
    if (!hybrid_measure(&run->times, launch->memory, &row, error)) return false;
    account(run, &row);
    row.entries = launch->memory->entry_count;
    row.kib = (double)hybrid_memory_bytes(launch->memory) / 1024;
    row.learning_ms = 1e3 * run->learned;
    row.saved_ms = 1e3 * run->saved;
    row.paid = run->paid;
    return piece_tables_print(run->lines, &hybrid_layout, -1, &row, error);
}

static bool note(void *context, const HybridLaunch *launch, Error *error) {
    Run *run = context;
    run->since[run->count++] = *launch;
    return launch->memory == NULL || !is_checkpoint(run, launch->number) || add_row(run, launch, error);
}

static bool hybrid_study_learn(Run *run, const Progress *progress, Error *error) {
    const HybridTraining training = {.launches = run->launches,
                                     .turned_from = run->learning->changes ? run->change : -1,
                                     .steps = run->learning->steps,
                                     .components = HYBRID_STANDARD_COMPONENTS,
                                     .tolerance = run->learning->tolerance,
                                     .limit = MEMORY_LIMIT,
                                     .seed = run->study->seed,
                                     .command = "",
                                     .on_launch = note,
                                     .context = run};
    HybridMemory *memory = hybrid_training_run(run->scene, &training, progress, error);
    const bool whole = memory != NULL && memory->launches == run->launches;
    hybrid_memory_destroy(memory);
    return whole || (memory == NULL ? false : error_interrupted(error, "hybrid", "stopped"));
}

static bool write_learning(const SystemStudy *study, int index, FILE *lines, const Progress *progress, Error *error) {
    const Learning *learning = &learnings[index];
    char path[CSV_PATH_SIZE];
    if (!file_path(path, sizeof path, error, "%s/%s.yaml", study->scenes, paper_scene_names[learning->scene]))
        return false;
    Scene *scene = scene_read(path, error);
    Run *run = scene != NULL ? calloc(1, sizeof *run) : NULL;
    if (run == NULL) {
        scene_destroy(scene);
        return scene == NULL ? false : error_memory(error, "hybrid");
    }
    *run = (Run){.study = study, .learning = learning, .scene = scene, .lines = lines, .paid = NAN};
    run->launches = study->quick ? QUICK_LAUNCHES : LAUNCHES;
    run->change = study->quick ? QUICK_CHANGE : CHANGE;
    run->times = (HybridTimes){.scene = scene,
                               .prefix = hybrid_prefix(scene, error),
                               .steps = learning->steps,
                               .launches = study->quick ? QUICK_TIMED : TIMED,
                               .repetitions = study->quick ? QUICK_REPETITIONS : REPETITIONS,
                               .seed = study->seed};
    bool ok = run->times.prefix != NULL;
    ok = ok && hybrid_study_learn(run, progress, error);
    world_destroy(run->times.prefix);
    free(run);
    scene_destroy(scene);
    return ok;
}

static const SystemPart parts[] = {
    {"single", .weight = 2, .quick_weight = 0.1, .index = 0, .write = write_learning, .timed = true},
    {"stack", .weight = 20, .quick_weight = 0.2, .index = 1, .write = write_learning, .timed = true},
    {"pyramid", .weight = 4, .quick_weight = 0.2, .index = 2, .write = write_learning, .timed = true},
    {"pyramid_settled", .weight = 15, .quick_weight = 0.5, .index = 3, .write = write_learning, .timed = true},
    {"single-change", .weight = 2, .quick_weight = 0.1, .index = 4, .write = write_learning, .timed = true},
    {"stack-change", .weight = 7, .quick_weight = 0.2, .index = 5, .write = write_learning, .timed = true},
    {"pyramid_settled-change", .weight = 15, .quick_weight = 0.5, .index = 6, .write = write_learning, .timed = true},
    {"stack-narrow", .weight = 7, .quick_weight = 0.2, .index = 7, .write = write_learning, .timed = true},
    {"stack-wide", .weight = 7, .quick_weight = 0.2, .index = 8, .write = write_learning, .timed = true},
    {0}};

const PaperSystem system_hybrid = {.name = "hybrid",
                                   .methods = SYSTEM_METHODS("hybrid", "hybrid:net=off"),
                                   .table = &hybrid_layout,
                                   .parts = parts,
                                   .claims = hybrid_claims,
                                   .plot = plot_hybrid};
