/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/figures/engine_run.h"

#include "pair/pair.h"

bool engine_run_begin(EngineRun *run, const Scene *launched, Error *error) {
    *run = (EngineRun){.scene = launched, .tracker = {.impact_frames = launched->bomb.impact_frames}};
    Method engine;
    if (!method_parse(&engine, "engine", error)) return false;
    run->world = scene_world(launched, error);
    if (run->world != NULL) run->stepper = stepper_create(&engine, launched, error);
    if (run->stepper != NULL) return true;
    world_destroy(run->world);
    return false;
}

void engine_run_end(EngineRun *run) {
    stepper_destroy(run->stepper);
    world_destroy(run->world);
}

bool engine_run_step(EngineRun *run, Error *error) {
    const Step step = {.scene = run->scene, .frame = run->frame + 1};
    if (!simulate_step(run->stepper, run->world, &step, error)) return false;
    run->frame++;
    phase_next(&run->tracker, world_problem(run->world), run->frame);
    return true;
}

bool engine_run_to_touch(EngineRun *run, Error *error) {
    while (run->tracker.touch == 0) {
        if (run->frame == run->scene->frames)
            return error_input(error, run->scene->name, "the bomb touches no box in %d steps", run->frame);
        if (!engine_run_step(run, error)) return false;
    }
    return true;
}

Box engine_run_box(const EngineRun *run, int body) {
    const ProblemBody *of = &world_problem(run->world)->bodies[body];
    return box_make(of->position, of->size, of->angle);
}

int next_pair(const ContactProblem *problem, int first) {
    return first < 0 ? 0 : first + pair_contact_count(problem, first);
}
