/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The bits of Box2D-Lite: golden/grid_hash.csv and golden/run_hash.csv hold the hashes of its own runs, with sine
   and cosine as the double function rounded to float (commit 227b71b; g++ 12.2). */
#include "made.h"
#include "sanitized.h"

#include "base/hash.h"

enum { SCENES = 3 };

static Scene *read_scene(const char *name) {
    bool ours = strcmp(name, "pyramid78") != 0;
    return scene_from(printed("%s/%s/%s.yaml", SOURCE_DIR, ours ? "scenes" : "tests/scenes", name));
}

static FILE *open_golden(const char *name, const char *header) {
    char path[512], line[256];
    snprintf(path, sizeof path, "%s/golden/%s", SOURCE_DIR, name);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    assert_non_null(fgets(line, sizeof line, file));
    assert_string_equal(line, header);
    return file;
}

TEST(every_launch_has_the_bits_of_box2d_lite) {
    FILE *file = open_golden("grid_hash.csv", "scene,bomb_x,hash_f60,hash_f120,hash_f300\n");
    char line[256], name[32], x[16];
    unsigned long long hashes[3];
    const int frames[3] = {60, 120, 300};
    int launches = 0;
    for (; fgets(line, sizeof line, file) != NULL; launches++) {
        if (launches % sampled(9) != 0) continue;
        assert_int_equal(sscanf(line, "%31[^,],%15[^,],%llx,%llx,%llx", name, x, &hashes[0], &hashes[1], &hashes[2]),
                         5);
        OWN(Scene) *scene = read_scene(name);
        scene->frames = 300;
        scene->bomb.frame = 0;
        scene->bomb.x.value = strtof(x, NULL);
        OWN(Trajectory) *run = run_by(scene, "engine");
        for (int i = 0; i < 3; i++)
            if (trajectory_frame_hash(run, frames[i]) != hashes[i])
                fail_msg("%s, bomb at x = %s: another state in frame %d or before", name, x, frames[i]);
    }
    fclose(file);
    assert_int_equal(launches, 201 * SCENES);
}

/* One hash for a whole run: FNV-1a over the hashes of its frames. */
static uint64_t run_hash(const Trajectory *run) {
    uint64_t hash = FNV1A64_START;
    for (int frame = 0; frame < run->frames; frame++) {
        uint64_t of_frame = trajectory_frame_hash(run, frame);
        hash = hash_fnv1a64(hash, &of_frame, sizeof of_frame);
    }
    return hash;
}

TEST(every_frame_of_the_long_runs_has_the_bits_of_box2d_lite) {
    FILE *file = open_golden("run_hash.csv", "name,scene,bomb_x,bomb_frame,frames,hash\n");
    char line[256], name[64], scene_name[32], x[16];
    unsigned long long hash;
    int bomb_frame, frames, runs = 0;
    for (; fgets(line, sizeof line, file) != NULL; runs++) {
        assert_int_equal(
            sscanf(line, "%63[^,],%31[^,],%15[^,],%d,%d,%llx", name, scene_name, x, &bomb_frame, &frames, &hash), 6);
        OWN(Scene) *scene = read_scene(scene_name);
        scene->frames = frames;
        scene->bomb.present = bomb_frame >= 0; /* -1: a run without a bomb */
        scene->bomb.frame = bomb_frame;
        scene->bomb.x.value = strtof(x, NULL);
        OWN(Trajectory) *run = run_by(scene, "engine");
        if (run_hash(run) != hash) fail_msg("%s: another state than Box2D-Lite's in some frame", name);
    }
    fclose(file);
    assert_int_equal(runs, 25);
}

RUN_TESTS(NULL, NULL)
