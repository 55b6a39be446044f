/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Examples of gns: frames of recorded launches, with noise, and the accelerations that correct it. */
#include "learning/gns_examples.h"

#include "base/base.h"
#include "base/machine.h"
#include "base/random.h"
#include "engine/engine.h"
#include "learning/launches.h"
#include "methods/gns_graph.h"
#include "methods/methods.h"
#include "nets/kinds.h"
#include "scenes/scenes.h"

#include <stdlib.h>
#include <string.h>

/* Half of the examples are taken from these frames around the bomb's first touch, and a quarter from the first frames,
   where boxes begin to fall. One in FLIGHT_ONE_IN is a box alone in free flight. Otherwise nearly every slow box would
   be one at rest, and the network would take a box that hangs in the air for one that is held. */
enum { BEFORE_TOUCH = 3, AFTER_TOUCH = 120, FIRST_FRAMES = 6, FLIGHT_ONE_IN = 8, TOURNAMENT = 3 };

/* Of boxes in free flight: height above the ground, up to that of the bomb's launch, speed up to the bomb's, spin. The
   square of a uniform number makes slow ones frequent. */
static const float flight_low = 0.8f, flight_height = 15, flight_speed = 20, flight_spin = 5; /* m, m, m/s, rad/s */

static const float off_flight = 0.01f;    /* m: a bomb that is this far off its free flight has touched */
static const float whole_box = 0.3f;      /* s: displacement of whole boxes, of each m/s of noise */
static const float position_share = 0.1f; /* of a position's noise, that a step corrects */
static const float counting = 1.3f;       /* lengths of a box from the middle of an example: these count */

void gns_examples_free(GnsExamples *examples) {
    for (int i = 0; i < examples->count; i++) {
        GnsRuns *runs = &examples->scenes[i];
        scene_destroy(runs->scene);
        launch_runs_free(&runs->runs);
        free(runs->touch);
        free(runs->ground);
        free(runs->moving);
    }
    *examples = (GnsExamples){.count = 0};
}

/* The first frame whose next is not free flight. */
static int find_touch(const GnsRuns *runs, int launch) {
    const int bomb = runs->runs.bodies - 1, last = runs->runs.frames - 1;
    const Scene *scene = runs->scene;
    const Vec2 fall = vec2_scale(scene->dt * scene->dt, scene->gravity);
    for (int frame = scene->bomb.frame + 1; frame < last; frame++) {
        const Vec2 before = launch_runs_frame(&runs->runs, launch, frame - 1)[bomb].position;
        const Vec2 now = launch_runs_frame(&runs->runs, launch, frame)[bomb].position;
        const Vec2 next = launch_runs_frame(&runs->runs, launch, frame + 1)[bomb].position;
        const Vec2 off = vec2_sub(vec2_sub(next, now), vec2_add(vec2_sub(now, before), fall));
        if (vec2_dot(off, off) > off_flight * off_flight) return frame;
    }
    return last;
}

static bool list_bodies(GnsRuns *runs, Error *error) {
    const Scene *scene = runs->scene;
    runs->ground = calloc((size_t)scene->body_count + 1, sizeof *runs->ground);
    runs->moving = calloc((size_t)scene->body_count + 1, sizeof *runs->moving);
    runs->touch = calloc((size_t)runs->runs.count + 1, sizeof *runs->touch);
    if (runs->ground == NULL || runs->moving == NULL || runs->touch == NULL) return error_memory(error, scene->name);
    for (int i = 0; i < scene->body_count; i++) {
        const BodyDef *body = &scene->bodies[i];
        if (body->fixed)
            runs->ground[runs->ground_count++] = box_make(body->position, body->size, body->angle);
        else
            runs->moving[runs->moving_count++] = i;
    }
    for (int i = 0; i < runs->runs.count; i++) runs->touch[i] = find_touch(runs, i);
    return true;
}

bool gns_examples_add(GnsExamples *examples, Scene *scene, const Method *method, int launches, const Progress *progress,
                      Error *error) {
    GnsRuns *runs = &examples->scenes[examples->count++];
    *runs = (GnsRuns){.scene = scene};
    Launch *list = calloc((size_t)launches, sizeof *list);
    const bool ok = (list != NULL || error_memory(error, scene->name)) &&
                    launches_for_training(scene, launches, list, error) &&
                    launch_runs_record(&runs->runs, scene, method, list, launches, progress, error);
    free(list);
    return ok && list_bodies(runs, error);
}

void gns_example_free(GnsExample *example) {
    free(example->arrays.memory);
    gns_graph_free(&example->graph);
    *example = (GnsExample){.from = NULL};
}

static bool reserve(GnsExample *example, int bodies) {
    const size_t count = (size_t)bodies * BOX_PARTICLES;
    GnsParticles *particles = &example->particles;
    return ARRAY_BLOCK_RESERVE(&example->arrays, ARRAY_PART(particles->body, bodies),
                               ARRAY_PART(particles->position, count), ARRAY_PART(particles->velocity, count),
                               ARRAY_PART(example->targets, count * GNS_OUTPUTS), ARRAY_PART(example->counts, bodies));
}

static int below(uint64_t *random, int count) { return (int)(random_unit(random) * count); }

/* Nearly normal, of deviation 1: four uniform numbers, each of variance 1/12. */
static float normal(uint64_t *random) {
    double sum = -2;
    for (int i = 0; i < 4; i++) sum += random_unit(random);
    return (float)(sum * 0x1.bb67ae8584caap0); /* sqrt(3) */
}

static bool is_bomb(const GnsRuns *runs, int body) { return body == runs->runs.bodies - 1; }

static BodyDef definition(const GnsRuns *runs, int launch, int body) {
    if (!is_bomb(runs, body)) return runs->scene->bodies[body];
    const Scene launched = launch_scene(runs->scene, &runs->runs.launches[launch]);
    return scene_bomb_body(&launched);
}

/* Before it exists, a body flies with its start velocity. */
static BodyPose pose_at(const GnsRuns *runs, int launch, int body, int frame) {
    const int start = is_bomb(runs, body) ? runs->scene->bomb.frame : 0;
    if (frame >= start) return launch_runs_frame(&runs->runs, launch, frame)[body];
    BodyPose pose = launch_runs_frame(&runs->runs, launch, start)[body];
    const BodyDef own = definition(runs, launch, body);
    const float back = (float)(frame - start) * runs->scene->dt;
    pose.position = vec2_add(pose.position, vec2_scale(back, own.velocity));
    pose.angle += back * own.angular_velocity;
    return pose;
}

/* Particles and their past of body i, which had these poses in the last frames. */
static void fill_particles(GnsExample *example, int i, const BodyPose poses[GNS_HISTORY + 1], float dt) {
    Vec2 before[BOX_PARTICLES], *now = example->particles.position + (ptrdiff_t)i * BOX_PARTICLES;
    Vec2(*velocity)[GNS_HISTORY] = example->particles.velocity + (ptrdiff_t)i * BOX_PARTICLES;
    const Vec2 size = example->particles.body[i].size;
    box_particles_place(now, size, &poses[0]);
    for (int k = 0; k < GNS_HISTORY; k++) {
        memcpy(before, now, sizeof before);
        box_particles_place(now, size, &poses[k + 1]);
        for (int p = 0; p < BOX_PARTICLES; p++) velocity[p][k] = vec2_scale(1.0f / dt, vec2_sub(now[p], before[p]));
    }
}

/* Targets of a body that is filled, and then its noise; whole: 1 if it is displaced as a whole, too, else 0. */
static void fill_target(GnsExample *example, int i, const BodyPose *pose, float noise, float whole, uint64_t *random) {
    const GnsRuns *runs = example->from;
    const float dt = runs->scene->dt, step = noise / sqrtf(GNS_HISTORY);
    Vec2 next[BOX_PARTICLES];
    box_particles_place(next, example->particles.body[i].size, pose);
    const float far = whole * noise * whole_box, away_x = far * normal(random), away_y = far * normal(random);
    for (int p = 0; p < BOX_PARTICLES; p++) {
        const int at = i * BOX_PARTICLES + p;
        Vec2 *position = &example->particles.position[at], *velocity = example->particles.velocity[at];
        const Vec2 true_next = vec2_scale(1.0f / dt, vec2_sub(next[p], *position));
        Vec2 walk = vec2(0, 0), moved = vec2(away_x, away_y);
        for (int k = 0; k < GNS_HISTORY; k++) {
            const float x = step * normal(random), y = step * normal(random);
            walk = vec2_add(walk, vec2(x, y));
            moved = vec2_add(moved, vec2_scale(dt, walk));
            velocity[k] = vec2_add(velocity[k], walk);
        }
        *position = vec2_add(*position, moved);
        const Vec2 wanted = vec2_sub(true_next, vec2_scale(position_share / dt, moved));
        const Vec2 change = vec2_scale(1.0f / dt, vec2_sub(wanted, velocity[GNS_HISTORY - 1]));
        const Vec2 target = vec2_sub(change, runs->scene->gravity);
        example->targets[2 * at] = target.x;
        example->targets[2 * at + 1] = target.y;
    }
}

static int body_of(const GnsRuns *runs, int i) {
    return i < runs->moving_count ? runs->moving[i] : runs->runs.bodies - 1;
}

/* The most active of a few, so that examples show more than boxes at rest; tries: 1 where rest is to be shown, too. */
static int choose_middle(const GnsRuns *runs, int launch, int frame, int count, int tries, uint64_t *random) {
    int best = -1;
    float most = -1;
    for (int i = 0; i < tries; i++) {
        const int body = body_of(runs, below(random, count));
        const Vec2 before = pose_at(runs, launch, body, frame - 1).position,
                   at = pose_at(runs, launch, body, frame).position,
                   next = pose_at(runs, launch, body, frame + 1).position;
        const Vec2 off = vec2_sub(vec2_sub(next, at), vec2_sub(at, before));
        const float active = vec2_dot(off, off); /* how far it is off its free flight */
        if (!(active > most)) continue;
        most = active;
        best = body;
    }
    return best >= 0 ? best : body_of(runs, 0);
}

/* The boxes nearest to the middle, in the order of their distance; returns how many. */
static int choose_bodies(const GnsRuns *runs, int launch, int frame, int count, int middle, int chosen[GNS_CROP],
                         float distances[GNS_CROP]) {
    const Vec2 at = pose_at(runs, launch, middle, frame).position;
    int used = 0;
    for (int i = 0; i < count; i++) {
        const int body = body_of(runs, i);
        const Vec2 away = vec2_sub(pose_at(runs, launch, body, frame).position, at);
        const float distance = vec2_dot(away, away);
        if (used == GNS_CROP && !(distance < distances[used - 1])) continue;
        int place = used < GNS_CROP ? used++ : used - 1;
        for (; place > 0 && distance < distances[place - 1]; place--) {
            distances[place] = distances[place - 1];
            chosen[place] = chosen[place - 1];
        }
        distances[place] = distance;
        chosen[place] = body;
    }
    return used;
}

/* 0 to 1, mostly small. */
static float often_small(uint64_t *random) {
    const double x = random_unit(random);
    return (float)(x * x);
}

static float either_sign(uint64_t *random) { return below(random, 2) == 0 ? -1.0f : 1.0f; }

/* A box of the scene, or the bomb, alone, with a past of free flight or of constant velocity, as at the start of a
   run. */
static void fill_flight(GnsExample *example, int launch, float noise, uint64_t *random) {
    const GnsRuns *runs = example->from;
    const int body = body_of(runs, below(random, runs->moving_count + 1));
    const BodyDef own = definition(runs, launch, body);
    const float dt = runs->scene->dt;
    const float x = either_sign(random) * flight_speed * often_small(random);
    const float y = either_sign(random) * flight_speed * often_small(random);
    const float spin = either_sign(random) * flight_spin * often_small(random);
    const float height = flight_low + flight_height * (float)random_unit(random);
    const bool falls = below(random, 2) == 0;
    BodyPose poses[GNS_HISTORY + 2] = {{{x, height}, (float)(6.3 * random_unit(random))}};
    Vec2 velocity = vec2(x, y);
    for (int k = 1; k <= GNS_HISTORY + 1; k++) {
        if (falls || k > GNS_HISTORY) velocity = vec2_add(velocity, vec2_scale(dt, runs->scene->gravity));
        poses[k].position = vec2_add(poses[k - 1].position, vec2_scale(dt, velocity));
        poses[k].angle = poses[k - 1].angle + dt * spin;
    }
    example->particles.body[0] = (GnsBody){own.size, own.mass, is_bomb(runs, body)};
    example->counts[0] = 1;
    fill_particles(example, 0, poses, dt);
    fill_target(example, 0, &poses[GNS_HISTORY + 1], noise, 0, random);
}

bool gns_example_make(GnsExample *example, const GnsExamples *examples, uint64_t number) {
    uint64_t random = examples->seed + number * UINT64_C(0x632be59bd9b4e019);
    const GnsRuns *runs = example->from = &examples->scenes[below(&random, examples->count)];
    const int launch = below(&random, runs->runs.count), last = runs->runs.frames - 2, kind = below(&random, 4);
    int frame = below(&random, kind == 0 ? FIRST_FRAMES : last + 1);
    if (kind >= 2) frame = runs->touch[launch] - BEFORE_TOUCH + below(&random, AFTER_TOUCH);
    frame = frame < 0 ? 0 : frame > last ? last : frame;
    if (below(&random, FLIGHT_ONE_IN) == 0) {
        if (!reserve(example, 1)) return false;
        example->particles.bodies = 1;
        fill_flight(example, launch, examples->noise, &random);
        return true;
    }
    const int count = runs->moving_count + (frame >= runs->scene->bomb.frame ? 1 : 0);
    const int middle = choose_middle(runs, launch, frame, count, kind == 1 ? 1 : TOURNAMENT, &random);
    int chosen[GNS_CROP];
    float distances[GNS_CROP];
    const int bodies = choose_bodies(runs, launch, frame, count, middle, chosen, distances);
    const Vec2 size = definition(runs, launch, middle).size;
    const float reach = counting * (size.x > size.y ? size.x : size.y);
    if (!reserve(example, bodies)) return false;
    const float whole = (float)below(&random, 2);
    example->particles.bodies = bodies;
    for (int i = 0; i < bodies; i++) {
        const BodyDef own = definition(runs, launch, chosen[i]);
        BodyPose poses[GNS_HISTORY + 1];
        example->particles.body[i] = (GnsBody){own.size, own.mass, is_bomb(runs, chosen[i])};
        for (int k = 0; k <= GNS_HISTORY; k++) poses[k] = pose_at(runs, launch, chosen[i], frame - GNS_HISTORY + k);
        fill_particles(example, i, poses, runs->scene->dt);
        const BodyPose next = pose_at(runs, launch, chosen[i], frame + 1);
        fill_target(example, i, &next, examples->noise, whole, &random);
        example->counts[i] = bodies == count || distances[i] <= reach * reach ? 1.0f : 0.0f;
    }
    return true;
}
