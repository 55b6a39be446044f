/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Trajectories in files: they come back bit by bit, and what is inconsistent is refused. */
#include "made.h"
#include "files.h"

#include "example.h"

#include <inttypes.h>

static void write_file(const Trajectory *t, const char *path) {
    Error error = {0};
    assert_ok(trajectory_write(t, path, &error), error);
}

TEST(written_is_read) {
    const char *path = temporary_path("run.npz");
    OWN(Trajectory) *t = example_trajectory();
    t->iterations = 12;
    write_file(t, path);
    OWN(Trajectory) *r = trajectory_of(path);
    assert_int_equal(r->iterations, 12);
    assert_string_equal(r->scene, t->scene);
    assert_string_equal(r->method, t->method);
    assert_true(r->scene_hash == t->scene_hash && r->dt == t->dt && r->bomb == t->bomb);
    assert_memory_equal(&r->camera_center, &t->camera_center, sizeof(Vec2));
    assert_memory_equal(&r->camera_size, &t->camera_size, sizeof(Vec2));
    assert_true(r->frames == EXAMPLE_FRAMES && r->bodies == EXAMPLE_BODIES);
    assert_same_run(t, r);
    assert_memory_equal(r->contact_start, t->contact_start, (EXAMPLE_FRAMES + 1) * sizeof *t->contact_start);
    assert_int_equal(t->contact_start[EXAMPLE_FRAMES], 2);
    assert_memory_equal(r->contacts, t->contacts, 2 * sizeof *t->contacts);
    assert_string_equal(r->verdict, "falls at 0.05 s (body 1, ex\xc3\xa4mple)");
    assert_true(r->verdict_frame == 3 && r->verdict_body == 1);
}

/* An empty world of one frame is one, too. */
TEST(the_smallest_trajectory) {
    const char *path = temporary_path("small.npz");
    OWN(Trajectory) *t = run_sized(1, 0);
    t->dt = 1;
    write_file(t, path);
    OWN(Trajectory) *r = trajectory_of(path);
    assert_true(r->frames == 1 && r->bodies == 0 && r->scene[0] == '\0');
    assert_true(r->verdict[0] == '\0' && r->verdict_frame == -1 && r->verdict_body == -1);
}

static void expect_refused(const Trajectory *t, const char *reason) {
    const char *path = temporary_path("refused.npz");
    write_file(t, path);
    Error error = {0};
    Trajectory *r = trajectory_read(path, &error);
    if (r != NULL) fail_msg("taken, though '%s'", reason);
    assert_error(error, ERROR_INPUT, "refused.npz: error: ");
    assert_error(error, ERROR_INPUT, reason);
}

/* Writes a value into the example, expects a refusal. */
#define REFUSE(place, value, reason)          \
    do {                                      \
        Trajectory *t = example_trajectory(); \
        t->place = (value);                   \
        expect_refused(t, reason);            \
        trajectory_destroy(t);                \
    } while (0)

TEST(stored_runs_are_named_without_folders) {
    Trajectory *runs[] = {example_trajectory(), example_trajectory()};
    char name[TRAJECTORY_FILE_NAME_SIZE];
    for (int i = 0; i < 2; i++) strcpy(runs[i]->scene, "wall");
    strcpy(runs[0]->method, "pair-net:network=/some/where/net.npz,k=20");
    strcpy(runs[1]->method, "pair-net:network=else/where/net.npz,k=20");
    trajectory_file_name((const Trajectory *const *)runs, 0, name);
    assert_string_equal(name, "wall-pair-net_network=net.npz_k=20.npz");
    trajectory_file_name((const Trajectory *const *)runs, 1, name);
    assert_string_equal(name, "wall-pair-net_network=net.npz_k=20-2.npz");
    for (int i = 0; i < 2; i++) trajectory_destroy(runs[i]);
}

TEST(bad_heads_are_refused) {
    REFUSE(dt, 0, "dt must be finite and greater than 0 (got 0)");
    REFUSE(dt, -1, "dt must be");
    REFUSE(dt, NAN, "dt must be");
    REFUSE(dt, INFINITY, "dt must be");
    REFUSE(bomb, 3, "the bomb is body 3 of 3");
    REFUSE(bomb, -2, "the bomb is body -2 of 3");
    REFUSE(camera_center.x, NAN, "camera");
    REFUSE(camera_size.y, -1, "camera");
    REFUSE(size[1].x, 0, "body 1: its size must be finite and greater than 0");
    REFUSE(size[2].y, INFINITY, "body 2: its size");
    REFUSE(fixed[1], 2, "body 1: 'fixed' must be 0 or 1 (got 2)");
    REFUSE(mass[1], 0, "body 1: its mass must be finite and greater than 0 (got 0)");
    REFUSE(mass[1], -1, "body 1: its mass must");
    REFUSE(mass[1], INFINITY, "body 1: its mass must");
    REFUSE(scene[1], '\n', "the name of the scene has the control character");
    REFUSE(method[0], '\33', "the name of the method has the control character");
    REFUSE(verdict[1], '\33', "the verdict has the control character");
    REFUSE(verdict[1], 0x7f, "the verdict has the control character");
    REFUSE(verdict_frame, 4, "the verdict is on frame 4 of 4");
    REFUSE(verdict_frame, -2, "the verdict is on frame -2 of 4");
    REFUSE(verdict_body, 3, "the verdict is on body 3 of 3");
    REFUSE(verdict_body, -2, "the verdict is on body -2 of 3");
}

TEST(bad_poses_are_refused) {
    int box = 2 * EXAMPLE_BODIES + 1, bomb = 1 * EXAMPLE_BODIES + 2;
    REFUSE(position[box].x, INFINITY, "frame 2, body 1: pose and velocity are not all finite");
    REFUSE(position[box].y, NAN, "frame 2, body 1: pose");
    REFUSE(angle[box], NAN, "frame 2, body 1: pose");
    REFUSE(velocity[box].x, -INFINITY, "frame 2, body 1: pose");
    REFUSE(velocity[box].y, NAN, "frame 2, body 1: pose");
    REFUSE(angular_velocity[box], NAN, "frame 2, body 1: pose");
    REFUSE(angle[bomb], 0, "frame 1, body 2: pose");
    REFUSE(velocity[bomb].y, INFINITY, "frame 1, body 2: pose");
}

/* A verdict without a body, and no verdict. */
TEST(a_verdict_may_be_unknown) {
    const char *path = temporary_path("calm.npz");
    OWN(Trajectory) *t = example_trajectory();
    trajectory_judge(t, "settles", 0, -1);
    write_file(t, path);
    Trajectory *r = trajectory_of(path);
    assert_string_equal(r->verdict, "settles");
    assert_true(r->verdict_frame == 0 && r->verdict_body == -1);
    trajectory_destroy(r);
    trajectory_judge(t, "", 2, 1);
    write_file(t, path);
    r = trajectory_of(path);
    assert_true(r->verdict[0] == '\0' && r->verdict_frame == -1 && r->verdict_body == -1);
    trajectory_destroy(r);
}

static void leave(Trajectory *t, int frame, int body) {
    example_pose(t, frame, body, (float[]){NAN, NAN, NAN, NAN, NAN, NAN});
}

/* A body may come and go once; a static one stays. */
TEST(a_body_is_there_over_one_interval_of_frames) {
    const char *path = temporary_path("gone.npz");
    Trajectory *t = example_trajectory();
    leave(t, 3, 2); /* the bomb: there in frame 2 only */
    leave(t, 3, 1);
    write_file(t, path);
    Trajectory *r = trajectory_of(path);
    assert_same_run(t, r);
    assert_true(trajectory_has(r, 2, 1) && !trajectory_has(r, 3, 1));
    trajectory_destroy(r);
    trajectory_destroy(t);

    t = example_trajectory();
    example_pose(t, 0, 2, (float[6]){0});
    expect_refused(t, "frame 2, body 2: a removed body must not reappear");
    trajectory_destroy(t);
    t = example_trajectory();
    leave(t, 3, 0);
    expect_refused(t, "frame 3, body 0: a static body must not be removed");
    trajectory_destroy(t);
}

/* Step 2 had its contacts where the box was in frame 1: it may be gone in frame 2, but not before. */
TEST(contacts_are_of_the_bodies_before_the_step) {
    const char *path = temporary_path("last_contact.npz");
    OWN(Trajectory) *t = example_trajectory();
    leave(t, 2, 1);
    leave(t, 3, 1);
    write_file(t, path);
    Trajectory *r = trajectory_of(path);
    assert_int_equal(r->contact_start[EXAMPLE_FRAMES], 2);
    trajectory_destroy(r);
    leave(t, 1, 1);
    expect_refused(t, "step 2, contact 0: bodies 0 and 1 are not an existing pair");
}

TEST(bad_contacts_are_refused) {
    REFUSE(contacts[1].a, -1, "step 2, contact 1: bodies -1 and 1 are not an existing pair");
    REFUSE(contacts[1].a, 1, "bodies 1 and 1 are not an existing pair");
    REFUSE(contacts[1].b, 3, "bodies 0 and 3 are not an existing pair");
    REFUSE(contacts[0].point.x, NAN, "step 2, contact 0: a number is NaN or infinite");
    REFUSE(contacts[0].normal.y, INFINITY, "a number is NaN or infinite");
    REFUSE(contacts[0].normal_impulse, NAN, "a number is NaN or infinite");
    REFUSE(contacts[0].tangent_impulse, NAN, "a number is NaN or infinite");
    REFUSE(contact_start[0], 1, "contact_start must rise");
    REFUSE(contact_start[1], 1, "contact_start must rise");
    REFUSE(contact_start[2], -1, "contact_start must rise");
    REFUSE(contact_start[3], 3, "contact_start must rise");
    REFUSE(contact_start[3], INT64_MAX, "contact_start must rise");
    /* Rising, but with a contact in step 0. */
    OWN(Trajectory) *t = example_trajectory();
    t->contact_start[1] = t->contact_start[2] = 1;
    expect_refused(t, "contact_start must rise");
}

/* The dynamic bodies that are there, and every number exactly. */
TEST(csv_gives_every_float_back) {
    const char *path = temporary_path("run.csv");
    OWN(Trajectory) *t = example_trajectory();
    /* With 8 digits this float and the next read the same. */
    t->position[1 * EXAMPLE_BODIES + 1].x = nextafterf(1000, 2000);
    assert_ok(write_as(t, TRAJECTORY_CSV, path, &error), error);
    char *text = text_of(path), *line = strtok(text, "\n");
    assert_string_equal(line, "frame,body,x,y,angle,vx,vy,omega");
    for (int frame = 0; frame < EXAMPLE_FRAMES; frame++) {
        for (int body = 1; body < (frame < 2 ? 2 : 3); body++) {
            int got_frame, got_body, i = frame * EXAMPLE_BODIES + body;
            float s[6], want[] = {t->position[i].x, t->position[i].y, t->angle[i],
                                  t->velocity[i].x, t->velocity[i].y, t->angular_velocity[i]};
            line = strtok(NULL, "\n");
            assert_non_null(line);
            assert_int_equal(sscanf(line, "%d,%d,%f,%f,%f,%f,%f,%f", &got_frame, &got_body, &s[0], &s[1], &s[2], &s[3],
                                    &s[4], &s[5]),
                             8);
            assert_true(got_frame == frame && got_body == body);
            assert_memory_equal(s, want, sizeof s);
        }
    }
    assert_null(strtok(NULL, "\n"));
    free(text);
}

TEST(hashes_are_those_of_the_frames) {
    const char *path = temporary_path("run.hashes");
    OWN(Trajectory) *t = example_trajectory();
    t->fixed[1] = t->fixed[2] = 1;
    assert_ok(write_as(t, TRAJECTORY_HASHES, path, &error), error);
    char *text = text_of(path);
    /* Of no bodies: the start value. */
    assert_string_equal(text,
                        "frame,hash\n0,14650fb0739d0383\n1,14650fb0739d0383\n2,14650fb0739d0383\n3,14650fb0739d0383\n");
    free(text);
    t->fixed[1] = 0;
    assert_ok(write_as(t, TRAJECTORY_HASHES, path, &error), error);
    text = text_of(path);
    assert_non_null(strstr(text, printed("\n3,%016" PRIx64 "\n", trajectory_frame_hash(t, 3))));
    free(text);
}

TEST(failed_writes_tell) {
    OWN(Trajectory) *t = example_trajectory();
    for (int i = 0; i < 3; i++) {
        error = (Error){0};
        assert_false(write_as(t, (TrajectoryFormat)i, temporary_path("nowhere/run"), &error));
        assert_error(error, ERROR_SYSTEM, "nowhere/run: error: cannot write: ");
    }
}

RUN_TESTS(NULL, NULL)
