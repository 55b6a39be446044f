/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The figures are drawn once, from the scenes that ship. */
#include "made.h"
#include "files.h"

#include "pictures/mesa.h"

#include "learning/dataset.h"
#include "paper/report_internal.h"
#include "paper/paper_report.h"
#include "figures/figure.h"
#include "figures/sketch.h"

#define SCENES SOURCE_DIR "/scenes"

FIXTURE(draw_all) {
    temporary_path(""); /* makes the folder */
    assert_ok(illustrations_draw(SCENES, temporary_folder, &error), error);
}

static char *read_file(const char *name, const char *ending, size_t *size) {
    return read_whole(temporary_path(printed("%s.%s", name, ending)), size);
}

TEST(every_figure_is_a_picture_a_drawing_and_a_caption) {
    int count = 0;
    for (; illustration_names[count] != NULL; count++) {
        const char *name = illustration_names[count];
        size_t size;
        char *png = read_file(name, "png", &size);
        /* 174 mm at 300 dots an inch: 2055. */
        assert_memory_equal(png, "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x08\x07", 20);
        assert_true(size > 20000);
        free(png);
        char *caption = read_file(name, "txt", &size);
        assert_true(size > 100);
        assert_ptr_equal(strchr(caption, '\n'), caption + size - 1);
        free(caption);
        assert_int_equal(access(temporary_path(printed("%s.pdf", name)), F_OK), -1);
    }
    assert_int_equal(count, 4);
}

static void expect_texts(const char *name, const char *const *texts) {
    size_t size;
    FREED char *svg = read_file(name, "svg", &size);
    for (; *texts != NULL; texts++)
        if (strstr(svg, *texts) == NULL) fail_msg("%s.svg lacks \"%s\"", name, *texts);
}

TEST(drawings_say_what_they_show) {
    expect_texts("loop", (const char *const[]){"Broad phase", "Narrow phase", "Gravity", "Contact problem",
                                               "Constraint solving", "Neural network, in place of the solver",
                                               "Integration", "first touch", NULL});
    expect_texts("narrow-phase",
                 (const char *const[]){"bomb x", "bomb y", "box x", "box y", "smallest overlap", "normal (", NULL});
    expect_texts("data",
                 (const char *const[]){"21 of 201 launches", "Ten inputs", "angle b", "dvxa", "velocity before", NULL});
    expect_texts("scenes", (const char *const[]){"1  Single: 1 box", "2  Stack: 10 boxes", "3  Pyramid: 66 boxes",
                                                 "data:image/png;base64,", NULL});
}

/* The engine's run of a scene, up to a step. */
static Trajectory *run_to(const char *path, int step) {
    OWN(Scene) *scene = scene_from(path);
    const Method engine = method_named("engine");
    scene->frames = step;
    Trajectory *run = run_with(scene, &engine);
    return run;
}

TEST(the_loop_counts_what_the_run_has) {
    size_t size;
    int step, pairs, candidates, touching, points, warm;
    char *caption = read_file("loop", "txt", &size);
    const char *counts = strstr(caption, "counts of step");
    assert_non_null(counts);
    assert_int_equal(sscanf(counts,
                            "counts of step %d of stack.yaml, the one after the bomb's first touch. Of %d pairs of "
                            "bodies, %d have overlapping bounding boxes; %d of these touch, in %d points, of which %d",
                            &step, &pairs, &candidates, &touching, &points, &warm),
                     6);
    free(caption);
    OWN(Trajectory) *run = run_to(SCENES "/stack.yaml", step);
    int64_t first = run->contact_start[step], end = run->contact_start[step + 1];
    int different = 0, kept = 0, bombs_before = 0;
    for (int64_t i = first; i < end; i++) {
        const TrajectoryContact *now = &run->contacts[i];
        different += i == first || now->a != now[-1].a || now->b != now[-1].b;
        for (int64_t k = run->contact_start[step - 1]; k < first; k++) {
            const TrajectoryContact *last = &run->contacts[k];
            kept +=
                last->a == now->a && last->b == now->b && last->feature == now->feature && last->normal_impulse != 0;
        }
    }
    for (int64_t i = 0; i < first; i++) bombs_before += run->contacts[i].b == run->bomb && run->contacts[i].a > 0;
    int64_t last_step = run->contact_start[step - 1];
    int in_last_step = 0;
    for (int64_t i = last_step; i < first; i++)
        in_last_step += run->contacts[i].b == run->bomb && run->contacts[i].a > 0;
    assert_int_equal(bombs_before, in_last_step);
    assert_true(in_last_step > 0);
    assert_int_equal(points, end - first);
    assert_int_equal(touching, different);
    assert_int_equal(warm, kept);
    assert_int_equal(pairs, run->bodies * (run->bodies - 1) / 2);
    assert_in_range(candidates, touching, pairs);
}

static Box box_in(const Trajectory *run, int frame, int body) {
    int i = frame * run->bodies + body;
    return box_make(run->position[i], run->size[body], run->angle[i]);
}

TEST(the_collision_shown_is_the_engines) {
    size_t size;
    int a, b, step, least, deep[2];
    double x, y;
    char *caption = read_file("narrow-phase", "txt", &size);
    assert_int_equal(sscanf(caption, "The narrow phase for bodies %d and %d in step %d", &a, &b, &step), 3);
    const char *end = strstr(caption, "The smallest overlap, ");
    assert_non_null(end);
    assert_int_equal(sscanf(end, "The smallest overlap, %d mm, gives the normal (%lf, %lf)", &least, &x, &y), 3);
    end = strstr(end, "points, ");
    assert_non_null(end);
    assert_int_equal(sscanf(end, "points, %d and %d mm deep.", &deep[0], &deep[1]), 2);
    free(caption);
    OWN(Trajectory) *run = run_to(SCENES "/pyramid.yaml", step);
    const Box box_a = box_in(run, step - 1, a), box_b = box_in(run, step - 1, b);
    Manifold manifold;
    manifold_compute(&manifold, &box_a, &box_b);
    assert_int_equal(b, run->bomb);
    assert_int_equal(manifold.count, 2);
    assert_near(manifold.normal.x, x, 0.0006);
    assert_near(manifold.normal.y, y, 0.0006);
    for (int i = 0; i < 2; i++) assert_near(-1000 * (double)manifold.points[i].separation, deep[i], 0.6);
    assert_near(1000 * overlap_depth(&box_a, &box_b), least, 0.6);
    /* The deepest point is a corner that clipping has left where it was. */
    assert_int_equal(least, deep[0] > deep[1] ? deep[0] : deep[1]);
}

TEST(the_row_shown_is_the_datasets) {
    static const char *const scenes[] = {SCENES "/stack.yaml"};
    const DatasetOptions options = {.scenes = scenes, .scene_count = 1, .bomb_x = {-5, 0.5, 21}, .seed = 1};
    size_t size;
    int rows, bodies[2], step;
    double x, changes[4];
    char *caption = read_file("data", "txt", &size);
    const char *count = strstr(caption, "per step, "), *row = strstr(caption, "of bodies");
    const char *box = strstr(caption, "velocity of the box by ");
    assert_true(count != NULL && row != NULL && box != NULL);
    assert_int_equal(sscanf(count, "per step, %d rows", &rows), 1);
    assert_int_equal(
        sscanf(row, "of bodies %d and %d in step %d of the launch from x = %lf m", &bodies[0], &bodies[1], &step, &x),
        4);
    /* A minus as wide as a plus is no minus to scanf. */
    for (char *minus = caption; (minus = strstr(minus, "\xe2\x88\x92")) != NULL;) memcpy(minus, "  -", 3);
    assert_int_equal(sscanf(box, "velocity of the box by (%lf, %lf) m/s and that of the bomb by (%lf, %lf)",
                            &changes[0], &changes[1], &changes[2], &changes[3]),
                     4);
    free(caption);
    OWN(Dataset) *dataset = dataset_record(&options, NULL, &error);
    assert_ok(dataset != NULL, error);
    assert_int_equal(rows, dataset->rows);
    int found = 0;
    for (int64_t i = 0; i < dataset->rows; i++) {
        if (fabs((double)dataset->launch_x[dataset->launch[i]] - x) > 1e-6) continue;
        const int32_t *pair = &dataset->bodies[2 * i];
        assert_false(pair[0] > 0 && pair[1] == bodies[1] && dataset->frame[i] < step); /* it is the first touch */
        if (dataset->frame[i] != step || pair[0] != bodies[0] || pair[1] != bodies[1]) continue;
        const float *change = &dataset->changes[PAIR_CHANGES * i];
        const int at[4] = {0, 1, 3, 4};
        for (int k = 0; k < 4; k++) assert_near(change[at[k]], changes[k], 0.006);
        found++;
    }
    assert_int_equal(found, 1);
}

/* A folder with the scenes that ship, but for one; what becomes of it. */
static const char *folder_with(const char *name, const char *text) {
    static const char *const names[] = {"single.yaml", "stack.yaml", "pyramid.yaml"};
    Error error = {0};
    const char *folder = temporary_path("scenes");
    assert_ok(file_make_directory(folder, &error), error);
    for (int i = 0; i < 3; i++) {
        char path[512];
        size_t size = strlen(text);
        snprintf(path, sizeof path, SCENES "/%s", names[i]);
        FREED char *shipped = text_of(path);
        const char *data = strcmp(names[i], name) == 0 ? text : shipped;
        size = strlen(data);
        snprintf(path, sizeof path, "%s/%s", folder, names[i]);
        assert_ok(file_write(path, data, size, &error), error);
    }
    return folder;
}

static void expect_refused(const char *scenes, const char *message) {
    Error error = {0};
    const char *folder = temporary_path("refused");
    assert_ok(file_make_directory(folder, &error), error);
    assert_refused(illustrations_draw(scenes, folder, &error), message);
    assert_int_equal(access(printed("%s/loop.png", folder), F_OK), -1);
}

#define GROUND_AND_BOX                                                                                             \
    "gravity: [0, -10]\ndt: 1/60\niterations: 10\nframes: 5\n"                                                     \
    "bodies:\n  - {static: true, size: [100, 20], position: [0, -10]}\n  - {mass: 1, size: [1, 1], position: [0, " \
    "1]}\n"

TEST(scenes_that_show_nothing_are_refused) {
    expect_refused(temporary_path("nowhere"), "/nowhere/single.yaml");
    expect_refused(folder_with("pyramid.yaml", GROUND_AND_BOX),
                   "/pyramid.yaml: error: the scene has no bomb to launch");
    expect_refused(folder_with("stack.yaml", GROUND_AND_BOX "bomb: {x: 5, y: 15, size: [1, 1], mass: 50}\n"),
                   "stack: error: the bomb touches no box in 5 steps");
}

RUN_TESTS(draw_all, NULL)
