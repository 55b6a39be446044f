/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/systems/hybrid_times.h"

#include "study/meter.h"
#include "study/statistics.h"
#include "tabulation_training/entry_fit.h"
#include "tabulation_training/launch_steps.h"
#include "tabulation_training/tabulation_training.h"

#include <math.h>
#include <stdlib.h>

/* The launches have numbers from UNLEARNED on, which no learning reaches. */
enum { TIMED = 20, QUICK_TIMED = 4, REPETITIONS = 9, QUICK_REPETITIONS = 3, UNLEARNED = 2 * TABULATION_LAUNCHES_MAX };

struct HybridTimes {
    const Scene *scene;
    LaunchSteps *runs;
    int steps, launches, repetitions;
    uint64_t seed;
};

HybridTimes *hybrid_times_create(const Scene *scene, int steps, uint64_t seed, bool quick, Error *error) {
    HybridTimes *times = calloc(1, sizeof *times);
    if (times == NULL) {
        error_memory(error, "hybrid");
        return NULL;
    }
    *times = (HybridTimes){.scene = scene,
                           .runs = launch_steps_create(scene, error),
                           .steps = steps,
                           .launches = quick ? QUICK_TIMED : TIMED,
                           .repetitions = quick ? QUICK_REPETITIONS : REPETITIONS,
                           .seed = seed};
    if (times->runs != NULL) return times;
    free(times);
    return NULL;
}

void hybrid_times_destroy(HybridTimes *times) {
    if (times == NULL) return;
    launch_steps_destroy(times->runs);
    free(times);
}

/* The rivals: hybrid, and interior by itself. */
enum { RIVALS = 2 };

typedef struct Measuring {
    const HybridTimes *times;
    AskedSteps asked;
    ContactSolver rivals[RIVALS];
    ContactSolution solutions[RIVALS];
    double *values; /* [asked, RIVALS, repetitions] us */
    double *errors; /* [asked] of answers */
    int answers;
} Measuring;

static bool run_launches(Measuring *measuring, const Tabulation *memory, bool turned, Error *error) {
    const HybridTimes *times = measuring->times;
    for (int i = 0; i < times->launches; i++) {
        const Launch launch = tabulation_launch(times->scene, times->seed, UNLEARNED + i, turned);
        if (!launch_steps_run(times->runs, &launch, memory, times->steps, &measuring->asked, error)) return false;
    }
    return true;
}

static bool reserve(Measuring *measuring, const Tabulation *memory, Error *error) {
    const size_t count = (size_t)measuring->asked.count, bodies = (size_t)memory->body_count;
    size_t contacts = 1;
    for (size_t i = 0; i < count; i++) {
        const size_t own = (size_t)measuring->asked.items[i].problem.contact_count;
        contacts = own > contacts ? own : contacts;
    }
    measuring->values = malloc((count + 1) * RIVALS * (size_t)measuring->times->repetitions * sizeof(double));
    measuring->errors = malloc((count + 1) * sizeof(double));
    bool ok = measuring->values != NULL && measuring->errors != NULL;
    for (int r = 0; r < RIVALS; r++) {
        ContactSolution *solution = &measuring->solutions[r];
        solution->velocities = calloc(bodies, sizeof *solution->velocities);
        solution->impulses = calloc(contacts, sizeof *solution->impulses);
        ok = ok && solution->velocities != NULL && solution->impulses != NULL;
    }
    return ok || error_memory(error, "hybrid");
}

/* All steps by both rivals, once. */
static bool pass(Measuring *measuring, int repetition, int64_t overhead, Error *error) {
    const int repetitions = measuring->times->repetitions;
    measuring->answers = 0;
    for (int i = 0; i < measuring->asked.count; i++) {
        const AskedStep *step = &measuring->asked.items[i];
        for (int r = 0; r < RIVALS; r++) {
            const ContactSolver *solver = &measuring->rivals[r];
            const int64_t begin = meter_time();
            if (!solver->kind->solve(solver->state, &step->problem, &measuring->solutions[r], error)) return false;
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

static void summarise(Measuring *measuring, HybridMeasures *measures) {
    const int repetitions = measuring->times->repetitions, count = measuring->asked.count;
    double sums[2][RIVALS] = {{0}}; /* of steps that are not answered, and that are */
    for (int i = 0; i < count; i++)
        for (int r = 0; r < RIVALS; r++)
            sums[measuring->asked.items[i].entry >= 0][r] +=
                statistics_quantile(measuring->values + (i * RIVALS + r) * repetitions, repetitions, 0.5);
    const double answers = or_nan(measuring->answers), others = or_nan(count - measuring->answers), all = or_nan(count);
    *measures = (HybridMeasures){.error = statistics_mean(measuring->errors, measuring->answers),
                                 .error_95 = statistics_quantile(measuring->errors, measuring->answers, 0.95),
                                 .us_answer = sums[1][0] / answers,
                                 .us_solve = sums[1][1] / answers,
                                 .us_question = fmax(sums[0][0] - sums[0][1], 0) / others,
                                 .us_step = (sums[0][0] + sums[1][0]) / all,
                                 .us_step_solve = (sums[0][1] + sums[1][1]) / all};
}

static bool measure(Measuring *measuring, Error *error) {
    const int64_t overhead = meter_time_overhead();
    bool ok = true;
    meter_pin();
    for (int r = 0; ok && r < measuring->times->repetitions; r++) ok = pass(measuring, r, overhead, error);
    meter_unpin();
    return ok;
}

bool hybrid_measure(HybridTimes *times, const Tabulation *memory, bool turned, HybridMeasures *measures, Error *error) {
    Measuring measuring = {.times = times};
    const bool ok = hybrid_make(&measuring.rivals[0], memory, NULL, error) &&
                    hybrid_make(&measuring.rivals[1], NULL, NULL, error) &&
                    run_launches(&measuring, memory, turned, error) && reserve(&measuring, memory, error) &&
                    measure(&measuring, error);
    if (ok) summarise(&measuring, measures);
    for (int r = 0; r < RIVALS; r++) {
        if (measuring.rivals[r].state != NULL) measuring.rivals[r].kind->destroy(measuring.rivals[r].state);
        free(measuring.solutions[r].velocities);
        free(measuring.solutions[r].impulses);
    }
    asked_steps_free(&measuring.asked);
    free(measuring.values);
    free(measuring.errors);
    return ok;
}
