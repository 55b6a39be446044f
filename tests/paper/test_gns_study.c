/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The study of gns: runs beside the teacher's, and verdicts from made-up tables. */
#include "testing.h"

#include "base/file.h"
#include "paper/paper_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Without its network gns falls: as its teacher until something touches, and then through the ground, g t^2 / 2. */
static void without_its_network_boxes_fall_away(void **state) {
    (void)state;
    Error error = {0};
    Scene *scene = scene_read(SOURCE_DIR "/scenes/single.yaml", &error);
    assert_ok(scene != NULL, error);
    GnsRollout rollout;
    assert_ok(gns_rollout_run(&rollout, scene, "none.npz", "net=off", &error), error);
    assert_int_equal(rollout.boxes, 2);
    assert_near(rollout.error[0], 0, 1e-4);
    assert_in_range(rollout.error[GNS_TIMES - 1], 100, 300);
    assert_near(rollout.shape[GNS_TIMES - 1], 0, 1e-5);
    assert_near(rollout.moved, 1, 0);
    assert_near(rollout.moved_teacher, 1, 0);
    scene_destroy(scene);
}

static void a_missing_network_is_named(void **state) {
    (void)state;
    Error error = {0};
    GnsRollout rollout;
    Scene *scene = scene_read(SOURCE_DIR "/scenes/single.yaml", &error);
    assert_ok(scene != NULL, error);
    assert_refused(gns_rollout_run(&rollout, scene, "none.npz", "", &error), "none.npz: error: ");
    scene_destroy(scene);
}

static const char header[] =
    "measure,variant,scene,seconds,boxes,error,shape,moved,moved_engine,ms_step,ms_gradient,hours\n";

/* The claims stated from a table; the caller frees the text. */
static char *state_claims(const char *rows) {
    Error error = {0};
    char text[4096], *lines = NULL;
    size_t size = 0;
    snprintf(text, sizeof text, "%s%s", header, rows);
    assert_ok(file_write_soon(temporary_path("system_gns.csv"), text, strlen(text), &error), error);
    FILE *file = open_memstream(&lines, &size);
    assert_non_null(file);
    const Claims claims = {.system = "gns", .folder = temporary_folder, .lines = file};
    assert_ok(gns_claims(&claims, &error), error);
    fclose(file);
    return lines;
}

/* verdicts: of the five claims, in their order. */
static void expect_verdicts(const char *rows, const char *const verdicts[5]) {
    char *lines = state_claims(rows), *rest = lines;
    for (int i = 0; i < 5; i++) {
        char *line = strtok_r(NULL, "\n", &rest);
        assert_non_null(line);
        const char *verdict = strrchr(line, ',');
        if (verdict == NULL || strcmp(verdict + 1, verdicts[i]) != 0)
            fail_msg("claim %d: expected %s: %s", i, verdicts[i], line);
    }
    free(lines);
}

static void verdicts_follow_from_the_numbers(void **state) {
    (void)state;
    expect_verdicts(
        "rollout,M = 5,stack,1,11,0.1,0,,,,,\nrollout,M = 2,stack,1,11,0.2,0,,,,,\n"
        "rollout,M = 1,stack,1,11,0.3,0,,,,,\nrollout,without noise,stack,1,11,0.4,0,,,,,\n"
        "rollout,rigid=off,stack,0.25,11,1,0,,,,,\nrollout,rigid=off,stack,1,11,1,0.06,,,,,\n"
        "large,M = 5,pyramid,5,67,1,,50,45,9,,\n\"cost\",\"width 128, M = 10\",pyramid_settled,,67,,,,,9,2,20\n",
        (const char *const[]){"yes", "yes", "yes", "yes", "yes"});
    expect_verdicts(
        "rollout,M = 5,stack,1,11,0.1,0,,,,,\nrollout,M = 2,stack,1,11,0.4,0,,,,,\n"
        "rollout,M = 1,stack,1,11,0.3,0,,,,,\nrollout,without noise,stack,1,11,0.05,0,,,,,\n"
        "rollout,rigid=off,stack,0.25,11,1,0,,,,,\nrollout,rigid=off,stack,1,11,1,0.02,,,,,\n"
        "large,M = 5,pyramid,5,67,1,,50,20,9,,\n\"cost\",\"width 128, M = 10\",pyramid_settled,,67,,,,,9,2,100\n",
        (const char *const[]){"partly", "no", "partly", "no", "partly"});
    /* What was not measured does not hold. */
    expect_verdicts("large,M = 5,pyramid,5,67,1,,50,4,9,,\n", (const char *const[]){"no", "no", "no", "no", "no"});
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(without_its_network_boxes_fall_away),
                                       cmocka_unit_test(a_missing_network_is_named),
                                       cmocka_unit_test(verdicts_follow_from_the_numbers)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
