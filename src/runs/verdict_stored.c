/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The verdict on a stored run. Files have neither masses nor gravity, and perhaps no contacts and velocities: the first
   come from a scene or are assumed, the others are found again. */
#include "base/base.h"
#include "engine/engine.h"
#include "runs/trajectory.h"
#include "runs/verdict.h"
#include "scenes/scenes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* How many bodies a frame has: the first ones, as a watch expects. */
static bool count_bodies(const Trajectory *run, int frame, int *count, Error *error) {
    *count = 0;
    while (*count < run->bodies && trajectory_has(run, frame, *count)) ++*count;
    for (int i = *count + 1; i < run->bodies; i++)
        if (trajectory_has(run, frame, i))
            return error_input(error, run->scene, "frame %d has body %d, but not body %d: such a run has no verdict",
                               frame, i, *count);
    return true;
}

/* If a run does not state velocities: those that lead to the frame, as semi-implicit Euler moves bodies by them; in the
   first frame of a body, those that lead to the next. */
static void set_velocity(const Trajectory *run, int frame, int i, Body *body) {
    const float rate = 1 / run->dt, turn = 6.2831853f; /* some engines keep angles within one */
    const bool known = frame > 0 && trajectory_has(run, frame - 1, i);
    const int from = known ? frame - 1 : frame, to = from + 1;
    const size_t now = trajectory_at(run, frame, i), before = trajectory_at(run, from, i),
                 after = trajectory_at(run, to, i);
    body->velocity = run->velocity[now];
    body->angular_velocity = run->angular_velocity[now];
    if (!run->no_velocities) return;
    const bool moves = to < run->frames && trajectory_has(run, to, i);
    body->velocity = moves ? vec2_scale(rate, vec2_sub(run->position[after], run->position[before])) : vec2(0, 0);
    body->angular_velocity = moves ? rate * remainderf(run->angle[after] - run->angle[before], turn) : 0;
}

static void set_body(const Trajectory *run, int frame, int i, Body *body) {
    body->position = run->position[trajectory_at(run, frame, i)];
    body->angle = run->angle[trajectory_at(run, frame, i)];
    set_velocity(run, frame, i, body);
}

/* Without velocities, those of the first step tell: gravity's share, and what pushes an overlap or a skin apart. */
static bool starts_at_rest(const Trajectory *run, int i, Vec2 gravity) {
    Body body;
    const double pull = vec2_distance(gravity, vec2(0, 0)), push = 0.5 /* m/s */;
    set_body(run, 0, i, &body);
    const double speed = vec2_distance(body.velocity, vec2(0, 0));
    return run->no_velocities ? speed <= pull * (double)run->dt + push : speed == 0 && body.angular_velocity == 0;
}

Scene *trajectory_scene(const Trajectory *run, Error *error) {
    Scene *scene = calloc(1, sizeof *scene);
    if (scene != NULL) scene->bodies = calloc((size_t)run->bodies + 1, sizeof *scene->bodies);
    if (scene == NULL || scene->bodies == NULL) {
        free(scene);
        error_memory(error, run->scene);
        return NULL;
    }
    snprintf(scene->name, sizeof scene->name, "%.*s", (int)utf8_cut(run->scene, sizeof scene->name - 1), run->scene);
    scene->gravity = vec2(0, -VERDICT_GRAVITY);
    scene->bomb.present = run->bomb >= 0;
    for (int i = 0; i < run->bodies; i++) {
        const Vec2 size = run->size[i];
        const float mass = VERDICT_DENSITY * size.x * size.y;
        if (i == run->bomb && i == run->bodies - 1 && !run->fixed[i]) {
            scene->bomb.size = size;
            scene->bomb.mass.value = mass;
            break;
        }
        BodyDef *def = &scene->bodies[scene->body_count++];
        *def = (BodyDef){.size = size, .fixed = run->fixed[i], .mass = mass};
        if (trajectory_has(run, 0, i) && !run->fixed[i] && !starts_at_rest(run, i, scene->gravity))
            def->velocity = vec2(1, 0);
    }
    return scene;
}

static bool verdict_stored_fits(const Scene *scene, const Trajectory *run, const World *world, Error *error) {
    const Body *bodies = world_bodies(world);
    if (run->bodies != scene->body_count && run->bodies != world_body_count(world))
        return error_input(error, scene->name, "has %d bodies, but the run has %d", scene->body_count, run->bodies);
    for (int i = 0; i < run->bodies; i++)
        if (memcmp(&bodies[i].size, &run->size[i], sizeof *run->size) != 0 ||
            (bodies[i].inv_mass == 0) != (run->fixed[i] != 0))
            return error_input(
                error, scene->name, "is not the scene of the run: body %d is %g x %g m%s, not %g x %g m%s", i,
                (double)run->size[i].x, (double)run->size[i].y, run->fixed[i] ? ", static" : "",
                (double)bodies[i].size.x, (double)bodies[i].size.y, bodies[i].inv_mass == 0 ? ", static" : "");
    return true;
}

/* A frame as a step: its bodies get the poses of the run. */
static bool watch_frame(VerdictWatch *watch, const VerdictRun *judged, const Trajectory *run, int frame, int bomb,
                        Body *bodies, Error *error) {
    VerdictStep step = {.frame = frame, .bodies = bodies};
    if (!count_bodies(run, frame, &step.body_count, error)) return false;
    for (int i = 0; i < step.body_count; i++) set_body(run, frame, i, &bodies[i]);
    step.bomb = bomb < step.body_count ? bomb : -1;
    return frame > 0 ? verdict_watch_step(watch, &step, error)
                     : verdict_watch_begin(watch, judged, bodies, step.body_count, error);
}

static bool is_of_other_engine(const Trajectory *run) {
    const MethodDescription *method = method_describe(run->method);
    return method == NULL || method->whole_scenes;
}

static bool verdict_stored_judge(SimulateVerdict *verdict, const Trajectory *run, const RunScene *by,
                                 const World *world, Error *error) {
    const Scene *scene = by->scene;
    VerdictRun judged = verdict_run_of(scene);
    judged.skin = by->skin;
    judged.other_engine = is_of_other_engine(run);
    judged.no_energy = by->assumed && !judged.stands;
    judged.finds_contacts = true;
    const int bomb = !scene->bomb.present ? -1 : run->bomb >= 0 ? run->bomb : scene->body_count;
    const size_t size = (size_t)run->bodies * sizeof(Body);
    Body *bodies = malloc(size + 1);
    if (bodies == NULL) return error_memory(error, run->scene);
    if (size > 0) memcpy(bodies, world_bodies(world), size);
    bool ok = true;
    for (int frame = 0; ok && frame < run->frames; frame++)
        ok = watch_frame(&verdict->watch, &judged, run, frame, bomb, bodies, error);
    free(bodies);
    return ok;
}

/* What a run that ended in NaN says of itself; its frames are finite. */
static bool ended_in_nan(const Trajectory *run) {
    const char *word = verdict_name(VERDICT_NON_FINITE);
    return strncmp(run->verdict, word, strlen(word)) == 0;
}

bool simulate_verdict_of_run(SimulateVerdict *verdict, const RunScene *by, const Trajectory *run, Error *error) {
    Scene *scene = by->scene;
    *verdict = (SimulateVerdict){.scene = scene, .method = run->method};
    scene->dt = run->dt;
    scene->frames = run->frames - 1;
    scene->bomb.present &= run->bomb >= 0 || run->bodies > scene->body_count;
    World *world = scene_world(scene, error);
    const bool later = scene->bomb.present && scene->bomb.frame > 0;
    const bool ok = world != NULL && (!later || scene_add_bomb(scene, world, error)) &&
                    verdict_stored_fits(scene, run, world, error) &&
                    verdict_stored_judge(verdict, run, by, world, error);
    world_destroy(world);
    if (!ok) return false;
    Error failure = {0};
    if (ended_in_nan(run)) error_failure(&failure, FAILURE_NOT_FINITE, run->scene, "NaN or infinite");
    return simulate_verdict_end(verdict, &failure);
}
