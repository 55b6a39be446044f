/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The verdict on a run is that of its copies: lengths s times as long with times the root of s, masses m times as
   large. */
#include "made.h"
#include "sanitized.h"
#include "studies/trial.h"

#include "studies/stability.h"

/* The frames of a run, with their contacts, at its own scale. */
typedef struct Frame {
    int body_count, contact_count, bomb;
    Body *bodies;
    ContactPoint *contacts;
} Frame;

typedef struct Recording {
    Frame *frames; /* [count]: the first is the start */
    int count;
    bool failed;
} Recording;

static void *copy(const void *items, size_t size) {
    void *memory = malloc(size + 1);
    assert_non_null(memory);
    if (size > 0) memcpy(memory, items, size);
    return memory;
}

static bool record(void *context, int frame, const World *world, Error *error) {
    Recording *recording = context;
    const ContactProblem *problem = world_problem(world);
    const int bodies = world_body_count(world), contacts = frame > 0 ? problem->contact_count : 0;
    (void)error;
    recording->frames[recording->count++] = (Frame){bodies, contacts, frame > 0 ? problem->bomb : -1,
                                                    copy(world_bodies(world), (size_t)bodies * sizeof(Body)),
                                                    copy(problem->contacts, (size_t)contacts * sizeof(ContactPoint))};
    return true;
}

static void recording_make(Recording *recording, const Scene *scene, const char *method) {
    Error error = {0}, failure = {0};
    const Method by = method_named(method);
    *recording = (Recording){.frames = calloc((size_t)scene->frames + 1, sizeof(Frame))};
    World *start = scene_world(scene, &error);
    assert_ok(start != NULL, error);
    record(recording, 0, start, &error);
    world_destroy(start);
    recording->failed = !simulate_observed(scene, &by, &(StepObserver){record, recording}, &failure);
    assert_true(!recording->failed || failure.failure != FAILURE_NONE);
}

static void recording_free(Recording *recording) {
    for (int i = 0; i < recording->count; i++) {
        free(recording->frames[i].bodies);
        free(recording->frames[i].contacts);
    }
    free(recording->frames);
}

typedef struct Scale {
    double length, mass;
} Scale;

static Vec2 scaled(Vec2 v, double by) { return vec2((float)(v.x * by), (float)(v.y * by)); }

/* Gravity stays the same: speeds are the root of the length as large, rates its inverse. */
static Body scaled_body(const Body *body, Scale scale) {
    const double root = sqrt(scale.length);
    Body copied = *body;
    copied.position = scaled(body->position, scale.length);
    copied.size = scaled(body->size, scale.length);
    copied.velocity = scaled(body->velocity, root);
    copied.angular_velocity = (float)(body->angular_velocity / root);
    copied.inv_mass = (float)(body->inv_mass / scale.mass);
    copied.inv_inertia = (float)(body->inv_inertia / (scale.mass * scale.length * scale.length));
    return copied;
}

static VerdictReading judge(const Recording *recording, const Scene *scene, Scale scale) {
    VerdictWatch watch = {0};
    VerdictRun run = verdict_run_of(scene);
    Error error = {0};
    run.dt = (float)(scene->dt * sqrt(scale.length));
    for (int i = 0; i < recording->count; i++) {
        const Frame *frame = &recording->frames[i];
        FREED Body *bodies = copy(frame->bodies, (size_t)frame->body_count * sizeof(Body));
        FREED ContactPoint *contacts = copy(frame->contacts, (size_t)frame->contact_count * sizeof(ContactPoint));
        for (int k = 0; k < frame->body_count; k++) bodies[k] = scaled_body(&frame->bodies[k], scale);
        for (int k = 0; k < frame->contact_count; k++) {
            contacts[k].position = scaled(contacts[k].position, scale.length);
            contacts[k].separation = (float)(contacts[k].separation * scale.length);
        }
        const VerdictStep step = {i, frame->body_count, frame->contact_count, frame->bomb, bodies, contacts};
        assert_ok(i == 0 ? verdict_watch_begin(&watch, &run, bodies, frame->body_count, &error)
                         : verdict_watch_step(&watch, &step, &error),
                  error);
    }
    const VerdictReading reading = verdict_watch_end(&watch);
    verdict_watch_free(&watch);
    return reading;
}

static const Scale scales[] = {{0.01, 1}, {100, 1}, {1, 1e-3}, {1, 1e3}, {0.01, 1e3}};

/* Compares a run with its copies. Returns how many verdicts differ. */
static int compare(const Scene *scene, const char *method, const char *name, bool seen[VERDICTS]) {
    Recording recording;
    recording_make(&recording, scene, method);
    const VerdictReading own = judge(&recording, scene, (Scale){1, 1});
    int differ = 0;
    seen[own.verdict] = true;
    for (size_t i = 0; i < sizeof scales / sizeof *scales; i++) {
        const VerdictReading other = judge(&recording, scene, scales[i]);
        if (other.verdict == own.verdict && other.frame == own.frame && other.body == own.body) continue;
        printf("%s by %s: %s in frame %d (body %d); lengths by %g, masses by %g: %s in frame %d (body %d)\n", name,
               method, verdict_name(own.verdict), own.frame, own.body, scales[i].length, scales[i].mass,
               verdict_name(other.verdict), other.frame, other.body);
        differ++;
    }
    recording_free(&recording);
    return differ;
}

/* Both ends and the middle of every study. All verdicts are met only where all studies run. */
TEST(copies_in_other_units_have_the_same_verdict) {
    enum { FRAMES = 300 };
    static const char *const methods[] = {"engine", "momentum"};
    bool seen[VERDICTS] = {false};
    int differ = 0;
    for (int i = 0; i < stability_study_count; i += sampled(4)) {
        const StabilityStudy *study = &stability_studies[i];
        double values[BORDER_POINTS_MAX];
        const int count = border_scan_values(&study->scan, values);
        for (int end = 0; end < 3; end++) {
            OWN(Scene) *scene =
                stability_study_scene(study, SOURCE_DIR "/scenes", values[(count - 1) * end / 2], &error);
            assert_ok(scene != NULL, error);
            if (scene->frames > FRAMES) scene->frames = FRAMES;
            for (size_t m = 0; m < sizeof methods / sizeof *methods; m++)
                differ += compare(scene, methods[m], study->name, seen);
        }
    }
    assert_int_equal(differ, 0);
    const Verdict wanted[] = {VERDICT_SETTLES,   VERDICT_STANDS,  VERDICT_MOVES,   VERDICT_FALLS,
                              VERDICT_COLLAPSES, VERDICT_TUNNELS, VERDICT_EXPLODES};
    for (size_t i = 0; sampled(4) == 1 && i < sizeof wanted / sizeof *wanted; i++)
        if (!seen[wanted[i]]) fail_msg("no run has the verdict %s", verdict_name(wanted[i]));
}

RUN_TESTS(NULL, NULL)
