/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The table of studies, single cases, and complete quick studies. */
#include "made.h"
#include "files.h"

#include "studies/stability.h"
#include "studies/stability_internal.h"

static const char scenes[] = SOURCE_DIR "/scenes";

/* The scan is of a parameter of the scene, within its bounds, and whole if the parameter is. */
static void assert_fits(const Scene *scene, const char *name, const BorderScan *scan) {
    for (int i = 0; i < scene->parameter_count; i++) {
        const SceneParameter *parameter = &scene->parameters[i];
        if (strcmp(parameter->name, name) != 0) continue;
        assert_true(parameter->from <= scan->from && scan->from < scan->to && scan->to <= parameter->to);
        assert_true(parameter->whole == scan->whole);
        assert_true(scan->points >= 2 && scan->points <= BORDER_POINTS_MAX);
        return;
    }
    fail_msg("%s has no %s", scene->name, name);
}

static Scene *read_scene(const char *name) {
    Error error = {0};
    Scene *scene = stability_scene(&(StabilityPlace){.scenes = scenes, .scene = name}, NULL, 0, &error);
    assert_ok(scene != NULL, error);
    return scene;
}

TEST(studies_scan_parameters_of_their_scenes) {
    for (int i = 0; i < stability_study_count; i++) {
        const StabilityStudy *study = &stability_studies[i];
        OWN(Scene) *scene = read_scene(study->scene);
        assert_fits(scene, study->parameter, &study->scan);
        assert_true(study->iterations == (strcmp(study->parameter, "iterations") == 0));
        assert_ptr_equal(stability_study_find(study->name), study);
        assert_true(study->weight > 0);
    }
    for (int i = 0; i < stability_map_count; i++) {
        const StabilityMap *map = &stability_maps[i];
        OWN(Scene) *scene = read_scene(map->scene);
        assert_fits(scene, map->x.parameter, &map->x.scan);
        assert_fits(scene, map->y.parameter, &map->y.scan);
        assert_true(map->iterations == (strcmp(map->y.parameter, "iterations") == 0));
        assert_in_range(map->x.quick_points, 2, map->x.scan.points);
        assert_in_range(map->y.quick_points, 2, map->y.scan.points);
        assert_null(stability_study_find(map->name));
    }
}

/* A stack of n leans by at most width / n a box; a box tips where its centre passes its corner, or where a turn about
   the corner (inertia m (w^2 + h^2) / 3, speed of the top h w) lifts it that far; it slides where the slope exceeds the
   friction, and slides on by v^2 / (2 mu g), here to the edge of the last tile. */
TEST(rigid_answers_follow_from_the_scenes) {
    OWN(Scene) *stairs = read_scene("tilted_stack"), *tip = read_scene("tip"), *kick = read_scene("kick");
    OWN(Scene) *ramp = read_scene("friction_ramp"), *seams = read_scene("seams");
    const BodyDef *slider = &seams->bodies[seams->body_count - 1], *tile = slider - 1;
    const double way = (double)(tile->position.x + tile->size.x / 2 - slider->position.x);
    const double w = (double)kick->bodies[1].size.x, h = (double)kick->bodies[1].size.y;
    const double lift = (sqrt(w * w + h * h) - h) / 2, inertia = (w * w + h * h) / 3;
    const struct {
        const char *study;
        double expected;
    } laws[] = {{"tilted_stack", (double)stairs->bodies[1].size.x / (stairs->body_count - 1)},
                {"tip", (double)(tip->bodies[1].size.x / tip->bodies[1].size.y)},
                {"kick", h * sqrt(-2 * (double)kick->gravity.y * lift / inertia)},
                {"ledge", 0},
                {"friction_ramp", (double)ramp->bodies[1].friction},
                {"seams", sqrt(2 * (double)slider->friction * -(double)seams->gravity.y * way)}};
    int found = 0;
    for (int i = 0; i < stability_study_count; i++) found += stability_studies[i].rigid != NULL;
    assert_int_equal(found, sizeof laws / sizeof laws[0]);
    for (int i = 0; i < found; i++) assert_near(stability_study_find(laws[i].study)->rigid(), laws[i].expected, 1e-6);
}

/* Two steps of the search beside the rigid answer. */
TEST(accurate_methods_find_the_rigid_answers) {
    for (int i = 0; i < stability_study_count; i++) {
        const StabilityStudy *study = &stability_studies[i];
        const StabilityScan scan = {study, scenes, NULL};
        const double apart = 0.02 * (study->scan.to - study->scan.from);
        for (int m = 0; study->rigid != NULL && m < 2; m++) {
            ConvergedRuns converged = {0};
            VerdictReading found[2];
            const Method method = method_named(m > 0 ? "reference" : "interior");
            for (int above = 0; above < 2; above++)
                assert_ok(stability_scan_run(&scan, &method, study->rigid() + (above ? apart : -apart), 0, &converged,
                                             &found[above], &(const ConvergedRun *){NULL}, &error),
                          error);
            if (!verdict_holds(found[0].verdict) || found[1].verdict != VERDICT_FALLS)
                fail_msg("%s by %s: %s, then %s", study->name, method.text, verdict_words[found[0].verdict],
                         verdict_words[found[1].verdict]);
            converged_runs_free(&converged);
        }
    }
}

/* The first dynamic body, by a micrometre; or the bomb, if it is the only one. */
TEST(a_seed_shifts_the_first_dynamic_body) {
    for (int seed = 0; seed < BORDER_SEEDS; seed++) {
        const float by = seed == 0 ? 0 : seed == 1 ? 1e-6f : -1e-6f;
        OWN(Scene) *stack = read_scene("stack_height"), *shot = read_scene("bomb_speed");
        stability_shift(stack, seed);
        stability_shift(shot, seed);
        assert_near(stack->bodies[0].position.x, 0, 0);
        assert_near(stack->bodies[1].position.x, by, 0);
        assert_near(stack->bodies[2].position.x, 0, 0);
        assert_near(shot->bodies[0].position.x, 0, 0);
        assert_near(shot->bomb.x.value, by, 0);
    }
}

TEST(methods_that_do_not_apply_have_a_reason) {
    OWN(Scene) *stack = read_scene("stack_height");
    const Method engine = method_named("engine"), nameless = method_named("scene-net");
    assert_true(stability_applies(&engine, stack, &error));
    assert_refused(stability_applies(&nameless, stack, &error), "names no network");
}

static char *read_table(const char *folder, const char *name) { return text_of(printed("%s/%s.csv", folder, name)); }

/* The stack's network is for ten boxes: with two boxes the first step fails. That must not count as non-finite. */
TEST(a_method_that_fits_some_values_only_does_not_apply) {
    const char *folder = temporary_path("network");
    const StabilityOptions options = {.folder = folder,
                                      .scenes = scenes,
                                      .methods = "scene-net:network=" SOURCE_DIR "/scenes/networks/scene-stack.npz",
                                      .name_count = 1,
                                      .names = {"stack_height"}};
    assert_ok(stability_run(&options, &(Pieces){0}, NULL, &error), error);
    FREED char *borders = read_table(folder, "stability"), *refusals = read_table(folder, "refusals");
    assert_non_null(strstr(borders, ",height,boxes,,,not applicable\n"));
    assert_non_null(strstr(refusals, "the network is for the scene stack of 11 bodies; this one has 3"));
}

TEST(methods_without_k_use_the_scenes_iterations) {
    static const struct {
        const char *method;
        bool takes;
    } rows[] = {{"engine", true},     {"engine:k=10", false}, {"engine:warm=off", true}, {"momentum", true},
                {"reference", false}, {"soft-step", false},   {"contact-net", false}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const Method method = method_named(rows[i].method);
        assert_true(stability_takes_iterations(&method) == rows[i].takes);
    }
}

/* The study of shots at slabs, and its map: ten seconds of one body. Stops after so many progress reports. */
typedef struct Reports {
    int count, stop_after;
} Reports;

static bool count_report(void *context, double done, double total) {
    Reports *reports = context;
    assert_true(done >= 0 && done <= total);
    return ++reports->count != reports->stop_after;
}

static bool run_shots(const char *folder, const char *methods, Reports *reports, Error *error) {
    const StabilityOptions options = {.folder = folder,
                                      .scenes = scenes,
                                      .methods = methods,
                                      .quick = true,
                                      .name_count = 2,
                                      .names = {"bomb_speed", "speed_thickness"}};
    return stability_run(&options, &(Pieces){0}, &(Progress){count_report, reports}, error);
}

/* A box starts with its centre 0.51 m above the top of a slab 0.25 m thick and falls freely for one step. It is then
   pushed out on the nearer side: below, if its centre has passed the slab's. */
TEST(a_study_writes_borders_maps_and_refusals) {
    Reports reports = {0, -1};
    const char *folder = printed("%s", temporary_path("shots"));
    assert_ok(run_shots(folder, "engine,engine:k=3,warm=off,reference,scene-net", &reports, &error), error);
    FREED char *borders = read_table(folder, "stability"), *maps = read_table(folder, "maps");
    FREED char *refusals = read_table(folder, "refusals");
    double holds_at, fails_at;
    assert_non_null(strstr(
        borders, "study,method,setting,parameter,unit,holds_at,fails_at,verdict\nbomb_speed,engine,,speed,m/s,"));
    assert_int_equal(sscanf(strstr(borders, "m/s,") + 4, "%lf,%lf,", &holds_at, &fails_at), 2);
    const double through = 60 * (0.51 + 0.25 / 2) - 10 / 60.0;
    assert_true(holds_at < through && through < fails_at && fails_at <= 1.05 * holds_at);
    assert_non_null(strstr(borders, "\nbomb_speed,engine,\"k=3,warm=off\",speed,m/s,"));
    assert_non_null(strstr(borders, ",tunnels\nbomb_speed,scene-net,,speed,m/s,,,not applicable\n"));
    assert_string_equal(refusals, "study,method,setting,reason\n"
                                  "bomb_speed,scene-net,,scene-net: error: the scene names no network for it: use "
                                  "scene-net:network=FILE\n");
    int lines = 0;
    for (const char *c = maps; *c != '\0'; c++) lines += *c == '\n';
    assert_int_equal(lines, 1 + 2 * 5 * 4); /* two methods, without the reference */
    assert_non_null(strstr(maps, "\nspeed_thickness,engine,,speed,m/s,5,thickness,m,0.1,settles,"));
    assert_non_null(strstr(maps, "\nspeed_thickness,engine,,speed,m/s,200,thickness,m,0.1,tunnels,"));
    assert_true(reports.count > 60);
}

/* Two boxes stay in place; if a network lifts them off within ten seconds, drift and energy are empty. */
TEST(a_study_at_rest_writes_drift_and_energy) {
    const StabilityStudy study = {.name = "two",
                                  .scene = "heavy_on_one",
                                  .parameter = "ratio",
                                  .scan = {.from = 1, .to = 2, .points = 2},
                                  .stands = true,
                                  .rests = true};
    OWN(ContenderList) methods;
    assert_ok(contenders_parse(&methods, "interior,pair-net", STUDY_STABILITY, &error), error);
    StabilityScan scan = {&study, scenes, &methods};
    FREED char *text = NULL;
    size_t size = 0;
    FILE *lines = open_memstream(&text, &size);
    assert_non_null(lines);
    ScanContext context;
    assert_ok(stability_scan_begin(&context, &scan, &error), error);
    assert_ok(stability_scan_write(&context, 0, 2, lines, NULL, &error), error);
    stability_scan_end(&context);
    assert_int_equal(fclose(lines), 0);
    for (int ratio = 1; ratio <= 2; ratio++) {
        double drift, energy;
        const char *start = printed("\nrest:two,interior,,ratio,,%d,settles,3600,", ratio);
        const char *row = strstr(text, start);
        assert_non_null(row);
        assert_int_equal(sscanf(row + strlen(start), "%lf,%lf\n", &drift, &energy), 2);
        assert_true(drift < 1e-6 && drift != energy);
        assert_near(energy, 0, 1e-4);
    }
    const char *lifted = strstr(text, "\nrest:two,pair-net,,ratio,,1,explodes,");
    assert_non_null(lifted);
    assert_memory_equal(strchr(strstr(lifted, "explodes,") + 9, ','), ",,\n", 3);
}

/* Coulomb: a box stands on a slope if and only if its tangent is below the friction. */
TEST(a_map_of_slopes_has_its_border_at_the_friction) {
    const char *folder = printed("%s", temporary_path("slopes"));
    const StabilityOptions options = {.folder = folder,
                                      .scenes = scenes,
                                      .methods = "engine,interior",
                                      .quick = true,
                                      .name_count = 1,
                                      .names = {"slope_friction"}};
    assert_ok(stability_run(&options, &(Pieces){0}, NULL, &error), error);
    FREED char *maps = read_table(folder, "maps");
    int cells = 0;
    for (const char *row = maps; (row = strstr(row, ",slope,,")) != NULL; cells++) {
        double slope, friction;
        char verdict[20];
        row++;
        assert_int_equal(sscanf(row, "slope,,%lf,friction,,%lf,%19[a-z]", &slope, &friction, verdict), 3);
        if ((strcmp(verdict, "settles") == 0) != (slope < friction))
            fail_msg("slope %g on %g %s", slope, friction, verdict);
    }
    assert_int_equal(cells, 2 * 4 * 4);
}

/* Stopped in the map, the finished study is kept; resumed, it gives the same tables as an uninterrupted run. */
TEST(an_interrupted_study_is_resumed) {
    char whole[300], cut[300];
    Reports all = {0, -1}, some = {0, -1}, rest = {0, -1};
    snprintf(whole, sizeof whole, "%s", temporary_path("whole"));
    snprintf(cut, sizeof cut, "%s", temporary_path("cut"));
    assert_ok(run_shots(whole, "engine,momentum", &all, &error), error);
    some.stop_after = all.count - 3;
    assert_false(run_shots(cut, "engine,momentum", &some, &error));
    assert_error(error, ERROR_INTERRUPTED, "speed_thickness 1-20: error: stopped; finished pieces are kept");
    error = (Error){0};
    assert_ok(run_shots(cut, "engine,momentum", &rest, &error), error);
    assert_int_equal(rest.count, 2 * 5 * 4 + 1); /* runs, and the piece itself */
    static const char *const names[] = {"stability", "maps", "refusals", "fallbacks", "rest"};
    for (int i = 0; i < 5; i++) {
        FREED char *expected = read_table(whole, names[i]), *found = read_table(cut, names[i]);
        assert_string_equal(found, expected);
    }
}

RUN_TESTS(NULL, NULL)
