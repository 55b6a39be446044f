/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Another program steps the scene: a real engine behind an adapter of some lines (scenes/engines/README.md).

   The program gets the bodies once, and is asked for several steps at a time, so that a round trip costs less than a
   step. Its poses and velocities become those of the world; contacts are those that collision detection finds between
   its poses, without impulses. So it runs whole scenes from the start, not single steps of others.

   Fails where the program does: it ends, is silent for too long, or answers what cannot be. */
#include "base/base.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "methods/adapter.h"
#include "methods/methods.h"
#include "scenes/scenes.h"

#include <stdlib.h>
#include <string.h>

/* What a program may compute ahead of the frame that is read: enough to hide the round trip, and it stays in a pipe. */
enum { AHEAD_BYTES = 1 << 16 };

typedef struct Exec {
    float step_limit, run_limit; /* s */
    float skin;                  /* m; for the verdict */
    Settings settings;
    char where[METHOD_TEXT_SIZE]; /* of errors */
    Adapter *adapter;             /* NULL: none yet, or it has failed */
    int bodies, frame;            /* of the program's scene; the last frame read */
    double end;                   /* of the run, by clock_seconds() */
    BodyDef *added;
    BodyPose *poses;
    size_t added_capacity, pose_capacity;
    char why[256]; /* of a program that does not start */
} Exec;

static const SettingSpec settings[] = {
    {"name", "what pictures call it (default: the program)", SETTING_OWN},
    {"step_limit", "seconds that its start or a step may take (default: 10)",
     SETTING_FLOAT(Exec, step_limit, 0.01f, 86400)},
    {"run_limit", "seconds that a run may take (default: 600)", SETTING_FLOAT(Exec, run_limit, 0.01f, 864000)},
    {"skin", "m that it adds to each side of a box, for the verdict (default: 0)", SETTING_FLOAT(Exec, skin, 0, 1)},
    {"*", "all other settings are passed to the program", SETTING_OWN},
    {0}};

/* Programs start with the first step, so that one that cannot is a result of the run, as any later failure is. */
static void *exec_create(const Settings *chosen, const Scene *scene, Error *error) {
    static const Exec standard = {.step_limit = 10, .run_limit = 600};
    (void)scene;
    Exec *exec = settings_make(chosen, settings, &standard, sizeof standard, "exec", error);
    if (exec == NULL) return NULL;
    exec->settings = *chosen;
    snprintf(exec->where, sizeof exec->where, "exec:%s", settings_get(chosen, "program"));
    return exec;
}

/* The rest of an answer is read, so that the program can serve the next run. */
static void leave(Exec *exec) {
    AdapterFrame frame;
    const double until = clock_seconds() + (double)exec->step_limit;
    bool works = exec->adapter != NULL;
    while (works && adapter_frames_left(exec->adapter) > 0) works = adapter_read(exec->adapter, &frame, until);
    (works ? adapter_give : adapter_end)(exec->adapter);
    exec->adapter = NULL;
}

static void exec_destroy(void *state) {
    Exec *exec = state;
    leave(exec);
    free(exec->added);
    free(exec->poses);
    free(exec);
}

static bool exec_fail(Exec *exec, Error *error, const char *why) {
    if (clock_seconds() >= exec->end) why = "the run has taken longer than its run_limit";
    error_failure(error, FAILURE_ADAPTER, exec->where, "adapter failed: %s", why);
    program_failed(error->message);
    adapter_end(exec->adapter);
    exec->adapter = NULL;
    return false;
}

static bool begin_run(Exec *exec, Error *error) {
    leave(exec);
    exec->end = clock_seconds() + (double)exec->run_limit;
    exec->bodies = exec->frame = 0;
    exec->adapter = adapter_take(&stepping_exec.description, &exec->settings, (double)exec->step_limit, exec->why,
                                 sizeof exec->why);
    return exec->adapter != NULL || exec_fail(exec, error, exec->why);
}

/* Steps until the scene ends, or adds or removes a body; but not more than `most`. */
static int steps_ahead(const Scene *scene, int frame, int most) {
    const int events[] = {scene->frames, scene->bomb.present ? scene->bomb.frame : 0, scene->last_body_until};
    int steps = most;
    for (int i = 0; i < 3; i++)
        if (events[i] >= frame && events[i] - frame + 1 < steps) steps = events[i] - frame + 1;
    return steps;
}

/* The next steps, with the bodies that the world has now. */
static bool exec_ask(Exec *exec, const BegunStep *begun, double until, Error *error) {
    const Scene *scene = begun->step->scene;
    const int count = begun->problem->body_count, before = exec->bodies;
    const int ahead = AHEAD_BYTES / ((int)sizeof(float) * ADAPTER_NUMBERS * (count + 1)) + 1;
    const AdapterRequest request = {
        .frame = exec->frame,
        .steps = steps_ahead(scene, exec->frame + 1, ahead < ADAPTER_STEPS_MAX ? ahead : ADAPTER_STEPS_MAX),
        .added = count > before ? count - before : 0,
        .removed = count < before ? before - count : 0,
        .add = exec->added,
        .gravity = scene->gravity,
        .dt = scene->dt,
        .iterations = scene->iterations};
    for (int i = 0; i < request.added; i++)
        exec->added[i] = before + i < scene->body_count ? scene->bodies[before + i] : scene_bomb_body(scene);
    exec->bodies = count;
    return adapter_ask(exec->adapter, &request, until) || exec_fail(exec, error, adapter_why(exec->adapter));
}

static bool next_frame(Exec *exec, const BegunStep *begun, AdapterFrame *frame, Error *error) {
    const int number = begun->step->frame;
    if (number == 1 && !begin_run(exec, error)) return false;
    if (exec->adapter == NULL || number != exec->frame + 1)
        return error_input(error, exec->where, "runs whole scenes, step after step; it cannot begin with step %d",
                           number);
    const double now = clock_seconds(), step_end = now + (double)exec->step_limit;
    if (now >= exec->end) return exec_fail(exec, error, "");
    const double until = step_end < exec->end ? step_end : exec->end;
    if (adapter_frames_left(exec->adapter) == 0 && !exec_ask(exec, begun, until, error)) return false;
    if (begun->problem->body_count != exec->bodies)
        return error_input(error, exec->where, "cannot add or remove a body in step %d", number);
    if (!adapter_read(exec->adapter, frame, until)) return exec_fail(exec, error, adapter_why(exec->adapter));
    exec->frame = number;
    return true;
}

static bool exec_solve(void *state, BegunStep *begun, Error *error) {
    Exec *exec = state;
    const ContactProblem *problem = begun->problem;
    const size_t count = (size_t)problem->body_count;
    AdapterFrame frame;
    if (!array_reserve((void **)&exec->added, &exec->added_capacity, count + 1, sizeof *exec->added) ||
        !array_reserve((void **)&exec->poses, &exec->pose_capacity, count + 1, sizeof *exec->poses))
        return error_memory(error, exec->where);
    if (!next_frame(exec, begun, &frame, error)) return false;
    for (size_t i = 0; i < count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        const float *s = frame.states + i * ADAPTER_NUMBERS;
        const bool moves = problem_body_moves(body);
        exec->poses[i] =
            moves ? (BodyPose){vec2(s[0], s[1]), s[2]} : (BodyPose){.position = body->position, .angle = body->angle};
        begun->solution->velocities[i] =
            moves ? (BodyVelocity){vec2(s[3], s[4]), s[5]} : (BodyVelocity){body->velocity, body->angular_velocity};
    }
    for (int i = 0; i < problem->contact_count; i++) begun->solution->impulses[i] = (ContactImpulse){0, 0};
    begun->poses = exec->poses;
    if (begun->step->meter != NULL) begun->step->meter->reported = frame.ns;
    return true;
}

const SteppingKind stepping_exec = {
    .description = {.name = "exec",
                    .summary = "another program, such as a real engine: exec:PROGRAM WORD...,KEY=VALUE,...",
                    .caption = "external program",
                    .settings = settings,
                    .own_settings = "",
                    .external = true,
                    .whole_scenes = true,
                    .no_push_out = true,
                    .chart = METHOD_NO_RUNS,
                    .chart_quick = METHOD_NO_RUNS,
                    .stability = METHOD_NO_RUNS},
    .create = exec_create,
    .solve = exec_solve,
    .destroy = exec_destroy};
