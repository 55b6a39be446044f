/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "simulate/simulate.h"

#include "simulate/launch_check.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* A run in progress. */
typedef struct Run {
    const Scene *scene;
    World *world;
    Stepper *stepper;
} Run;

static void run_end(Run *run) {
    stepper_destroy(run->stepper);
    world_destroy(run->world);
}

static bool run_begin(Run *run, const Scene *scene, const Method *method, Error *error) {
    const Launch own = launch_of(scene);
    if (scene->bomb.frame == 0 && !launches_check(scene, &own, 1, error)) return false;
    *run = (Run){.scene = scene, .world = scene_world(scene, error)};
    if (run->world != NULL) run->stepper = stepper_create(method, scene, error);
    if (run->stepper != NULL) return true;
    run_end(run);
    return false;
}

/* A method may have scattered the bodies: the scene is refused only if the bomb would start inside one in the engine's
   run, too. */
static bool add_bomb(const Scene *scene, World *world, Error *error) {
    const Launch own = launch_of(scene);
    return (launch_is_free(scene, world) || launches_check(scene, &own, 1, error)) &&
           scene_add_bomb(scene, world, error);
}

/* The bomb appears, and the last body disappears, after the steps that the scene sets. */
static bool update_bodies(const Scene *scene, World *world, int frame, Error *error) {
    if (frame == scene->last_body_until) world_remove_last_body(world);
    return !scene->bomb.present || scene->bomb.frame != frame || add_bomb(scene, world, error);
}

bool simulate_step(Stepper *stepper, World *world, const Step *step, Error *error) {
    if (stepper_step(stepper, world, step, error)) return update_bodies(step->scene, world, step->frame, error);
    size_t length = strlen(error->message);
    snprintf(error->message + length, sizeof error->message - length, ", in step %d of scene %s", step->frame,
             step->scene->name);
    return false;
}

static bool run_step(Run *run, int frame, Error *error) {
    return simulate_step(run->stepper, run->world, &(Step){.scene = run->scene, .frame = frame}, error);
}

bool simulate_observed(const Scene *scene, const Method *method, const StepObserver *observer, Error *error) {
    Run run;
    if (!run_begin(&run, scene, method, error)) return false;
    bool ok = true;
    for (int frame = 1; ok && frame <= scene->frames; frame++)
        ok = run_step(&run, frame, error) && observer->observe(observer->context, frame, run.world, error);
    run_end(&run);
    return ok;
}

static void record_bodies(Trajectory *trajectory, int frame, const World *world) {
    const Body *bodies = world_bodies(world);
    size_t row = (size_t)frame * (size_t)trajectory->bodies;
    for (int i = 0; i < world_body_count(world); i++) {
        trajectory->position[row + (size_t)i] = bodies[i].position;
        trajectory->angle[row + (size_t)i] = bodies[i].angle;
        trajectory->velocity[row + (size_t)i] = bodies[i].velocity;
        trajectory->angular_velocity[row + (size_t)i] = bodies[i].angular_velocity;
    }
}

static bool record_contacts(Trajectory *trajectory, int frame, const World *world, Error *error) {
    const ContactProblem *problem = world_problem(world);
    const ContactSolution *solution = world_solution(world);
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        TrajectoryContact record = {.a = contact->a,
                                    .b = contact->b,
                                    .feature = contact->feature,
                                    .point = contact->position,
                                    .normal = contact->normal,
                                    .normal_impulse = solution->impulses[i].normal,
                                    .tangent_impulse = solution->impulses[i].tangent};
        if (!trajectory_add_contact(trajectory, frame, &record, error)) return false;
    }
    return true;
}

static void describe_body(Trajectory *trajectory, int body, const BodyDef *def) {
    trajectory->size[body] = def->size;
    trajectory->fixed[body] = def->fixed;
}

/* A trajectory without frames yet. */
static Trajectory *trajectory_of_scene(const Scene *scene, const Method *method, Error *error) {
    bool bomb = scene->bomb.present && scene->bomb.frame <= scene->frames;
    int64_t states = ((int64_t)scene->frames + 1) * (scene->body_count + bomb);
    if (states > SIMULATE_MAX_STATES) {
        error_input(error, scene->name, "%d frames of %d bodies are too many to record; at most %d states of a body",
                    scene->frames, scene->body_count + bomb, SIMULATE_MAX_STATES);
        return NULL;
    }
    Trajectory *trajectory = trajectory_create(scene->frames + 1, scene->body_count + bomb, error);
    if (trajectory == NULL) return NULL;
    snprintf(trajectory->scene, sizeof trajectory->scene, "%s", scene->name);
    snprintf(trajectory->method, sizeof trajectory->method, "%s", method->text);
    trajectory->scene_hash = scene_hash(scene);
    trajectory->dt = scene->dt;
    trajectory->camera_center = scene->camera_center;
    trajectory->camera_size = scene->camera_size;
    for (int i = 0; i < scene->body_count; i++) describe_body(trajectory, i, &scene->bodies[i]);
    trajectory->bomb = bomb ? scene->body_count : -1;
    if (bomb) describe_body(trajectory, trajectory->bomb, &scene->bomb.body);
    return trajectory;
}

/* Nobody observes if there is no observer. */
static bool observe(const StepObserver *observer, int frame, const World *world, Error *error) {
    return observer == NULL || observer->observe(observer->context, frame, world, error);
}

static bool record(Run *run, Trajectory *trajectory, NetworkFallbacks *sum, const StepObserver *observer,
                   const Progress *progress, Error *error) {
    record_bodies(trajectory, 0, run->world);
    for (int frame = 1; frame <= run->scene->frames; frame++) {
        if (!run_step(run, frame, error) || !record_contacts(trajectory, frame, run->world, error)) return false;
        record_bodies(trajectory, frame, run->world);
        if (!observe(observer, frame, run->world, error)) return false;
        network_fallbacks_add(sum, &world_solution(run->world)->fallbacks);
        if (!progress_report(progress, frame, run->scene->frames))
            return error_input(error, run->scene->name, "stopped after step %d of %d", frame, run->scene->frames);
    }
    trajectory_end_contacts(trajectory);
    return true;
}

Trajectory *simulate_counting(const Scene *scene, const Method *method, NetworkFallbacks *sum,
                              const StepObserver *observer, const Progress *progress, Error *error) {
    Run run;
    if (!run_begin(&run, scene, method, error)) return NULL;
    Trajectory *trajectory = trajectory_of_scene(scene, method, error);
    if (trajectory != NULL && !record(&run, trajectory, sum, observer, progress, error)) {
        trajectory_destroy(trajectory);
        trajectory = NULL;
    }
    run_end(&run);
    return trajectory;
}

Trajectory *simulate(const Scene *scene, const Method *method, const Progress *progress, Error *error) {
    NetworkFallbacks unused = {0};
    return simulate_counting(scene, method, &unused, NULL, progress, error);
}
