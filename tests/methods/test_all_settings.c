/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The settings of a method, given or not. */
#include "base/settings.h"
#include "made.h"

#include "methods/sweeps.h"

static void assert_settings(const char *text, int iterations, const char *wanted) {
    Settings settings;
    char all[1024] = "";
    assert_true(method_all_settings(&settings, text, iterations));
    for (int i = 0; i < settings.count; i++)
        snprintf(all + strlen(all), sizeof all - strlen(all), "%s%s=%s", i > 0 ? "," : "", settings.items[i].key,
                 settings.items[i].value);
    assert_string_equal(all, wanted);
}

/* Contact solvers take k from the scene; steppers have their own. */
TEST(what_is_not_given_is_the_scenes_or_the_methods) {
    assert_settings("engine", 10, "k=10");
    assert_settings("engine:k=20", 10, "k=20");
    assert_settings("engine", 0, "");
    assert_settings("momentum:near=0.02", 7, "near=0.02,k=7");
    assert_settings("avbd", 7, "k=10");
    assert_settings("soft-step", 7, "substeps=4");
    assert_settings("interior", 7, "");
    Settings settings;
    assert_false(method_all_settings(&settings, "nothing", 10));
    assert_false(method_all_settings(&settings, "engine:sweeps=3", 10));
}

/* No method with a k is forgotten. */
TEST(every_method_with_k_has_one) {
    for (const MethodKind *kind = method_kinds; kind->description != NULL; kind++) {
        Settings settings;
        if (kind->description->external) continue; /* its settings are the program's */
        assert_true(method_all_settings(&settings, kind->description->name, 12));
        const char *sweeps = settings_get(&settings, "k");
        assert_int_equal(sweeps != NULL, settings_known(kind->description->settings, "k"));
        if (kind->solver != NULL && sweeps != NULL) assert_string_equal(sweeps, "12");
        if (kind->stepping != NULL && sweeps != NULL) assert_non_null(kind->description->own_settings);
    }
}

/* A solver or stepper of the method with this one setting. */
static void refuse(const MethodKind *kind, const Scene *scene, const char *key, const char *value) {
    Error error = {0};
    Settings settings = {0};
    const char *begins = printed("%s: error: must be ", key);
    assert_true(settings_default(&settings, key, value));
    assert_refused(kind->solver != NULL ? kind->solver->create(&settings, &error)
                                        : kind->stepping->create(&settings, scene, &error),
                   begins);
}

/* Of every number and switch of every method that can be made without a file, whatever the method does with it. */
TEST(settings_out_of_range_are_refused) {
    OWN(Scene) *scene = scene_named("stack");
    int settings = 0;
    for (const MethodKind *kind = method_kinds; kind->description != NULL; kind++) {
        if (kind->description->needs_network && strcmp(kind->description->name, "gns") != 0) continue;
        for (const SettingSpec *spec = kind->description->settings; spec != NULL && spec->key != NULL; spec++) {
            char beyond[32], below[32];
            if (spec->type == SETTING_IS_OWN) continue;
            snprintf(below, sizeof below, "%.9g", spec->least - (spec->least > 0 ? spec->least / 2 : 1));
            snprintf(beyond, sizeof beyond, "%.9g", spec->most + (spec->type == SETTING_IS_INT ? 1 : 0.1));
            const char *const values[] = {spec->type == SETTING_IS_BOOL ? "maybe" : below,
                                          spec->most < 1e6 ? beyond : "x", "nan", "ten"};
            for (int i = 0; i < 4; i++) refuse(kind, scene, spec->key, values[i]);
            settings++;
        }
    }
    assert_true(settings >= 16);
}

RUN_TESTS(NULL, NULL)
