/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Programs of others as methods, behind an adapter of some lines (scenes/engines/README.md).

   `exec`: another program steps the scene, a real engine. It gets the bodies once, and is asked for several steps at a
   time, so that a round trip costs less than a step. Its poses and velocities become those of the world; contacts are
   those that collision detection finds between its poses, without impulses. So it runs whole scenes from the start, not
   single steps of others.

   `exec-solver`: another program solves the contact problem of each step, a solver or a network. It gets bodies and
   contacts of the step, and answers with impulses. They are taken as they are, also where they pull or leave the
   friction cone: scores tell. The velocities that follow conserve momentum whatever it answers. A step without contacts
   asks nothing.

   Both fail where the program does: it ends, is silent for too long, or answers what cannot be. */
#include "base/base.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "methods/adapter.h"
#include "methods/methods.h"
#include "methods/sweeps.h"
#include "scenes/scenes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A program in use. */
typedef struct Program {
    const MethodDescription *method;
    Settings settings;
    char where[METHOD_TEXT_SIZE + sizeof "exec-solver:"]; /* of errors */
    Adapter *adapter;                                     /* NULL: none yet, or it has failed */
} Program;

static void name_program(Program *program, const MethodDescription *method, const Settings *chosen) {
    program->method = method;
    program->settings = *chosen;
    snprintf(program->where, sizeof program->where, "%s:%s", method->name, settings_get(chosen, "program"));
}

/* A program that has failed is started again by the next run. */
static bool fail(Program *program, Error *error, const char *why) {
    error_failure(error, FAILURE_ADAPTER, program->where, "adapter failed: %s", why);
    program_failed(error->message);
    adapter_end(program->adapter);
    program->adapter = NULL;
    return false;
}

static bool start(Program *program, double seconds, Error *error) {
    char why[TALK_WHY_SIZE];
    program->adapter = adapter_take(program->method, &program->settings, seconds, why, sizeof why);
    return program->adapter != NULL || fail(program, error, why);
}

/* What a program may compute ahead of the frame that is read: enough to hide the round trip, and it stays in a pipe. */
enum { AHEAD_BYTES = 1 << 16 };

typedef struct Exec {
    float step_limit, run_limit; /* s */
    float skin;                  /* m; for the verdict */
    Program program;
    int bodies, frame; /* of the program's scene; the last frame read */
    double end;        /* of the run, by clock_seconds() */
    BodyDef *added;
    BodyPose *poses;
    size_t added_capacity, pose_capacity;
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
    if (exec != NULL) name_program(&exec->program, &stepping_exec.description, chosen);
    return exec;
}

/* The rest of an answer is read, so that the program can serve the next run. */
static void leave(Exec *exec) {
    AdapterFrame frame;
    const double until = clock_seconds() + (double)exec->step_limit;
    Adapter *adapter = exec->program.adapter;
    bool works = adapter != NULL;
    while (works && adapter_frames_left(adapter) > 0) works = adapter_read(adapter, &frame, until);
    (works ? adapter_give : adapter_end)(adapter);
    exec->program.adapter = NULL;
}

static void exec_destroy(void *state) {
    Exec *exec = state;
    leave(exec);
    free(exec->added);
    free(exec->poses);
    free(exec);
}

static bool exec_fail(Exec *exec, Error *error, const char *why) {
    return fail(&exec->program, error,
                clock_seconds() >= exec->end ? "the run has taken longer than its run_limit" : why);
}

/* The next steps, with the bodies that the world has now. */
static bool exec_ask(Exec *exec, const BegunStep *begun, double until, Error *error) {
    const Scene *scene = begun->step->scene;
    const int count = begun->problem->body_count, before = exec->bodies;
    const int ahead = AHEAD_BYTES / ((int)sizeof(float) * ADAPTER_NUMBERS * (count + 1)) + 1;
    /* Not beyond the end of the scene, nor a step that adds or removes a body. */
    const int events[] = {scene->frames, scene->bomb.present ? scene->bomb.frame : 0, scene->last_body_until};
    int steps = ahead < ADAPTER_STEPS_MAX ? ahead : ADAPTER_STEPS_MAX;
    for (int i = 0; i < 3; i++)
        if (events[i] > exec->frame && events[i] - exec->frame < steps) steps = events[i] - exec->frame;
    const AdapterRequest request = {.frame = exec->frame,
                                    .steps = steps,
                                    .added = count > before ? count - before : 0,
                                    .removed = count < before ? before - count : 0,
                                    .add = exec->added,
                                    .gravity = scene->gravity,
                                    .dt = scene->dt,
                                    .iterations = scene->iterations};
    for (int i = 0; i < request.added; i++)
        exec->added[i] = before + i < scene->body_count ? scene->bodies[before + i] : scene_bomb_body(scene);
    exec->bodies = count;
    Adapter *adapter = exec->program.adapter;
    return adapter_ask(adapter, &request, until) || exec_fail(exec, error, adapter->why);
}

static bool next_frame(Exec *exec, const BegunStep *begun, AdapterFrame *frame, Error *error) {
    const int number = begun->step->frame;
    if (number == 1) {
        leave(exec);
        exec->end = clock_seconds() + (double)exec->run_limit;
        exec->bodies = exec->frame = 0;
        if (!start(&exec->program, (double)exec->step_limit, error)) return false;
    }
    Adapter *adapter = exec->program.adapter;
    if (adapter == NULL || number != exec->frame + 1)
        return error_input(error, exec->program.where,
                           "runs whole scenes, step after step; it cannot begin with step %d", number);
    const double now = clock_seconds(), step_end = now + (double)exec->step_limit;
    if (now >= exec->end) return exec_fail(exec, error, "");
    const double until = step_end < exec->end ? step_end : exec->end;
    if (adapter_frames_left(adapter) == 0 && !exec_ask(exec, begun, until, error)) return false;
    if (begun->problem->body_count != exec->bodies)
        return error_input(error, exec->program.where, "cannot add or remove a body in step %d", number);
    if (!adapter_read(adapter, frame, until)) return exec_fail(exec, error, adapter->why);
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
        return error_memory(error, exec->program.where);
    if (!next_frame(exec, begun, &frame, error)) return false;
    for (size_t i = 0; i < count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        const float *s = frame.numbers + i * ADAPTER_NUMBERS;
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

/* The contact problem of each step. */

typedef struct ExecSolver {
    float step_limit; /* s */
    Program program;
    int64_t ns; /* that the last solve took, as the program says */
} ExecSolver;

static const SettingSpec solver_settings[] = {{"name", "what pictures call it (default: the program)", SETTING_OWN},
                                              {"step_limit", "seconds that its start or a step may take (default: 10)",
                                               SETTING_FLOAT(ExecSolver, step_limit, 0.01f, 86400)},
                                              {"*", "all other settings are passed to the program", SETTING_OWN},
                                              {0}};

static void *exec_solver_create(const Settings *chosen, Error *error) {
    static const ExecSolver standard = {.step_limit = 10};
    ExecSolver *solver = settings_make(chosen, solver_settings, &standard, sizeof standard, "exec-solver", error);
    if (solver != NULL) name_program(&solver->program, &solver_exec_solver.description, chosen);
    return solver;
}

static void exec_solver_destroy(void *state) {
    ExecSolver *solver = state;
    adapter_give(solver->program.adapter);
    free(solver);
}

static bool is_finite(const BodyVelocity *velocity) {
    return isfinite(velocity->linear.x) && isfinite(velocity->linear.y) && isfinite(velocity->angular);
}

static bool exec_solver_solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    ExecSolver *solver = state;
    solver->ns = 0;
    contact_solution_begin(problem, solution);
    if (problem->contact_count == 0) return true;
    const double limit = (double)solver->step_limit;
    if (solver->program.adapter == NULL && !start(&solver->program, limit, error)) return false;
    Adapter *adapter = solver->program.adapter;
    const double until = clock_seconds() + limit;
    AdapterFrame frame;
    if (!adapter_ask(adapter, &(AdapterRequest){.problem = problem}, until) || !adapter_read(adapter, &frame, until))
        return fail(&solver->program, error, adapter->why);
    solver->ns = frame.ns;
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        ContactImpulse *impulse = &solution->impulses[i];
        *impulse = (ContactImpulse){frame.numbers[2 * i], frame.numbers[2 * i + 1]};
        contact_push(solution->velocities, contact, problem->bodies, *impulse);
        if (is_finite(&solution->velocities[contact->a]) && is_finite(&solution->velocities[contact->b])) continue;
        char why[TALK_WHY_SIZE];
        snprintf(why, sizeof why, "contact %d: its impulse (%g, %g) N s makes a velocity infinite", i,
                 (double)impulse->normal, (double)impulse->tangent);
        return fail(&solver->program, error, why);
    }
    return true;
}

static int64_t reported(const void *state) { return ((const ExecSolver *)state)->ns; }

const ContactSolverKind solver_exec_solver = {
    .description = {.name = "exec-solver",
                    .summary = "another program solves each step's contacts: exec-solver:PROGRAM WORD...,KEY=VALUE,...",
                    .caption = "external solver",
                    .settings = solver_settings,
                    .own_settings = "",
                    .external = true,
                    .chart = METHOD_NO_RUNS,
                    .chart_quick = METHOD_NO_RUNS,
                    .stability = METHOD_NO_RUNS},
    .create = exec_solver_create,
    .solve = exec_solver_solve,
    .destroy = exec_solver_destroy,
    .reported = reported};
