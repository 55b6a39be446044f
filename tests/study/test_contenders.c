/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Who takes part in a study. */
#include "testing.h"

#include "study/contenders.h"

static ContenderList parse(const char *text) {
    Error error = {0};
    ContenderList list;
    assert_ok(contenders_parse(&list, text, STUDY_CHART, &error), error);
    return list;
}

static void assert_contender(const ContenderList *list, int i, const char *name, const char *setting) {
    assert_true(i < list->count);
    assert_string_equal(list->items[i].name, name);
    assert_string_equal(list->items[i].setting, setting);
}

static void a_comma_separates_methods_or_settings(void **state) {
    (void)state;
    ContenderList list = parse("engine:k=3,warm=off,momentum:k=20,constant,engine:k=3");
    assert_int_equal(list.count, 4);
    assert_contender(&list, 0, "engine", "k=3,warm=off");
    assert_contender(&list, 1, "momentum", "k=20");
    assert_contender(&list, 2, "constant", "");
    assert_contender(&list, 3, "engine", "k=3");
    assert_string_equal(list.items[0].method.text, "engine:k=3,warm=off");
    contenders_free(&list);
}

static void a_name_alone_stands_for_all_its_settings(void **state) {
    (void)state;
    ContenderList engine = parse("engine"), both = parse("engine,momentum"), all = parse(NULL);
    assert_contender(&engine, 0, "engine", "k=1");
    assert_true(engine.count > 8);
    assert_true(both.count > engine.count);
    assert_contender(&both, engine.count, "momentum", "k=5");
    assert_true(all.count > 2 * both.count);
    contenders_free(&engine);
    contenders_free(&both);
    contenders_free(&all);
}

/* The engine as shipped is the mark that all others are held to. */
static void the_engine_as_shipped_is_always_there(void **state) {
    (void)state;
    for (int quick = 0; quick < 2; quick++) {
        Error error = {0};
        ContenderList list;
        assert_ok(contenders_parse(&list, NULL, quick ? STUDY_CHART_QUICK : STUDY_CHART, &error), error);
        int found = 0;
        for (int i = 0; i < list.count; i++)
            found += strcmp(list.items[i].name, "engine") == 0 && strcmp(list.items[i].setting, "k=10") == 0;
        assert_int_equal(found, 1);
        contenders_free(&list);
    }
}

static void refuse(const char *text, const char *reason) {
    Error error = {0};
    ContenderList list;
    assert_false(contenders_parse(&list, text, STUDY_CHART, &error));
    assert_error(error, ERROR_INPUT, reason);
}

static void bad_lists_are_refused(void **state) {
    (void)state;
    refuse("engin", "method: error: 'engin' is not a method");
    refuse("engine,", "is not a method");
    refuse("", "is not a method");
    refuse("engine:k=3,engine:k=3", "engine:k=3: error: is given twice");
    refuse("engine,engine:k=10", "is given twice");
    refuse("engine:sweeps=3", "'sweeps' is not a setting");
    char text[1000];
    memset(text, 'x', sizeof text);
    text[999] = '\0';
    refuse(text, "too long");
}

static void a_method_without_its_network_is_left_out(void **state) {
    (void)state;
    Error error = {0};
    Scene *scene = scene_read(SOURCE_DIR "/scenes/single.yaml", &error);
    assert_ok(scene != NULL, error);
    ContenderList list = parse("engine:k=10,pair-net,pair-net:network=x.npz");
    const Contender *fit[3];
    assert_int_equal(contenders_for(&list, scene, fit), 3);
    scene->network_count = 0;
    assert_int_equal(contenders_for(&list, scene, fit), 2);
    assert_ptr_equal(fit[0], &list.items[0]);
    assert_ptr_equal(fit[1], &list.items[2]);
    contenders_free(&list);
    scene_destroy(scene);
}

/* The ablation that a chart must show beside it. */
static void every_learned_method_has_a_twin_that_is_charted(void **state) {
    (void)state;
    ContenderList all = parse(NULL);
    int learned = 0;
    for (const MethodKind *kind = method_kinds; kind->description != NULL; kind++) {
        const MethodDescription *method = kind->description;
        assert_int_equal(method->twin != NULL, method->needs_network && method->role == METHOD_COMPETES);
        if (method->twin == NULL) continue;
        Error error = {0};
        Method twin;
        assert_ok(method_parse(&twin, method->twin, &error), error);
        int found = 0;
        for (int i = 0; i < all.count; i++) found += strcmp(all.items[i].method.text, method->twin) == 0;
        for (int i = 0; i < all.count && strchr(method->twin, ':') == NULL; i++)
            found += strcmp(all.items[i].name, method->twin) == 0;
        assert_true(found > 0);
        learned++;
    }
    assert_int_equal(learned, 4);
    contenders_free(&all);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_comma_separates_methods_or_settings),
                                       cmocka_unit_test(a_name_alone_stands_for_all_its_settings),
                                       cmocka_unit_test(every_learned_method_has_a_twin_that_is_charted),
                                       cmocka_unit_test(the_engine_as_shipped_is_always_there),
                                       cmocka_unit_test(bad_lists_are_refused),
                                       cmocka_unit_test(a_method_without_its_network_is_left_out)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
