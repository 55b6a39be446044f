/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Speed against accuracy: contenders, launches, scores, times, rows and pages of charts. */
#pragma once
#include "base/base.h"
#include "base/csv.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "methods/criteria.h"
#include "methods/methods.h"
#include "methods/reference.h"
#include "pictures/colours.h"
#include "runs/pieces.h"
#include "scenes/scenes.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The converged solution that a step is scored against. For most methods it is that of the step's contact problem. A
   method that moves overlapping bodies apart without giving them a velocity (no_push_out in its description) solves
   another problem: the same one without the bias that pushes bodies apart. */

/* Zero-initialise; free with converged_step_free. */
typedef struct ConvergedStep {
    Reference reference; /* of the last solve: velocities, residual */
    ContactPoint *contacts;
    size_t contact_capacity;
} ConvergedStep;

void converged_step_free(ConvergedStep *converged);

/* Solves to REFERENCE_TOLERANCE. push_out: with the bias of overlapping contacts. False when memory is short. */
bool converged_step_solve(ConvergedStep *converged, const ContactProblem *problem, bool push_out, Error *error);

/* Whether the last solve converged. What a bad method made explode does not, and neither do some impacts on hundreds of
   boxes; against that no error is measured. */
static inline bool converged_step_found(const ConvergedStep *converged) {
    return converged->reference.residual <= REFERENCE_TOLERANCE;
}

/* Log of a run, for comparison with another run of the same launch. */

typedef struct LoggedFrame {
    double energy;      /* J: mechanical energy of all dynamic bodies */
    double penetration; /* m: deepest contact of the step; 0 without contacts */
    Phase phase;        /* of the step */
    Vec2 bomb;          /* m: the bomb's position; 0 before it is there */
} LoggedFrame;

/* Zero-initialise; arrays grow and are reused. Bodies exclude the bomb. */
typedef struct RunLog {
    int bodies, frames;          /* frames: index of the last logged frame */
    int touch;                   /* first step in which the bomb touches; 0: none */
    int launch_frame, end_frame; /* the bomb's frame, and 5 s later: displaced boxes are counted between them */
    Vec2 *position;              /* [frames + 1, bodies] m */
    LoggedFrame *at;             /* [frames + 1] */
    double momentum_error;       /* N s: momentum created by steps (ContactSolution), sum */
    int fallen_back;             /* steps with discarded outputs, beyond training or solved by sweeps */
    int unconverged;             /* steps that did not converge, of the reference */
    int first_unconverged;       /* the first of them, from which on the log is no yardstick; 0: none */
    size_t position_capacity, at_capacity;
} RunLog;

void run_log_free(RunLog *log);

/* Begins the log of a run of the scene. False if out of memory. */
bool run_log_begin(RunLog *log, const Scene *scene, const World *world);

void run_log_step(RunLog *log, const Scene *scene, const World *world, int frame, Phase phase);

/* The first frame in which a body, the bomb included, is more than `limit` m from its place in another run of the same
   launch; if the log ended early (NaN or infinite), at the latest the frame after its last; `frames` if never. */
int run_log_apart(const RunLog *log, const RunLog *other, double limit, int frames);

/* A run compared with the converged run of the same launch; NaN if a phase does not occur. Energy and drift are compared before
   the converged run's first step that did not converge. */
typedef struct RunMeasures {
    double penetration[PHASES]; /* m: largest of the phase */
    double energy[PHASES];      /* J: excess over the converged run at the same frame, mean over the phase */
    double drift; /* m: mean distance of the boxes from the converged run, just before the bomb touches in either run */
    double moved; /* boxes that moved more than 0.5 m in the 5 s after the launch */
    double
        rollout_mse; /* m^2: squared distance from the converged run, mean over frames, boxes and both coordinates; NaN if the
                           state became NaN or infinite before that run did not converge */
} RunMeasures;

RunMeasures run_measures(const RunLog *log, const RunLog *converged, const Scene *scene);

/* A closed-loop run of a method; each step is scored against its own converged solution. */

/* Where the error of a scored step is largest. */
typedef struct StepPlace {
    int frame, body; /* body -1: none */
} StepPlace;

/* The laws of contact (methods/criteria.h), summed over the scored steps with impulses. */
typedef struct CriteriaSum {
    double signorini, cone, dissipation; /* J, N s, J */
    int64_t steps;
} CriteriaSum;

/* Errors of the scored steps. Zero-initialise; free with step_scores_free(). */
typedef struct StepScores {
    int count;
    double *error;    /* [count] m/s, RMS over the dynamic bodies */
    double *share;    /* [count] share of bodies that are right (methods/reference.h) */
    StepPlace *place; /* [count] */
    CriteriaSum criteria;
    size_t error_capacity, share_capacity, place_capacity;
} StepScores;

/* Adds the step to `frame`, given its solution. push_out: as contact_criteria(). False if out of memory. */
bool step_scores_add(StepScores *scores, int frame, const ContactProblem *problem, const ContactSolution *solution,
                     const ReferenceVelocity *reference, bool push_out);
void step_scores_free(StepScores *scores);

/* All impact frames are scored; of the frames after and at rest, every n-th: reference solves dominate the run time. */
typedef struct Sampling {
    int after, rest;
} Sampling;

bool sampling_takes(const Sampling *sampling, Phase phase, const PhaseTracker *tracker, int frame);

/* One thread's run in progress; zero-initialise, free with rollout_free. */
typedef struct Rollout {
    World *world;
    ConvergedStep converged;
    RunLog log;
    int unconverged; /* steps that are not scored (converged_step_found()) */
} Rollout;

void rollout_free(Rollout *rollout);

/* Runs a launched scene and adds the sampled steps to scores[PHASES] (NULL: none). If the state becomes NaN or
   infinite, the run ends early and its log is shorter. False with error set if out of memory. */
bool rollout_run(Rollout *rollout, Stepper *stepper, const Scene *launched, const Sampling *sampling,
                 StepScores scores[PHASES], Error *error);

/* The frozen protocol: every method solves the same steps, sampled from engine runs. */

typedef struct Snapshot {
    const Scene *scene; /* launched; owned by the caller */
    World *world;       /* before the step */
    int frame;          /* of the step */
    Phase phase;
    ReferenceVelocity *reference;   /* [bodies] converged velocities after the step */
    ReferenceVelocity *no_push_out; /* [bodies] the same for methods of that description; or NULL */
} Snapshot;

/* Zero-initialise. */
typedef struct SnapshotList {
    int count;
    Snapshot *items; /* [count] */
    size_t capacity;
    bool no_push_out; /* set by the caller: methods of that description will be scored, too */
    int unconverged;  /* steps that were left out (converged_step_found()) */
} SnapshotList;

/* Adds sampled steps of the engine's run of a launched scene; the scene must outlive the list. */
bool snapshots_add(SnapshotList *list, const Scene *launched, const Sampling *sampling, Error *error);
void snapshots_free(SnapshotList *list);

/* Scores a method on every step. world: scratch space for a copy. A method of the description no_push_out needs a list
   with that flag. */
bool snapshots_score(const SnapshotList *list, Stepper *stepper, World *world, StepScores scores[PHASES], Error *error);

/* chart.csv: speed and accuracy of every method; one row for each scene, method, setting, protocol and phase. */

enum { CHART_MAX_ROWS = 20000, CHART_NAME_SIZE = 128, CHART_SETTING_SIZE = 256 };

/* Frozen: all methods solve the same contact problems. Closed: each method runs on its own trajectory. */
typedef enum ChartProtocol { PROTOCOL_FROZEN, PROTOCOL_CLOSED } ChartProtocol;

enum { PROTOCOLS = PROTOCOL_CLOSED + 1 };

/* NaN if a protocol does not have the value. Errors are RMS velocity errors against the reference; mean, median and p95
   are over all scored steps of all launches. error_worst (closed loop only) is the largest mean error of a launch in
   the phase, over its scored steps (up to where its state became NaN or infinite); launches without scored steps are
   ignored. */
typedef struct ChartRow {
    const char *scene, *method; /* less than CHART_NAME_SIZE bytes */
    const char *setting;        /* "k=20,warm=off"; less than CHART_SETTING_SIZE */
    ChartProtocol protocol;
    Phase phase;
    int launches;
    double us_solver, us_solver_q1, us_solver_q3; /* time in the solver per step: median, quartiles; microseconds */
    double us_step;                               /* of the whole step, median; microseconds */
    double instructions;                          /* in the solver per step */
    double error_mean, error_median, error_p95;   /* m/s */
    double error_worst;                           /* mean of the worst launch, m/s */
    double share_right;                           /* of bodies, 0 to 1 */
    double penetration_max, drift;                /* m */
    double energy;                                /* above the converged run's, J */
    double moved;                                 /* boxes that moved more than 0.5 m */
    const char *cpu; /* processor that times and instructions were measured on; "": not measured, or not known */
    double
        us_engine; /* of an external method, which has no other times: what its engine says that a step took; median */
    double
        us_varies; /* 1: us_solver varies more than the times of other rows, also when measured again (StepCost); else 0. NaN: unknown */
    /* J, N s, J: largest violation of a step (methods/criteria.h), mean over the scored steps with impulses. NaN: none has. */
    double signorini, cone, dissipation;
    double rollout_mse; /* m^2: as in RunMeasures, mean over the launches */
} ChartRow;

/* The header is exact, but that the last columns, from cpu on, may be missing. Refused: a median time outside its quartiles. */
extern const CsvLayout chart_layout;

static inline const ChartRow *chart_row(const CsvTable *table, int i) { return (const ChartRow *)table->rows + i; }

/* The methods that a study compares, each with some settings. */

typedef struct Contender {
    char name[CHART_NAME_SIZE];       /* "engine" */
    char setting[CHART_SETTING_SIZE]; /* "k=10,warm=off"; may be empty */
    Method method;                    /* both, parsed */
} Contender;

typedef struct ContenderList {
    int count;
    Contender *items; /* [count] */
} ContenderList;

/* Which runs of a method's description (methods/methods.h) a study makes by default. */
typedef enum ContenderStudy { STUDY_CHART, STUDY_CHART_QUICK, STUDY_STABILITY } ContenderStudy;

/* Fills the list from "NAME,NAME:KEY=VALUE,...". A name alone stands for all runs of the method in a chart, and for one
   run without settings in the stability study. text NULL: all runs of every registered method. ERROR_INPUT for an
   unknown name or setting, or a run given twice. */
bool contenders_parse(ContenderList *list, const char *text, ContenderStudy study, Error *error);

void contenders_free(ContenderList *list);

/* Adds the files among the words of external methods to the key: what the programs do depends on them. */
bool contenders_add_to_key(const ContenderList *list, StudyKey *key, Error *error);

/* The registered methods that the study leaves out by default. */
NameList contenders_left_out(ContenderStudy study);

/* The contenders that can run in the scene: all but those that lack their network (method_lacks_network). fit[count of
   the list] points to items of the list. Returns how many there are. */
int contenders_for(const ContenderList *list, const Scene *scene, const Contender **fit);

/* The others. */
NameList contenders_without_network(const ContenderList *list, const Scene *scene);

/* The launches that a study scores. */

/* At most one of them; none: a number of the scene's family that the study chooses. */
typedef struct LaunchChoice {
    const char *table; /* path (scenes/scenes.h); NULL: none */
    FloatRange bomb_x; /* m; count 0: none */
    int count;         /* of the scene's family; 0: not given */
} LaunchChoice;

/* The launches of a scene with a bomb; *count is `standard` if the choice leaves it open. To be freed by the caller.
   NULL with error set for a table or a family that does not fit the scene, and for launches that launches_check()
   refuses. */
Launch *launch_choice_make(const LaunchChoice *choice, const Scene *scene, int standard, int *count, Error *error);

/* One stepper for each of several methods of a scene, which threads use in turns: some take seconds and much memory to be
   made. A stepper keeps nothing of a launch for the next, so the order of launches does not matter. */

typedef struct PooledStepper PooledStepper;

typedef struct StepperPool {
    PooledStepper *items; /* [count] */
    int count;
} StepperPool;

bool stepper_pool_begin(StepperPool *pool, int count, Error *error);
void stepper_pool_end(StepperPool *pool);

/* Destroys the steppers, which no thread may use; they are made again when they are needed. */
void stepper_pool_empty(StepperPool *pool);

/* Chooses a method that is not marked in chosen[count], from `from` on, and marks it: one that no other thread uses, or else
   one that it waits for. Returns its index; stepper_pool_give() must follow. */
int stepper_pool_take(StepperPool *pool, bool *chosen, int from);
void stepper_pool_give(StepperPool *pool, int index);

/* The stepper of the method that was taken. NULL with error set if it cannot be made. */
Stepper *stepper_pool_stepper(StepperPool *pool, int index, const Method *method, const Scene *scene, Error *error);

/* One scene of the speed-accuracy study: its launches and the methods that are scored on them. */

typedef struct StudySize {
    int launches;            /* unless a table of launches is given */
    Sampling closed, frozen; /* steps to score */
    int timed_launches, repetitions;
} StudySize;

typedef struct SceneStudy {
    Scene *scene;
    int launch_count, contender_count;
    Launch *launches;             /* [launch_count] */
    int striking_count;           /* of the launches: those that strike a box, by the engine; at least 1 */
    int *striking;                /* [striking_count] their places, rising */
    const Contender **contenders; /* [contender_count] available for this scene */
    StepperPool steppers;         /* of the contenders */
    bool no_push_out;             /* one of them is scored against converged velocities without push-out */
    StudySize size;
} SceneStudy;

/* Reads the scene and its launches. `size` is for scenes of up to 110 bodies; larger ones have fewer launches. ERROR_INPUT
   also if no launch strikes a box. */
bool scene_study_begin(SceneStudy *study, const char *path, const ContenderList *contenders,
                       const LaunchChoice *launches, const StudySize *size, Error *error);
void scene_study_end(SceneStudy *study);

/* The scene with a launch of the study, as launch_scene(). */
Scene scene_study_launch(const SceneStudy *study, int launch);

/* The number of launches whose times are measured, spread evenly over those that strike. */
int scene_study_timed(const SceneStudy *study);

/* The launch that was worst for a method in a chart: what a page shows of a point. */

typedef struct WorstLaunch {
    int launch;        /* of the study's; -1: no step of the phase was scored */
    double mean;       /* m/s: its mean error in the phase, chart.csv's error_worst */
    double error;      /* m/s: of the scored step of the phase with the largest error, */
    int frame, body;   /* which leads to this frame; its body with the largest error, or -1 */
    int touch, frames; /* the first step in which the bomb touches; frames of the run: fewer if its state became NaN */
} WorstLaunch;

/* Runs all launches of the study in closed loop once more, in parallel, and fills the impact and after phases of
   worst[PHASES]. */
bool worst_launch_find(const SceneStudy *study, const Method *method, WorstLaunch worst[PHASES],
                       const Progress *progress, Error *error);

/* What the pieces of a scene say about its reference solves. */
typedef struct SceneSolves {
    int64_t frozen, frozen_unconverged; /* frozen steps; those left out of them (converged_step_found()) */
    int64_t closed, closed_unconverged; /* the same in closed loop, of all methods together */
    int64_t runs_unconverged;           /* steps of the converged runs that did not converge */
} SceneSolves;

/* How a chart is drawn. */

/* 174 x 92 mm, two columns of a paper; 85 x 144 mm, one column, a panel above the other; 160 x 90 mm, 16:9. */
typedef enum ChartSize { CHART_PAGE, CHART_COLUMN, CHART_SLIDE } ChartSize;

typedef struct ChartLook {
    ChartSize size;
    const char *highlight; /* methods to be drawn in colour, separated by commas; NULL: none beside the usual ones */
    bool words;            /* the caption below the picture, too, which makes it higher */
    ColourChoices colours; /* those that name a line count */
} ChartLook;

/* The speed-accuracy study: every method in every scene, on held-out launches.

   Two protocols. Frozen: all methods solve the same steps, sampled from engine runs. Closed: each method runs on its
   own trajectory. In both, the final velocities of a step are compared with the converged solution
   (methods/reference.h) of its contact problem. */

enum { STUDY_MAX_SCENES = 32 };

typedef struct SpeedAccuracyScene SpeedAccuracyScene;

typedef struct SpeedAccuracyOptions {
    const char *const *scenes; /* paths of scene files */
    int scene_count;
    const char *methods; /* contenders_parse(); NULL: all */
    LaunchChoice launches;
    bool quick;           /* fewer launches, settings, steps and repetitions */
    const char *folder;   /* created if missing */
    bool pages;           /* for draw() */
    ChartLook look;       /* likewise */
    const PiecesRun *run; /* whole, a shard, or a merge */
    /* Is told of each scene before the work; NULL: nothing is. */
    void (*begin)(const SpeedAccuracyScene *scene);
    /* Draws folder/chart.csv; scenes[scene_count]. The key is of what determines the result. */
    bool (*draw)(const struct SpeedAccuracyOptions *study, const SpeedAccuracyScene *scenes, uint64_t key,
                 Error *error);
} SpeedAccuracyOptions;

struct SpeedAccuracyScene {
    char name[CHART_NAME_SIZE];
    int contenders, launches, striking; /* striking: launches that strike a box */
    NameList without_network; /* methods left out, since neither their settings nor the scene name a network */
    SceneSolves solves;
    bool timed; /* not if a merge leaves out its times */
};

/* Of the studies. */
const StudySize *speed_accuracy_size(bool quick);

/* Hashes a scene's file and its networks. A missing network is an error only of the method that needs it. */
bool study_key_add_scene(StudyKey *key, const char *path, Error *error);

/* Opens the pieces of a study in its folder and does them. Shards share a folder; a whole study has it to itself. */
bool study_do(Pieces *pieces, const char *folder, const StudyKey *key, const PiecesRun *run, const PiecePlan *plan,
              const Progress *progress, Error *error);

/* Does the pieces of the study, then writes folder/chart.csv, fills scenes[scene_count] and draws; a shard does its pieces
   only. An interrupted study continues if options, files and program are the same. ERROR_INPUT for an invalid option,
   scene or launch, ERROR_INTERRUPTED if progress stops the study. *pieces tells what was done; it has no plan any more. */
bool speed_accuracy_run(const SpeedAccuracyOptions *options, Pieces *pieces, const Progress *progress,
                        SpeedAccuracyScene *scenes, Error *error);

/* Tables from the pieces of a study (runs/pieces.h). The results of a piece are lines "TABLE:row", or "TABLE/SECTION:row";
   the rows of a table are put together in the order of the pieces. Lines that begin with "#" are the study's own notes, which
   no table has. */

/* Pieces that follow each other and whose rows are sorted by their section: a map has a piece for each cell, and its table
   has a section for each method. */
typedef struct PieceGroup {
    int64_t first, count;
    int sections; /* 0: the rows have none */
} PieceGroup;

/* Writes a row as such a line; the table's name is the layout's. section: -1: none. Errors as csv_row_print(). */
bool piece_tables_print(FILE *results, const CsvLayout *layout, int section, const void *row, Error *error);

/* Writes folder/TABLE.csv of each layout: the header and the table's rows. groups[group_count] cover all pieces; NULL: one
   without sections. Reads each piece once; memory: the results of all. */
bool piece_tables_write(const Pieces *pieces, const char *folder, const CsvLayout *const *layouts, int layout_count,
                        const PieceGroup *groups, int group_count, Error *error);

/* Closed-loop comparison: a method, the engine and the reference run the same launches, each on its own trajectory. */

enum { CLOSED_LOOP_FRAMES = 600 };

/* A run of one launch beside others of the same launch. */
typedef struct LaunchLoop {
    double frames_engine; /* first frame in which a body is more than 0.1 m from its place in the engine's
                                run; the scene's frames: never; NAN without a run to compare with */
    double
        frames_converged;   /* the same of the converged run; NAN, too, if that is not converged before the runs part */
    double moved;           /* boxes that moved more than 0.5 m in the 5 s after the launch */
    double penetration;     /* m: the deepest contact */
    double energy_put_in;   /* J: mechanical energy when the bomb was added */
    double energy_most;     /* J: the largest from then on */
    double momentum_error;  /* N s: momentum created by all steps (ContactSolution), sum */
    int steps, fallen_back; /* steps taken; those with discarded outputs, beyond training or solved by sweeps */
} LaunchLoop;

/* Runs a launched scene for its frames and compares. engine, converged: logs of whole runs of this launch, or NULL. The run ends early if its state becomes NaN or infinite. rollout: scratch. */
bool closed_loop_launch(Rollout *rollout, const Method *method, const Scene *launched, const RunLog *engine,
                        const RunLog *converged, LaunchLoop *result, Error *error);

/* Logs a run of a launched scene to compare others with. ERROR_INPUT if its state becomes NaN or infinite. */
bool closed_loop_log(RunLog *log, const char *method, const Scene *launched, Error *error);

typedef struct ClosedLoop {
    double frames_until_apart; /* LaunchLoop.frames_converged, median over the launches of which it is known */
    int unconverged;           /* launches of which it is not */
    double penetration_max;    /* m: of all launches */
    double momentum_error;     /* N s: momentum created per step (ContactSolution), mean */
    double energy_ratio;       /* largest mechanical energy / energy when the bomb was added; largest of all launches */
} ClosedLoop;

/* Logs the converged run of a launch for CLOSED_LOOP_FRAMES. Errors as closed_loop_log(). */
bool closed_loop_log_converged(RunLog *log, const Scene *launched, Error *error);

/* Runs launches[count] of a scene for as long. converged[count]: the logs of their converged runs. */
bool closed_loop_run(const Method *method, const Scene *launches, const RunLog *converged, int count,
                     ClosedLoop *result, Error *error);

/* Microseconds per step of a method and of the engine, measured in turns on engine states: mean over the states of the
   median over the repetitions. */
bool closed_loop_time(const Method *method, const SnapshotList *states, int repetitions, double *us_step,
                      double *us_step_engine, Error *error);

/* Measures the cost of contenders, in turns on one core, with repetitions. The first steps of each, those of one launch, do
   not count.

   A time varies if the distance of its quartiles, as a share of its median, is more than TIMES_VARY_FACTOR that of the middle
   one of the other contenders in the same protocol and phase, more than TIMES_VARY_LEAST, and more than a clock's own error,
   TIMES_VARY_US. A contender with such a time is measured again, and has the times of the second measurement only. */

#define TIMES_VARY_FACTOR 3.0
#define TIMES_VARY_LEAST 0.1
#define TIMES_VARY_US 0.1

/* Microseconds per step in one phase: means over the steps of the median and the quartiles that each step has over the
   repetitions. NaN if the phase does not occur. */
typedef struct StepCost {
    double solver, solver_q1, solver_q3; /* of the solver alone: median, quartiles */
    double step;                         /* of the whole step: median */
    double engine;                       /* of an external method, instead of all others: median; else NaN */
    int steps;                           /* of the phase, in each repetition */
    double instructions;                 /* of the solver; NaN if they cannot be counted */
    bool varies;                         /* also when it was measured again */
} StepCost;

typedef struct TimingOptions {
    const Scene *launches;         /* [launch_count] launched scenes, run in closed loop */
    int launch_count, repetitions; /* each repetition runs all launches */
    int last_frame;                /* of each run */
    bool no_instructions;          /* do not count them: that takes a run more */
} TimingOptions;

/* Fills closed[count][PHASES] (closed loop) and frozen[count][PHASES] (frozen steps). */
bool timing_measure(const Contender *const *contenders, int count, const TimingOptions *options,
                    const SnapshotList *snapshots, StepCost (*closed)[PHASES], StepCost (*frozen)[PHASES],
                    const Progress *progress, Error *error);

/* Mean over the steps of all phases: of the whole step, or only of the solver, for methods whose step is nothing else
   (no_contacts in methods/methods.h). NaN without steps. */
double step_cost_mean(const StepCost costs[PHASES], bool only_solver);

/* Measures time and, where the system permits it, instructions of the calling thread. */

/* Pins the calling thread to its current core, to avoid the cost of migration; unpins it. No effect if the system does
   not support it. */
void meter_pin(void);
void meter_unpin(void);

/* Nanoseconds of a monotonic clock. Tests put a clock that counts in the place of the system's (tests/studies/test_times.c). */
int64_t meter_time(void);

/* Nanoseconds between two consecutive calls of meter_time(), to be subtracted from every measurement. */
int64_t meter_time_overhead(void);
/* `passed` without the overhead; at least 0, as the overhead itself varies by some nanoseconds. */
int64_t meter_without(int64_t passed, int64_t overhead);

/* Instructions of this thread since the counter was opened; 0 if it is not available. */
bool meter_open_instructions(void);
int64_t meter_instructions(void);
void meter_close_instructions(void);

/* What charts and tables of chart.csv read from its rows. */

enum { CHART_FAMILY_SIZE = CHART_NAME_SIZE + 2 * CHART_SETTING_SIZE };

enum { CHART_TIMES_SIZE = CPU_NAME_SIZE + 200 };

/* Splits "k=20,warm=off" into numbers "k=20" and words "warm=off", appended to texts of 2 * CHART_SETTING_SIZE. */
void chart_split_setting(const char *setting, char *numbers, char *words);

/* The family of a row: its method with the words of its setting ("engine:warm=off"). Settings of one family differ in
   numbers only. */
void chart_row_family(const ChartRow *row, char family[CHART_FAMILY_SIZE]);

/* True if the boxes drifted by half a metre before the bomb came: the method was scored on another scene. */
bool chart_row_lost(const ChartRow *rows, int count, const ChartRow *row);

/* "Times measured on PROCESSOR.", whether those of others are left out (twinbox merge --times first), and how many vary
   (us_varies); "" if no row names one. */
void chart_times_note(char note[CHART_TIMES_SIZE], const ChartRow *rows, int count);

/* Whether the times of a scene are left out: rows of other scenes have times, and name their processor. */
bool chart_scene_untimed(const ChartRow *rows, int count, const char *scene);

/* Statistics of a list of numbers; NaN if it is empty. */

double statistics_mean(const double *values, int count);

/* Moves the values that are not NaN to the front; how many. */
int statistics_known(double *values, int count);

/* Sorts the values; interpolates linearly. fraction: 0.5 for the median, 0.25 and 0.75 for the quartiles. */
double statistics_quantile(double *values, int count, double fraction);

/* chart_pages.csv: the launch that was worst for each point of a chart, and the page that plays it. */

/* m, rad, rad/s, kg, s, m/s; frames from 0. */
typedef struct LaunchPage {
    const char *scene, *method, *setting; /* of the point, as in chart.csv */
    Phase phase;
    int launch; /* of the study's, from 1 */
    float x, rotation, spin, mass;
    int launch_frame;
    double error_worst; /* mean over the phase, as in chart.csv */
    double error;       /* of the worst step, which leads to: */
    double time;
    int frame, body;  /* body -1: none */
    const char *page; /* "pages/NAME.html#t=0.55&body=7&run=1"; empty: left out */
    int bytes;        /* of the page */
} LaunchPage;

extern const CsvLayout launch_page_layout;

/* Charts of speed against accuracy, drawn from chart.csv. */

/* ERROR_INPUT if a choice names no line of the charts of these rows, of which method and setting count, or has a colour that is
   refused (pictures/colours.h). */
bool chart_colours_check(const ColourChoices *choices, const ChartRow *rows, int count, Error *error);

/* Whether rows of the table have each name of the list, at most as many as there are colours. ERROR_INPUT otherwise. */
bool chart_highlight_check(const char *highlight, const ChartRow *rows, int count, Error *error);

/* Draws folder/chart-SCENE.png, .svg and .pdf from the table at csv_path, and writes what they show as chart-SCENE.txt. x:
   solver time per step; y: mean velocity error; both logarithmic. Two panels: impact frames and the 60 frames after, in closed
   loop. At most six methods are in colour, each named at its curve; all others are grey. What no method reaches is shaded
   (the Pareto front, studies/chart_internal.h); dotted lines are the time and the error of the engine as shipped. The folder
   must exist. ERROR_INPUT for an invalid table, a scene without marks, or a scene name that is not a file name. Each file appears complete or not at all. */
bool chart_plot(const char *csv_path, const char *scene, const char *folder, const ChartLook *look, Error *error);

/* chart.html: the charts of a study; their points, and a table of them, link to pages of runs. */

/* Writes folder/chart.html from chart.csv, chart_pages.csv (studies/chart.h) and the charts' .svg files there. Without a
   script: a picture with links above its points, which a table repeats for the keyboard. look: as of the charts. */
bool chart_html_write(const char *folder, const ChartLook *look, Error *error);

/* The table and the figure of errors at equal time (studies/chart_internal.h). */

typedef struct EqualTimeFigure {
    bool drawn; /* false if no method has a rival: there are tables only */
    NameList left_out;
} EqualTimeFigure;

/* Reads a chart.csv and writes folder/equal_time.csv and equal_time_methods.csv, and the latter as a figure,
   folder/equal_time.png, .svg and .pdf with their caption, .txt: a row for each scene, a column for each method, in each cell its error as a ratio to
   that of its best rival in the same time. Methods and scenes without any ratio are left out, and named there. */
bool equal_time_plot(const char *chart_csv, const char *folder, EqualTimeFigure *figure, Error *error);
