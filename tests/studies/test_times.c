/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Times of methods whose work is known. The system's clock is replaced by one that counts: reading it takes some
   nanoseconds, so does collision detection, and the solver of the method "known" takes what its settings say. So every
   time that a study writes is known exactly. */
#include "base/settings.h"
#include "made.h"

#include "methods/sweeps.h"
#include "studies/chart.h"
#include "studies/chart_table.h"
#include "studies/closed_loop.h"
#include "studies/contenders.h"
#include "studies/rollout.h"
#include "studies/timing.h"

#include <time.h>

int __real_clock_gettime(clockid_t clock, struct timespec *now);
int __wrap_clock_gettime(clockid_t clock, struct timespec *now);
bool __real_method_parse(Method *method, const char *text, Error *error);
bool __wrap_method_parse(Method *method, const char *text, Error *error);
bool __real_sort_and_sweep_find(SortAndSweep *sweep, PairList *list, const Bounds *bounds, const bool *fixed,
                                int count);
bool __wrap_sort_and_sweep_find(SortAndSweep *sweep, PairList *list, const Bounds *bounds, const bool *fixed,
                                int count);

enum { READING = 7, COLLISION = 20000, REPETITIONS = 2, MOST = 4 }; /* ns, ns */

static _Thread_local int64_t ticks; /* ns */

int __wrap_clock_gettime(clockid_t clock, struct timespec *now) {
    if (clock != CLOCK_MONOTONIC) return __real_clock_gettime(clock, now);
    ticks += READING;
    *now = (struct timespec){.tv_sec = ticks / 1000000000, .tv_nsec = ticks % 1000000000};
    return 0;
}

/* world.c calls it once in each step. It is of another file: calls within one are not replaced by every linker. */
bool __wrap_sort_and_sweep_find(SortAndSweep *sweep, PairList *list, const Bounds *bounds, const bool *fixed,
                                int count) {
    ticks += COLLISION;
    return __real_sort_and_sweep_find(sweep, list, bounds, fixed, count);
}

typedef struct Known {
    int ns[REPETITIONS]; /* of a step in each repetition of a launch */
    int swap;            /* frame from which on the repetitions change places */
    int rising;          /* 1: the n-th step of a launch takes n times as long */
    int mark;            /* what it writes into `order` when a launch begins */
    int launches;        /* begun so far */
} Known;

static char order[32];

static const SettingSpec settings[] = {
    {"a", "ns of a step in the first repetition", SETTING_INT(Known, ns[0], 0, 1000000)},
    {"b", "in the second", SETTING_INT(Known, ns[1], 0, 1000000)},
    {"swap", "frame from which on these change places", SETTING_INT(Known, swap, 0, 1000000)},
    {"rising", "1: times the frame", SETTING_INT(Known, rising, 0, 1)},
    {"mark", "a digit", SETTING_INT(Known, mark, 0, 9)},
    {0}};

static void *create(const Settings *chosen, const Scene *scene, Error *error) {
    static const Known standard = {.swap = 1000000};
    (void)scene;
    return settings_make(chosen, settings, &standard, sizeof standard, "known", error);
}

static int64_t work(const Known *known, int frame) {
    if (known->launches == 0) return known->ns[1]; /* single steps */
    const int repetition = known->launches + (frame >= known->swap);
    return (int64_t)known->ns[repetition % REPETITIONS] * (known->rising ? frame : 1);
}

static bool solve(void *state, BegunStep *begun, Error *error) {
    static const SequentialOptions options = {.accumulate = true, .warm = true};
    Known *known = state;
    (void)error;
    if (begun->step->frame == 1) {
        known->launches++;
        const size_t written = strlen(order);
        snprintf(order + written, sizeof order - written, "%d", known->mark);
    }
    sequential_impulses_solve(begun->problem, &options, 10, begun->solution);
    ticks += work(known, begun->step->frame);
    return true;
}

static const SteppingKind stepping_known = {
    .description = {.name = "known", .settings = settings}, .create = create, .solve = solve, .destroy = free};
static const MethodKind known_kind = {&stepping_known.description, NULL, &stepping_known};

bool __wrap_method_parse(Method *method, const char *text, Error *error) {
    if (strncmp(text, "known:", 6) != 0) return __real_method_parse(method, text, error);
    *method = (Method){.kind = &known_kind};
    snprintf(method->text, sizeof method->text, "%s", text);
    return settings_parse(&method->settings, text + 6, settings, "known", error);
}

#define A_2_US "known:a=2000,b=4000"
#define A_6_US "known:a=12000,b=6000"

static bool draw(const SpeedAccuracyOptions *options, const SpeedAccuracyScene *scenes, Error *error) {
    (void)options, (void)scenes, (void)error;
    return true;
}

TEST(a_chart_of_known_work_has_known_times) {
    static const char *const scenes[] = {SOURCE_DIR "/scenes/single.yaml"};
    const SpeedAccuracyOptions options = {.scenes = scenes,
                                          .scene_count = 1,
                                          .methods = A_2_US "," A_6_US,
                                          .launches = {.count = 2},
                                          .quick = true,
                                          .folder = temporary_path("chart"),
                                          .draw = draw};
    Pieces pieces = {0};
    SpeedAccuracyScene summary;
    CsvTable table;
    int timed[PROTOCOLS][PHASES] = {{0}};
    assert_ok(speed_accuracy_run(&options, &pieces, NULL, &summary, &error), error);
    assert_ok(csv_table_read_from(&table, options.folder, &chart_layout, &error), error);
    for (int i = 0; i < table.count; i++) {
        const ChartRow *row = chart_row(&table, i);
        const double us = strcmp(row->setting, "a=12000,b=6000") == 0 ? 6 : 2;
        if (isnan(row->us_solver)) continue;
        timed[row->protocol][row->phase]++;
        assert_near(row->us_solver, us, 1e-9);
        assert_near(row->us_step, us + COLLISION / 1000.0, 1e-9);
    }
    for (int phase = 0; phase < PHASES; phase++) assert_int_equal(timed[PROTOCOL_CLOSED][phase], 2);
    assert_int_equal(timed[PROTOCOL_FROZEN][PHASE_IMPACT], 2);
    csv_table_free(&table);
}

/* Contenders of a scene, whose launches end after some frames at rest. */
typedef struct Measured {
    Contender contenders[MOST];
    StepCost closed[MOST][PHASES], frozen[MOST][PHASES];
} Measured;

static void measure(Measured *measured, const char *const *texts, int count, int launch_count, int last_frame) {
    Error error = {0};
    OWN(Scene) *scene = scene_named("single");
    const Scene launches[] = {*scene, *scene};
    const Contender *contenders[MOST];
    const SnapshotList none = {0};
    const TimingOptions options = {
        .launches = launches, .launch_count = launch_count, .repetitions = REPETITIONS, .last_frame = last_frame};
    for (int i = 0; i < count; i++) {
        contenders[i] = &measured->contenders[i];
        measured->contenders[i].method = method_named(texts[i]);
    }
    assert_ok(timing_measure(contenders, count, &options, &none, measured->closed, measured->frozen, NULL, &error),
              error);
}

/* Steps of 1 to 9 times 2 us. */
TEST(a_time_is_the_mean_over_the_steps) {
    Measured measured;
    measure(&measured, (const char *const[]){"known:a=2000,b=4000,rising=1"}, 1, 1, 9);
    const StepCost *rest = &measured.closed[0][PHASE_REST];
    assert_int_equal(rest->steps, 9);
    assert_near(rest->solver, 10, 1e-9);
    assert_near(rest->step, 10 + COLLISION / 1000.0, 1e-9);
    assert_true(isnan(measured.closed[0][PHASE_IMPACT].solver) && isnan(measured.frozen[0][PHASE_REST].solver));
    assert_near(step_cost_mean(measured.closed[0], true), 10, 1e-9);
    assert_near(step_cost_mean(measured.closed[0], false), 10 + COLLISION / 1000.0, 1e-9);
}

/* Each repetition is interrupted, one before a frame and one from there on; no step has the time of both. */
TEST(what_interrupts_a_step_in_one_repetition_does_not_count) {
    Measured measured;
    measure(&measured, (const char *const[]){"known:a=2000,b=900000,swap=5"}, 1, 1, 9);
    assert_near(measured.closed[0][PHASE_REST].solver, 2, 1e-9);
    assert_near(measured.closed[0][PHASE_REST].step, 2 + COLLISION / 1000.0, 1e-9);
}

TEST(contenders_take_turns_launch_by_launch) {
    Measured measured;
    order[0] = '\0';
    measure(&measured, (const char *const[]){"known:mark=1", "known:mark=2", "known:mark=3"}, 3, 2, 2);
    assert_string_equal(order, "123123123123");
    assert_int_equal(measured.closed[0][PHASE_REST].steps, 2 * 2);
}

/* The engine's solver takes no time here. */
TEST(a_method_is_timed_beside_the_engine) {
    OWN(Scene) *scene = scene_named("single");
    const Method known = method_named(A_2_US);
    const Sampling sampling = {1, 20};
    SnapshotList states = {0};
    double us_step, us_step_engine;
    assert_ok(snapshots_add(&states, scene, &sampling, &error), error);
    assert_ok(closed_loop_time(&known, &states, REPETITIONS, &us_step, &us_step_engine, &error), error);
    assert_near(us_step_engine, COLLISION / 1000.0, 1e-9);
    assert_near(us_step, 4 + COLLISION / 1000.0, 1e-9);
    snapshots_free(&states);
}

RUN_TESTS(NULL, NULL)
