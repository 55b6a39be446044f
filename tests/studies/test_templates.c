/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scenes of `twinbox new` stand without the bomb, as their comments state, with each parameter at both ends. */
#include "made.h"
#include "sanitized.h"

#include "studies/stability.h"

#include <dirent.h>

enum { STEPS = 600 }; /* 10 s; the bomb comes after one */

static const char *const methods[] = {"engine", "momentum", "interior"};

static void check_stands(const char *path, const SceneSetting *settings, int count) {
    static int cases;
    if (cases++ % sampled(4) != 0) return;
    Error error = {0};
    OWN(Scene) *scene = scene_read_with(path, settings, count, &error);
    assert_ok(scene != NULL, error);
    scene->bomb.present = false;
    scene->frames = STEPS;
    for (int i = 0; i < 3; i++) {
        VerdictReading reading;
        const Method method = method_named(methods[i]);
        assert_ok(verdict_run(&reading, scene, &method, 0, &error), error);
        if (!verdict_holds(reading.verdict))
            fail_msg("%s%s: %s %s at body %d, frame %d", path,
                     count > 0 ? printed(" with %s = %g", settings->name, settings->value) : "", methods[i],
                     verdict_name(reading.verdict), reading.body, reading.frame);
    }
}

static void check_template(const char *path) {
    OWN(Scene) *scene = scene_from(path);
    assert_true(scene->bomb.present && scene_span_varies(&scene->bomb.x));
    assert_in_range(scene->parameter_count, 1, 2);
    check_stands(path, NULL, 0);
    for (int i = 0; i < scene->parameter_count; i++) {
        SceneSetting setting = {.value = scene->parameters[i].from};
        strcpy(setting.name, scene->parameters[i].name);
        if (strcmp(setting.name, "bomb_mass") == 0) continue;
        check_stands(path, &setting, 1);
        setting.value = scene->parameters[i].to;
        check_stands(path, &setting, 1);
    }
}

/* All but the pile, which falls into place. In the order of their names: sanitizers take a sample. */
TEST(templates_stand) {
    struct dirent **files;
    const int count = scandir(SOURCE_DIR "/scenes/templates", &files, NULL, alphasort);
    int templates = 0;
    for (int i = 0; i < count; i++) {
        const char *name = files[i]->d_name;
        if (strstr(name, ".yaml") != NULL && strcmp(name, "pile.yaml") != 0) {
            check_template(printed(SOURCE_DIR "/scenes/templates/%s", name));
            templates++;
        }
        free(files[i]);
    }
    free(files);
    assert_true(templates >= 8);
}

/* "At rest when the bomb comes." */
TEST(the_pile_comes_to_rest) {
    static const double values[][2] = {{0.3, 0.4}, {0, 0.4}, {0.7, 0.4}, {0.3, 0.2}, {0.3, 1}};
    for (int i = 0; i < 5 * 3; i += sampled(4)) {
        const SceneSetting settings[] = {{"tilt", values[i % 5][0]}, {"friction", values[i % 5][1]}};
        VerdictReading reading;
        OWN(Scene) *scene = scene_read_with(SOURCE_DIR "/scenes/templates/pile.yaml", settings, 2, &error);
        assert_ok(scene != NULL, error);
        const Method method = method_named(methods[i / 5]);
        scene->bomb.present = false;
        scene->frames = scene->bomb.frame;
        assert_ok(verdict_run(&reading, scene, &method, 0, &error), error);
        if (reading.verdict != VERDICT_SETTLES)
            fail_msg("%s with tilt %g and friction %g: %s, body %d", methods[i / 5], values[i % 5][0], values[i % 5][1],
                     verdict_name(reading.verdict), reading.body);
    }
}

/* "With 10 iterations it falls." */
TEST(the_arch_needs_its_iterations) {
    VerdictReading reading;
    const Method engine = method_named("engine");
    OWN(Scene) *scene = scene_named("templates/arch");
    scene->bomb.present = false;
    scene->frames = STEPS;
    scene->iterations = 10;
    assert_ok(verdict_run(&reading, scene, &engine, 0, &error), error);
    assert_string_equal(verdict_name(reading.verdict), "falls");
}

RUN_TESTS(NULL, NULL)
