/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Who takes part in a study. */
#include "made.h"

#include "studies/contenders.h"

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

TEST(a_comma_separates_methods_or_settings) {
    OWN(ContenderList) list = parse("engine:k=3,warm=off,momentum:k=20,reference,engine:k=3");
    assert_int_equal(list.count, 4);
    assert_contender(&list, 0, "engine", "k=3,warm=off");
    assert_contender(&list, 1, "momentum", "k=20");
    assert_contender(&list, 2, "reference", "");
    assert_contender(&list, 3, "engine", "k=3");
    assert_string_equal(list.items[0].method.text, "engine:k=3,warm=off");
}

TEST(a_name_alone_stands_for_all_its_settings) {
    OWN(ContenderList) engine = parse("engine"), both = parse("engine,momentum"), all = parse(NULL);
    assert_contender(&engine, 0, "engine", "k=5");
    assert_true(engine.count > 4);
    assert_true(both.count > engine.count);
    assert_contender(&both, engine.count, "momentum", "k=5");
    assert_true(all.count > 2 * both.count);
}

/* The engine with the scene's sweeps is the mark that all others are held to. */
TEST(the_baseline_is_always_there) {
    for (int quick = 0; quick < 2; quick++) {
        OWN(ContenderList) list;
        assert_ok(contenders_parse(&list, NULL, quick ? STUDY_CHART_QUICK : STUDY_CHART, &error), error);
        int found = 0;
        for (int i = 0; i < list.count; i++)
            found += strcmp(list.items[i].name, "engine") == 0 && list.items[i].setting[0] == '\0';
        assert_int_equal(found, 1);
    }
}

TEST(a_method_without_its_network_is_left_out) {
    OWN(Scene) *scene = scene_named("single");
    OWN(ContenderList) list = parse("engine:k=10,pair-net:k=5,pair-net:network=x.npz");
    const Contender *fit[3];
    assert_int_equal(contenders_for(&list, scene, fit), 3);
    scene->network_count = 0;
    assert_int_equal(contenders_for(&list, scene, fit), 2);
    assert_ptr_equal(fit[0], &list.items[0]);
    assert_ptr_equal(fit[1], &list.items[2]);
}

/* A run with the twin of a run's method: the twin with the settings that it names, or else with those of the run. */
static bool has_twin(const ContenderList *list, const Contender *run) {
    const char *twin = run->method.kind->description->twin;
    const bool same = strchr(twin, ':') != NULL || run->setting[0] == '\0';
    const char *text = printed(same ? "%s" : "%s:%s", twin, run->setting);
    for (int i = 0; i < list->count; i++)
        if (strcmp(list->items[i].method.text, text) == 0) return true;
    return false;
}

/* The ablation that must stand beside it. */
TEST(every_learned_method_has_its_twin_in_every_study) {
    for (ContenderStudy study = STUDY_CHART; study <= STUDY_STABILITY; study++) {
        OWN(ContenderList) all;
        assert_ok(contenders_parse(&all, NULL, study, &error), error);
        for (int i = 0; i < all.count; i++)
            if (all.items[i].method.kind->description->twin != NULL && !has_twin(&all, &all.items[i]))
                fail_msg("%s has no twin in study %d", all.items[i].method.text, (int)study);
    }
}

/* Learned: it competes and needs a network. */
TEST(every_learned_method_names_its_twin) {
    int learned = 0;
    for (const MethodKind *kind = method_kinds; kind->description != NULL; kind++) {
        const MethodDescription *method = kind->description;
        assert_int_equal(method->twin != NULL, method->needs_network && method->role == METHOD_COMPETES);
        learned += method->twin != NULL;
    }
    assert_true(learned >= 7); /* pair-net, contact-net, scene-net, sain, hybrid, gns, subspace */
}

/* What is left out is reported. */
TEST(every_method_runs_or_is_left_out) {
    for (ContenderStudy study = STUDY_CHART; study <= STUDY_STABILITY; study++) {
        OWN(ContenderList) all;
        assert_ok(contenders_parse(&all, NULL, study, &error), error);
        const NameList left_out = contenders_left_out(study);
        for (const MethodKind *kind = method_kinds; kind->description != NULL; kind++) {
            char listed[sizeof left_out.text + 4], name[64];
            bool runs = false;
            for (int i = 0; i < all.count; i++) runs |= all.items[i].method.kind == kind;
            snprintf(listed, sizeof listed, ", %s, ", left_out.text);
            snprintf(name, sizeof name, ", %s, ", kind->description->name);
            assert_int_equal(runs, strstr(listed, name) == NULL);
        }
    }
}

RUN_TESTS(NULL, NULL)
