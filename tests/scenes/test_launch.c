/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Launches: tables of them, and the two families that studies use. */
#include "scene_text.h"
#include "owned.h"

#include "base/base.h"
#include "scenes/scenes.h"

#define BOMB "bomb: {x: 1, y: 15, size: [1, 1], mass: 50, rotation: 0.5, spin: 2, frame: 9"

/* The family of the scenes that ship. */
#define FAMILY "bomb: {x: {from: -5, to: 5, value: 1}, y: 15, size: [1, 1], mass: 50, rotation: 0.5, spin: 2, frame: 9"

static Scene *aiming_scene(void) { return good_scene(BASE GROUND BOMB ", velocity: {times_position: -1.5}}\n"); }

static const char *write_launches(const char *text, size_t size) {
    return write_bytes(temporary_path("launches.csv"), text, size);
}

static LaunchTable read_good(const char *text) {
    Error error = {0};
    LaunchTable table;
    assert_ok(launches_read(&table, write_launches(text, strlen(text)), &error), error);
    return table;
}

static void assert_launch(Launch found, Launch expected) {
    assert_true(found.x == expected.x && found.rotation == expected.rotation && found.spin == expected.spin &&
                found.mass == expected.mass && found.frame == expected.frame);
}

TEST(launched_scene_has_the_bomb_of_the_launch) {
    OWN(Scene) *scene = aiming_scene();
    assert_launch(launch_of(scene), (Launch){1, 0.5f, 2, 50, 9});
    const Launch launch = {-4, 0.25f, -3, 70, 12};
    Scene launched = launch_scene(scene, &launch);
    assert_launch(launch_of(&launched), launch);
    BodyDef bomb = scene_bomb_body(&launched);
    /* The velocity is -1.5 times the new position, the height is the scene's. */
    assert_true(bomb.position.x == -4 && bomb.position.y == 15);
    assert_true(bomb.velocity.x == 6 && bomb.velocity.y == -22.5f);
    const SceneParameters all = scene_parameters(&launched);
    assert_near(scene_parameter(&all, "bomb_x")->value, -4, 0);
    assert_ptr_equal(launched.bodies, scene->bodies);
    assert_launch(launch_of(scene), (Launch){1, 0.5f, 2, 50, 9});
    /* The scene's own launch gives the scene's own run. */
    Launch own = launch_of(scene);
    Scene again = launch_scene(scene, &own);
    assert_int_equal(scene_hash(&again), scene_hash(scene));
    assert_int_not_equal(scene_hash(&launched), scene_hash(scene));
}

TEST(columns_come_in_any_order_and_number) {
    static const struct {
        const char *text;
        Launch first, second;
    } cases[] = {
        {"x\n-2\n2.5\n", {-2, 0.5f, 2, 50, 9}, {2.5f, 0.5f, 2, 50, 9}},
        {"frame,x\r\n7,-2\r\n300,2.5\r\n", {-2, 0.5f, 2, 50, 7}, {2.5f, 0.5f, 2, 50, 300}},
        {"mass,frame,spin,rotation,x\n1,2,3,4,5\n6,7,8,9,1/2", {5, 4, 3, 1, 2}, {0.5f, 9, 8, 6, 7}},
        {"spin\n\"0\"\n-1e4\n", {1, 0.5f, 0, 50, 9}, {1, 0.5f, -1e4f, 50, 9}},
    };
    OWN(Scene) *scene = aiming_scene();
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        LaunchTable table = read_good(cases[i].text);
        Launch out[2];
        assert_int_equal(table.count, 2);
        assert_ok(launches_for(&table, scene, out, &error), error);
        assert_launch(out[0], cases[i].first);
        assert_launch(out[1], cases[i].second);
        launches_free(&table);
    }
}

TEST(broken_launches_are_refused_with_their_place) {
#define CASE(text, message) \
    { text, sizeof(text) - 1, "launches.csv:" message }
    static const struct {
        const char *text;
        size_t size;
        const char *message;
    } cases[] = {
        CASE("x,y\n1,2\n", "1:3: error: unknown column 'y'; the columns are x, rotation, spin, mass, frame"),
        CASE("x\n", "2:1: error: the table has no rows"),
        CASE("x\n1\n\0\n", "3:1: error: control character 0x00"),
        CASE("x,spin\n,1\n", "2:1: error: x: the field is empty"),
        CASE("x\n2e6\n", "2:1: error: x: '2e6' is greater than 1e+06"),
        CASE("mass\n0\n", "2:1: error: mass: '0' is less than 1e-06"),
        CASE("frame\n1.5\n", "2:1: error: frame: '1.5' is not a whole number"),
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        LaunchTable table;
        assert_refused(launches_read(&table, write_launches(cases[i].text, cases[i].size), &error), cases[i].message);
    }
}

TEST(ten_thousand_launches_are_the_most) {
    static char text[2 + 2 * 10001] = "x\n";
    for (int i = 0; i < 10001; i++) memcpy(text + 2 + 2 * i, "1\n", 2);
    LaunchTable table;
    assert_ok(launches_read(&table, write_launches(text, sizeof text - 2), &error), error);
    assert_int_equal(table.count, 10000);
    launches_free(&table);
    assert_refused(launches_read(&table, write_launches(text, sizeof text), &error),
                   "launches.csv:10002:1: error: the table has more than 10000 rows");
}

static void expect_misfit(const char *scene_text, const char *launches, const char *message) {
    OWN(Scene) *scene = good_scene(scene_text);
    LaunchTable table = read_good(launches);
    Launch out[2];
    Error error = {0};
    assert_refused(launches_for(&table, scene, out, &error), message);
    launches_free(&table);
}

TEST(launches_that_a_scene_cannot_run_are_refused) {
    expect_misfit(BASE GROUND BOMB "}\n", "x,frame\n1,300\n1,301\n",
                  "launches.csv:3:3: error: the bomb would come in frame 301, after the last of scene (frames: 300)");
    expect_misfit(BASE GROUND BOMB ", velocity: {times_position: -1.5}}\n", "x\n6000\n6700\n",
                  "launches.csv:3:1: error: the bomb of scene would start with (-10050, -22.5) m/s, above 10000");
    expect_misfit(BASE GROUND, "x\n1\n2\n", "launches.csv: error: the scene scene has no bomb to launch");
}

static void get_launches(const Scene *scene, bool scoring, int count, Launch *out) {
    Error error = {0};
    assert_ok((scoring ? launches_for_scoring : launches_for_training)(scene, count, out, &error), error);
}

TEST(scoring_never_meets_training) {
    OWN(Scene) *scene = good_scene(BASE GROUND FAMILY "}\n");
    static const FloatRange grid = {-5, 0.05, 201}, midpoints = {-4.975, 0.05, 200};
    static Launch training[201], scoring[200];
    get_launches(scene, false, 201, training);
    get_launches(scene, true, 200, scoring);
    for (int i = 0; i < 201; i++) {
        assert_true(training[i].x == (float)((i - 100) / 20.0)); /* the float of the decimal, 0 included */
        assert_launch(training[i], (Launch){range_value(&grid, i), 0.5f, 2, 50, 9});
    }
    for (int i = 0; i < 200; i++) {
        assert_launch(scoring[i], (Launch){range_value(&midpoints, i), 0.5f, 2, 50, 9});
        assert_true(scoring[i].x != 0);
        for (int k = 0; k < 201; k++) assert_true(scoring[i].x != training[k].x);
    }
}

TEST(few_launches_are_spread_evenly) {
    OWN(Scene) *scene = good_scene(BASE GROUND FAMILY "}\n");
    Launch out[4];
    get_launches(scene, true, 4, out);
    static const double scored[] = {-3.725, -1.225, 1.275, 3.775}; /* j = 25, 75, 125, 175 */
    for (int i = 0; i < 4; i++) assert_near(out[i].x, scored[i], 1e-6);
    get_launches(scene, false, 3, out);
    static const double trained[] = {-3.35, 0, 3.35}; /* j = 33, 100, 167 */
    for (int i = 0; i < 3; i++) assert_near(out[i].x, trained[i], 1e-6);
}

/* The discrepancy of a number over its span: the largest difference between the share of launches below a bound and the
   bound's share of the span. Random values would have about 0.1 for 64 launches. */
static double discrepancy(const float *values, int count, double from, double to) {
    double most = 0;
    for (int k = 1; k < 10; k++) {
        int below = 0;
        for (int i = 0; i < count; i++) {
            assert_true((double)values[i] >= from && (double)values[i] <= to);
            below += (double)values[i] < from + 0.1 * k * (to - from);
        }
        most = fmax(most, fabs((double)below / count - 0.1 * k));
    }
    return most;
}

TEST(every_number_of_a_family_is_spread_over_its_span) {
    enum { COUNT = 64 };
    OWN(Scene) *scene =
        good_scene(BASE GROUND "bomb: {x: 3, y: 15, size: [1, 1], frame: 9, mass: {from: 50, to: 200},\n"
                               "  rotation: {from: -1.5, to: 1.5, value: 0}, spin: {from: 10, to: 20}}\n");
    assert_launch(launch_of(scene), (Launch){3, 0, 15, 125, 9}); /* the middle, unless `value` is given */
    Launch launches[2][COUNT];
    float rotation[COUNT], spin[COUNT], mass[COUNT];
    for (int scoring = 0; scoring < 2; scoring++) {
        get_launches(scene, scoring == 1, COUNT, launches[scoring]);
        for (int i = 0; i < COUNT; i++) {
            const Launch *launch = &launches[scoring][i];
            assert_true(launch->x == 3 && launch->frame == 9);
            rotation[i] = launch->rotation;
            spin[i] = launch->spin;
            mass[i] = launch->mass;
        }
        assert_true(discrepancy(rotation, COUNT, -1.5, 1.5) < 0.05);
        assert_true(discrepancy(spin, COUNT, 10, 20) < 0.05);
        assert_true(discrepancy(mass, COUNT, 50, 200) < 0.05);
    }
    for (int i = 0; i < COUNT; i++)
        for (int k = 0; k < COUNT; k++)
            assert_true(launches[0][i].rotation != launches[1][k].rotation &&
                        launches[0][i].mass != launches[1][k].mass);
}

RUN_TESTS(NULL, NULL)
