/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training of gns: examples from frames of recorded launches, with noise, and the accelerations that correct it; the
   loss of a batch on all threads, first weights and units, steps and scores. */
#include "learning/gns_training.h"

#include "base/base.h"
#include "base/machine.h"
#include "base/random.h"
#include "engine/engine.h"
#include "learning/gns_backward.h"
#include "learning/launches.h"
#include "learning/learning.h"
#include "methods/gns_graph.h"
#include "methods/methods.h"
#include "nets/kinds.h"
#include "scenes/scenes.h"

#include <omp.h>
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

enum {
    EPOCH = 250,           /* gradient steps between two reports */
    SCALE_EXAMPLES = 2000, /* that set the units */
    HELD_OUT_BATCHES = 64,
    SCORES = 10
};

/* The method whose runs are recorded: they come from nearly converged steps, as those of playback. */
static const char teacher[] = "momentum:k=30";

/* Beyond this error, in units of the acceleration, the loss is linear (Huber), so that a hit does not outweigh all
   else. */
static const float knee = 1.0f;

static const double slope_max = 1; /* of a batch */
static const double record_share = 0.1;

/* Of one thread. */
typedef struct Worker {
    GnsExample example;
    GnsPass pass;
    GnsBackward back;
    float *slopes; /* [particles, GNS_OUTPUTS] of the loss */
    size_t slope_capacity;
} Worker;

typedef struct Trainer {
    const GnsTraining *training;
    GnsNet *net;                    /* its parameters are those of a pass */
    GnsExamples examples, held_out; /* held_out: the same runs, other examples */
    int threads;
    Worker *workers;   /* [threads] */
    double *slopes;    /* [parameters] of the batch's mean loss; the block of these arrays */
    double *losses;    /* [batch] */
    float *transposed; /* [parameters] */
    float *gradients;  /* [batch, parameters] */
    Adam adam;
    ProgressStage stage;
    Progress progress; /* of the stage */
} Trainer;

static bool run_example(Trainer *trainer, Worker *worker, const GnsExamples *examples, uint64_t number, double *loss,
                        float *gradient) {
    const GnsNet *net = trainer->net;
    GnsExample *example = &worker->example;
    if (!gns_example_make(example, examples, number) ||
        !gns_graph_build(&example->graph, &example->particles, example->from->ground, example->from->ground_count,
                         &net->scales) ||
        !array_reserve((void **)&worker->slopes, &worker->slope_capacity,
                       (size_t)gns_particle_count(&example->particles), GNS_OUTPUTS * sizeof *worker->slopes) ||
        !gns_forward(&worker->pass, &net->layout, net->parameters, &example->graph))
        return false;
    /* The mean over particles that count of the squared error, in units of the net's acceleration. */
    int count = 0;
    for (int i = 0; i < example->particles.bodies; i++) count += example->counts[i] > 0 ? BOX_PARTICLES : 0;
    const float share = 1.0f / (float)(count > 0 ? count : 1);
    *loss = 0;
    for (int i = 0; i < GNS_OUTPUTS * gns_particle_count(&example->particles); i++) {
        const float by = example->counts[i / (GNS_OUTPUTS * BOX_PARTICLES)] * share;
        const float off = worker->pass.outputs[i] - example->targets[i] / net->scales.acceleration, size = fabsf(off);
        *loss += (double)by * (double)(size < knee ? off * off : knee * (2 * size - knee));
        worker->slopes[i] = by * 2 * (size < knee ? off : copysignf(knee, off));
    }
    return gradient == NULL || gns_backward(&worker->back, &worker->pass, &net->layout, net->parameters,
                                            trainer->transposed, &example->graph, worker->slopes, gradient);
}

/* The mean loss of batch `number` of the examples, and, if `back`, its gradient in trainer->slopes; the same bits for
   any number of threads. */
static bool run_batch(Trainer *trainer, const GnsExamples *examples, uint64_t number, bool back, double *loss,
                      Error *error) {
    const ptrdiff_t count = trainer->net->layout.parameters;
    const int batch = trainer->training->batch;
    bool ok = true;
    if (back) gns_transpose(&trainer->net->layout, trainer->net->parameters, trainer->transposed);
#pragma omp parallel for schedule(dynamic, 1) reduction(&& : ok) num_threads(trainer->threads)
    for (int i = 0; i < batch; i++) {
        float *gradient = back ? trainer->gradients + i * count : NULL;
        if (back) memset(gradient, 0, (size_t)count * sizeof *gradient);
        const bool done = run_example(trainer, &trainer->workers[omp_get_thread_num()], examples,
                                      number * (uint64_t)batch + (uint64_t)i, &trainer->losses[i], gradient);
        ok = ok && done;
    }
    if (!ok) return error_memory(error, "gns");
    if (back) memset(trainer->slopes, 0, (size_t)count * sizeof *trainer->slopes);
    for (int i = 0; back && i < batch; i++)
        for (int k = 0; k < count; k++) trainer->slopes[k] += (double)trainer->gradients[i * count + k] / batch;
    *loss = 0;
    for (int i = 0; i < batch; i++) *loss += trainer->losses[i] / batch;
    return true;
}

/* Biases 0, gains 1. */
static void first_weights(double *weights, const GnsMlp *mlp, uint64_t *random) {
    const int widths[4] = {mlp->inputs, mlp->width, mlp->width, mlp->outputs};
    double *at = weights + mlp->weights[0];
    for (int l = 0; l < 3; l++) at = weights_of_layer(at, widths[l], widths[l + 1], 1, random);
    for (int i = 0; mlp->gain >= 0 && i < mlp->outputs; i++) weights[mlp->gain + i] = 1;
}

/* The units of inputs and outputs, from examples. */
static bool find_scales(const GnsExamples *examples, float radius, GnsScales *scales, Error *error) {
    GnsExample example = {.from = NULL};
    double velocities = 0, accelerations = 0,
           count = 0; /* squares; sizes, as squares follow the few hits; of numbers */
    float fastest = 0, strongest = 0;
    bool ok = true;
    for (uint64_t e = 0; ok && e < SCALE_EXAMPLES; e++) {
        ok = gns_example_make(&example, examples, e);
        for (int i = 0; ok && i < gns_particle_count(&example.particles); i++) {
            const Vec2 velocity = example.particles.velocity[i][GNS_HISTORY - 1];
            const float *target = example.targets + (ptrdiff_t)GNS_OUTPUTS * i;
            velocities += (double)vec2_dot(velocity, velocity);
            accelerations += fabs((double)target[0]) + fabs((double)target[1]);
            count += 2;
            fastest = fmaxf(fastest, fmaxf(fabsf(velocity.x), fabsf(velocity.y)));
            strongest = fmaxf(strongest, fmaxf(fabsf(target[0]), fabsf(target[1])));
        }
    }
    gns_example_free(&example);
    if (!ok) return error_memory(error, "gns");
    *scales = (GnsScales){radius, (float)sqrt(velocities / count), (float)(accelerations / count), fastest, strongest};
    return (isfinite(scales->velocity) && isfinite(scales->acceleration) && scales->velocity > 0 &&
            scales->acceleration > 0) ||
           error_input(error, "gns", "the recorded launches have no motion to learn from");
}

static void use_weights(Trainer *trainer) {
    const Adam *adam = &trainer->adam;
    for (int64_t i = 0; i < adam->count; i++) trainer->net->parameters[i] = (float)adam->weights[i];
}

/* After each tenth of the steps; loss: the sum over the last `steps`. */
static bool score_some(Trainer *trainer, double loss, int steps, Error *error) {
    const GnsTraining *training = trainer->training;
    const int64_t now = trainer->adam.steps, all = training->steps;
    GnsScore score = {.steps = (int)now, .loss = loss / steps};
    if (training->on_score == NULL || now * SCORES / all == (now - steps) * SCORES / all) return true;
    for (int i = 0; i < HELD_OUT_BATCHES; i++) {
        double held_out = 0;
        if (!run_batch(trainer, &trainer->held_out, (uint64_t)i, false, &held_out, error)) return false;
        score.held_out += held_out / HELD_OUT_BATCHES;
    }
    training->on_score(training->context, &score);
    return true;
}

/* The rate falls to 0 in equal steps. */
static bool take_steps(Trainer *trainer, Error *error) {
    Adam *adam = &trainer->adam;
    const int all = trainer->training->steps;
    for (int done = 0; done < all && progress_report(&trainer->progress, done, all);) {
        const int begun = done, end = all - done < EPOCH ? all : done + EPOCH;
        double sum = 0, loss = 0;
        for (; done < end; done++) {
            if (!run_batch(trainer, &trainer->examples, (uint64_t)done, true, &loss, error)) return false;
            sum += loss;
            slopes_limit(trainer->slopes, adam->count, slope_max);
            adam_step(adam, trainer->slopes, trainer->training->rate * (double)(all - done) / all);
            use_weights(trainer);
        }
        if (!score_some(trainer, sum, end - begun, error)) return false;
    }
    return true;
}

/* The net, with the one gravity that it learns: what holds resting boxes against it. */
static bool make_net(Trainer *trainer, Error *error) {
    const GnsTraining *training = trainer->training;
    const Scene *first = training->scenes[0];
    GnsNet *net = trainer->net;
    if (!gns_net_create(net, training->width, training->rounds, error)) return false;
    net->gravity[0] = first->gravity.x;
    net->gravity[1] = first->gravity.y;
    for (int i = 1; i < training->scene_count; i++) {
        const Scene *other = training->scenes[i];
        if (other->gravity.x != first->gravity.x || other->gravity.y != first->gravity.y)
            return error_input(error, other->name, "its gravity is not that of %s; one network learns one gravity",
                               first->name);
    }
    return true;
}

static bool draw_weights(Trainer *trainer, Error *error) {
    const GnsLayout *layout = &trainer->net->layout;
    uint64_t random = trainer->training->seed;
    if (!adam_create(&trainer->adam, layout->parameters, error)) return false;
    double *weights = trainer->adam.weights;
    first_weights(weights, &layout->nodes, &random);
    first_weights(weights, &layout->edges, &random);
    for (int m = 0; m < layout->rounds; m++) {
        first_weights(weights, &layout->edge_rounds[m], &random);
        first_weights(weights, &layout->node_rounds[m], &random);
    }
    first_weights(weights, &layout->decoder, &random);
    return true;
}

static bool make_space(Trainer *trainer, Error *error) {
    const size_t count = (size_t)trainer->net->layout.parameters, batch = (size_t)trainer->training->batch;
    trainer->threads = omp_get_max_threads();
    trainer->workers = calloc((size_t)trainer->threads, sizeof *trainer->workers);
    trainer->slopes = calloc(1, (count + batch) * sizeof(double) + count * (1 + batch) * sizeof(float));
    if (trainer->workers == NULL || trainer->slopes == NULL) return error_memory(error, "gns");
    trainer->losses = trainer->slopes + count;
    trainer->transposed = (float *)(trainer->losses + batch);
    trainer->gradients = trainer->transposed + count;
    for (int i = 0; i < trainer->threads; i++) trainer->workers[i].pass.tape = true;
    return true;
}

/* *taken: how many scenes the examples have. */
static bool run(Trainer *trainer, int *taken, Error *error) {
    const GnsTraining *training = trainer->training;
    Method method;
    trainer->examples.noise = training->noise;
    trainer->examples.seed = training->seed << 32;
    if (!make_net(trainer, error) || !draw_weights(trainer, error) || !method_parse(&method, teacher, error))
        return false;
    while (*taken < training->scene_count) {
        Scene *scene = training->scenes[(*taken)++];
        progress_next_stage(&trainer->stage, record_share / training->scene_count);
        if (!gns_examples_add(&trainer->examples, scene, &method, training->launches, &trainer->progress, error))
            return false;
    }
    trainer->held_out = trainer->examples;
    trainer->held_out.seed = ~trainer->examples.seed;
    progress_next_stage(&trainer->stage, 1 - record_share);
    if (!find_scales(&trainer->examples, training->radius, &trainer->net->scales, error) || !make_space(trainer, error))
        return false;
    use_weights(trainer);
    return take_steps(trainer, error);
}

bool gns_training_run(const GnsTraining *training, GnsNet *net, const Progress *progress, Error *error) {
    Trainer *trainer = calloc(1, sizeof *trainer);
    int taken = 0;
    bool ok = trainer != NULL || error_memory(error, "gns");
    *net = (GnsNet){.parameters = NULL};
    if (ok) {
        trainer->training = training;
        trainer->net = net;
        trainer->stage = (ProgressStage){.whole = progress};
        trainer->progress = (Progress){progress_stage, &trainer->stage};
        ok = run(trainer, &taken, error);
        gns_examples_free(&trainer->examples);
        for (int i = 0; trainer->workers != NULL && i < trainer->threads; i++) {
            gns_example_free(&trainer->workers[i].example);
            gns_pass_free(&trainer->workers[i].pass);
            gns_backward_free(&trainer->workers[i].back);
            free(trainer->workers[i].slopes);
        }
        free(trainer->workers);
        free(trainer->slopes);
        adam_free(&trainer->adam);
        free(trainer);
    }
    for (; taken < training->scene_count; taken++) scene_destroy(training->scenes[taken]);
    return ok;
}
