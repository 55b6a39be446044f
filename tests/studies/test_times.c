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

enum { READING = 7, COLLISION = 20000, REPETITIONS = 3, MARKED = 8 }; /* ns, ns */

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
    int calm;            /* 1: from the second measurement on, all take what the second one does */
    int rising;          /* 1: the n-th step of a launch takes n times as long */
    int mark;            /* where it counts its launches */
    int launches;        /* begun so far; the first is there to get warm, and takes a thousand times as long */
} Known;

static int launches_of[MARKED];

static const SettingSpec settings[] = {
    {"a", "ns of a step in the first repetition", SETTING_INT(Known, ns[0], 0, 1000000)},
    {"b", "in the second", SETTING_INT(Known, ns[1], 0, 1000000)},
    {"c", "in the third", SETTING_INT(Known, ns[2], 0, 1000000)},
    {"calm", "1: only in the first measurement", SETTING_INT(Known, calm, 0, 1)},
    {"rising", "1: times the frame", SETTING_INT(Known, rising, 0, 1)},
    {"mark", "number of a counter", SETTING_INT(Known, mark, 0, MARKED - 1)},
    {0}};

static void *create(const Settings *chosen, const Scene *scene, Error *error) {
    static const Known standard;
    (void)scene;
    return settings_make(chosen, settings, &standard, sizeof standard, "known", error);
}

static int64_t work(const Known *known, int frame) {
    if (known->launches == 0) return known->ns[1]; /* single steps */
    if (known->launches == 1) return 1000 * (int64_t)known->ns[0];
    const int repetition = known->launches - 2;
    const bool calm = known->calm && repetition >= REPETITIONS;
    return (int64_t)known->ns[calm ? 1 : repetition % REPETITIONS] * (known->rising ? frame : 1);
}

static bool solve(void *state, BegunStep *begun, Error *error) {
    static const SequentialOptions options = {.accumulate = true, .warm = true};
    Known *known = state;
    (void)error;
    if (begun->step->frame == 1) launches_of[known->mark] = ++known->launches;
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

/* The median of 1, 2 and 4 is neither their mean nor the first, the last, or the median of the last two. */
#define A_2_US "known:a=1000,b=2000,c=4000"
#define A_6_US "known:a=12000,b=3000,c=6000"

static bool draw(const SpeedAccuracyOptions *options, const SpeedAccuracyScene *scenes, Error *error) {
    (void)options, (void)scenes, (void)error;
    return true;
}

static void assert_known_row(const ChartRow *row, double us, double unit) {
    assert_near(row->us_solver, us, 1e-9);
    assert_near(row->us_solver_q1, 1.5 * unit, 1e-9);
    assert_near(row->us_solver_q3, 3 * unit, 1e-9);
    assert_near(row->us_step, us + COLLISION / 1000.0, 1e-9);
    assert_true(row->us_varies == 0);
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
        const bool slow = strcmp(row->setting, "a=12000,b=3000,c=6000") == 0;
        if (isnan(row->us_solver)) continue;
        timed[row->protocol][row->phase]++;
        assert_known_row(row, slow ? 6 : 2, slow ? 3 : 1);
    }
    for (int phase = 0; phase < PHASES; phase++) assert_int_equal(timed[PROTOCOL_CLOSED][phase], 2);
    assert_int_equal(timed[PROTOCOL_FROZEN][PHASE_IMPACT], 2);
    csv_table_free(&table);
}

/* Contenders of a scene, whose launch ends after some frames at rest. */
typedef struct Measured {
    Contender contenders[MARKED];
    StepCost closed[MARKED][PHASES], frozen[MARKED][PHASES];
} Measured;

static void measure(Measured *measured, const char *const *texts, int count, int last_frame) {
    Error error = {0};
    OWN(Scene) *scene = scene_named("single");
    const Contender *contenders[MARKED];
    const SnapshotList none = {0};
    const TimingOptions options = {
        .launches = scene, .launch_count = 1, .repetitions = REPETITIONS, .last_frame = last_frame};
    for (int i = 0; i < count; i++) {
        contenders[i] = &measured->contenders[i];
        measured->contenders[i].method = method_named(texts[i]);
    }
    assert_ok(timing_measure(contenders, count, &options, &none, measured->closed, measured->frozen, NULL, &error),
              error);
}

/* Steps of 1 to 9 times 2 us. */
TEST(a_time_is_the_mean_over_the_steps_of_their_medians) {
    Measured measured;
    measure(&measured, (const char *const[]){A_2_US ",rising=1"}, 1, 9);
    const StepCost *rest = &measured.closed[0][PHASE_REST];
    assert_int_equal(rest->steps, 9);
    assert_near(rest->solver, 10, 1e-9);
    assert_near(rest->solver_q1, 7.5, 1e-9);
    assert_near(rest->solver_q3, 15, 1e-9);
    assert_near(rest->step, 10 + COLLISION / 1000.0, 1e-9);
    assert_true(isnan(measured.closed[0][PHASE_IMPACT].solver) && isnan(measured.frozen[0][PHASE_REST].solver));
    assert_near(step_cost_mean(measured.closed[0], true), 10, 1e-9);
    assert_near(step_cost_mean(measured.closed[0], false), 10 + COLLISION / 1000.0, 1e-9);
}

#define CALM "known:a=100000,b=101000,c=102000,mark="

/* Three are calm: their quartiles are 1% apart. One is disturbed only while it is measured first, one always. */
TEST(a_time_that_varies_more_than_the_others_is_measured_again_and_marked) {
    Measured measured;
    measure(&measured,
            (const char *const[]){CALM "0", CALM "1", CALM "2", "known:a=182000,b=38000,c=182000,calm=1,mark=3",
                                  "known:a=50000,b=60000,c=90000,mark=4"},
            5, 4);
    for (int i = 0; i < 5; i++) {
        const StepCost *rest = &measured.closed[i][PHASE_REST];
        assert_int_equal(launches_of[i], 1 + REPETITIONS * (i < 3 ? 1 : 2)); /* and one to get warm */
        assert_near(rest->solver, i < 3 ? 101 : i == 3 ? 38 : 60, 1e-9);
        assert_near(rest->solver_q3, i < 3 ? 101.5 : i == 3 ? 38 : 75, 1e-9);
        assert_int_equal(rest->varies, i == 4);
        assert_false(measured.closed[i][PHASE_IMPACT].varies);
    }
}

/* Three times as much as the middle one of the others is not more than that; nor is a tenth, or the error of a
   clock. */
TEST(what_varies_like_the_others_is_measured_once) {
    static const char wide[] = "known:a=90000,b=100000,c=110000", wider[] = "known:a=70000,b=100000,c=131000",
                      narrow[] = "known:a=91000,b=100000,c=110000", still[] = "known:a=100000,b=100000,c=100000",
                      quick[] = "known:a=100,b=200,c=300";
    static const struct {
        const char *texts[4];
        bool varies; /* the last */
    } cases[] = {{{wide, wide, wide, "known:a=71000,b=100000,c=130000"}, false},
                 {{wide, wide, wide, wider}, true},
                 {{still, wide, still, narrow}, false},
                 {{still, still, wide, "known:a=89000,b=100000,c=110000"}, true},
                 {{still, still, still, quick}, false}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Measured measured;
        measure(&measured, cases[i].texts, 4, 2);
        assert_int_equal(measured.closed[3][PHASE_REST].varies, cases[i].varies);
        assert_false(measured.closed[0][PHASE_REST].varies);
    }
    Measured alone;
    measure(&alone, (const char *const[]){wider}, 1, 2);
    assert_false(alone.closed[0][PHASE_REST].varies);
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
    assert_near(us_step, 2 + COLLISION / 1000.0, 1e-9);
    snapshots_free(&states);
}

RUN_TESTS(NULL, NULL)
