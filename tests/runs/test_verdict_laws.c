/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The verdict on a run is that of its copies: in other units, mirrored, turned, with angles kept within a turn, with
   every second frame, without its velocities. */
#include "made.h"
#include "sanitized.h"

#include "runs/runs.h"
#include "runs/verdict.h"

#include <dirent.h>

typedef struct Law {
    const char *name;
    void (*change)(Trajectory *run, Scene *scene);
    bool samples; /* sees less of the run than the verdict did: some runs may differ */
} Law;

/* Each state of each frame. */
#define EACH(i) for (size_t i = 0; i < (size_t)run->frames * (size_t)run->bodies; i++)

/* Gravity, m/s^2, stays the same. */
static void enlarge(Trajectory *run, Scene *scene) {
    (void)scene;
    run->dt *= 2;
    for (int i = 0; i < run->bodies; i++) run->size[i] = vec2_scale(4, run->size[i]);
    EACH(i) {
        run->position[i] = vec2_scale(4, run->position[i]);
        run->velocity[i] = vec2_scale(2, run->velocity[i]);
        run->angular_velocity[i] /= 2;
    }
}

static void make_heavier(Trajectory *run, Scene *scene) {
    (void)scene;
    for (int i = 0; i < run->bodies; i++) run->mass[i] *= 1000;
}

static void mirror(Trajectory *run, Scene *scene) {
    scene->gravity.x *= -1;
    EACH(i) {
        run->position[i].x *= -1;
        run->velocity[i].x *= -1;
        run->angle[i] *= -1;
        run->angular_velocity[i] *= -1;
    }
}

static Vec2 turned(Vec2 v) { return vec2(-v.y, v.x); }

static void turn(Trajectory *run, Scene *scene) {
    scene->gravity = turned(scene->gravity);
    EACH(i) {
        run->position[i] = turned(run->position[i]);
        run->velocity[i] = turned(run->velocity[i]);
        run->angle[i] += (float)(M_PI / 2);
    }
}

static void wrap(Trajectory *run, Scene *scene) {
    (void)scene;
    EACH(i) run->angle[i] = remainderf(run->angle[i], (float)(2 * M_PI));
}

static void thin(Trajectory *run, Scene *scene) {
    (void)scene;
    run->dt *= 2;
    run->frames = (run->frames + 1) / 2;
    EACH(i) {
        const size_t bodies = (size_t)run->bodies, from = i / bodies * 2 * bodies + i % bodies;
        run->position[i] = run->position[from];
        run->velocity[i] = run->velocity[from];
        run->angle[i] = run->angle[from];
        run->angular_velocity[i] = run->angular_velocity[from];
    }
}

static void forget_velocities(Trajectory *run, Scene *scene) {
    (void)scene;
    run->no_velocities = true;
}

static const Law laws[] = {{"lengths and times", enlarge, false},
                           {"masses", make_heavier, false},
                           {"mirrored", mirror, false},
                           {"turned", turn, false},
                           {"wrapped angles", wrap, false},
                           {"every second frame", thin, true},
                           {"no velocities", forget_velocities, true}};
enum { LAWS = sizeof laws / sizeof *laws };

static VerdictReading judge(const Trajectory *run, const Scene *scene, char words[TRAJECTORY_VERDICT_SIZE]) {
    SimulateVerdict verdict;
    Error error = {0};
    assert_ok(simulate_verdict_of_run(&verdict, run, scene, 0, &error), error);
    simulate_verdict_words(&verdict, words);
    simulate_verdict_free(&verdict);
    return verdict.reading;
}

/* Runs the scene, and counts the laws that the verdict on it breaks. */
static void check_run(const char *path, const char *text, int broken[LAWS]) {
    Error error = {0};
    OWN(Scene) *scene = scene_from(path);
    if (scene->frames > 300) scene->frames = 300;
    if (scene->body_count > 150) return;
    const Method method = method_named(text);
    OWN(Trajectory) *run = simulate(scene, &method, NULL, &error);
    if (run == NULL) return; /* the method does not apply, or fails */
    char words[TRAJECTORY_VERDICT_SIZE], again[TRAJECTORY_VERDICT_SIZE];
    const VerdictReading is = judge(run, scene, words);
    for (int law = 0; law < LAWS; law++) {
        OWN(Trajectory) *copy = simulate(scene, &method, NULL, &error);
        OWN(Scene) *of_copy = scene_from(path);
        laws[law].change(copy, of_copy);
        for (int i = 0; i < copy->bodies; i++) /* the scene of the copy */
            *(i < of_copy->body_count ? &of_copy->bodies[i].size : &of_copy->bomb.size) = copy->size[i];
        const VerdictReading was = judge(copy, of_copy, again);
        const bool same = is.verdict == was.verdict && is.struck == was.struck && is.moving == was.moving &&
                          is.count.bodies == was.count.bodies && is.count.fell == was.count.fell &&
                          is.count.left == was.count.left && is.count.moved == was.count.moved;
        broken[law] += !same;
        if (!same) print_message("%s by %s, %s: %s\n  not %s\n", path, text, laws[law].name, again, words);
    }
}

TEST(a_verdict_does_not_depend_on_how_a_run_is_stated) {
    static const char *const folders[] = {"scenes", "scenes/families", "scenes/templates", "scenes/stability"};
    static const char *const methods[] = {"engine", "momentum:k=4"};
    int broken[LAWS] = {0}, runs = 0;
    for (size_t k = 0; k < sizeof folders / sizeof *folders; k++) {
        struct dirent **files;
        const int count = scandir(printed(SOURCE_DIR "/%s", folders[k]), &files, NULL, alphasort);
        for (int i = 0; i < count; i++) {
            if (strstr(files[i]->d_name, ".yaml") != NULL && runs++ % sampled(8) == 0)
                for (int m = 0; m < 2; m++)
                    check_run(printed(SOURCE_DIR "/%s/%s", folders[k], files[i]->d_name), methods[m], broken);
            free(files[i]);
        }
        free(files);
    }
    assert_true(runs >= 50);
    for (int law = 0; law < LAWS; law++) assert_true(broken[law] <= (laws[law].samples ? 2 * runs / 30 : 0));
}

RUN_TESTS(NULL, NULL)
