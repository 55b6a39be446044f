/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scenes in scenes/families: they stand until the bomb comes, and the bomb starts in free space and strikes. */
#include "made.h"
#include "sanitized.h"

#include <dirent.h>

static Scene *read_family(const char *file) { return scene_from(printed(SOURCE_DIR "/scenes/families/%s", file)); }

/* m: how far a box is from where it began. */
static double farthest(const Scene *scene, const World *world) {
    double most = 0;
    for (int i = 0; i < scene->body_count; i++) {
        const Vec2 a = scene->bodies[i].position, b = world_bodies(world)[i].position;
        most = fmax(most, hypot((double)b.x - (double)a.x, (double)b.y - (double)a.y));
    }
    return most;
}

typedef struct Watch {
    const Scene *scene;
    PhaseTracker tracker;
    double moved; /* m: before the bomb comes */
} Watch;

static bool watch_step(void *context, int frame, const World *world, Error *error) {
    (void)error;
    Watch *watch = context;
    phase_next(&watch->tracker, world_problem(world), frame);
    if (frame <= watch->scene->bomb.frame) watch->moved = farthest(watch->scene, world);
    /* In the step in which it comes the bomb touches nothing. */
    if (frame == watch->scene->bomb.frame + 1) assert_int_equal(watch->tracker.touch, 0);
    return true;
}

static void check_launch(const char *file, const Scene *scene, const Launch *launch) {
    Error error = {0};
    const Scene launched = launch_scene(scene, launch);
    Watch watch = {.scene = &launched, .tracker = {.impact_frames = scene->bomb.impact_frames}};
    const Method method = method_named("momentum:k=50");
    assert_ok(simulate_observed(&launched, &method, &(StepObserver){watch_step, &watch}, &error), error);
    if (watch.moved > 0.2) fail_msg("%s: a box moved by %g m before the bomb came", file, watch.moved);
    if (watch.tracker.touch == 0) fail_msg("%s: the bomb from x = %g m touches nothing", file, (double)launch->x);
    if (watch.tracker.touch + scene->bomb.impact_frames + AFTER_FRAMES > scene->frames + 1)
        fail_msg("%s: the run ends in the frames after the impact in frame %d", file, watch.tracker.touch);
}

/* Large scenes take the sanitizers' build half a minute, in the code of the small ones; there they are only read. */
static int runs_of(const Scene *scene) {
    if (scene->body_count >= 100 && sampled(2) > 1) return 0;
    return scene->body_count < 1000 ? 2 : 1;
}

TEST(families_stand_until_the_bomb_strikes) {
    DIR *folder = opendir(SOURCE_DIR "/scenes/families");
    int scenes = 0;
    assert_non_null(folder);
    for (const struct dirent *entry; (entry = readdir(folder)) != NULL;) {
        if (strstr(entry->d_name, ".yaml") == NULL) continue;
        Scene *scene = read_family(entry->d_name);
        Launch launches[2];
        assert_ok(launches_for_scoring(scene, 2, launches, &error), error);
        for (int i = 0; i < runs_of(scene); i++) check_launch(entry->d_name, scene, &launches[i]);
        scene_destroy(scene);
        scenes++;
    }
    closedir(folder);
    assert_true(scenes >= 19);
}

RUN_TESTS(NULL, NULL)
