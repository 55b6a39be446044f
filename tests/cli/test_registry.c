/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A solver that only this test has is one definition and one line of the registry. Lists, charts, captions and the
   stability study then know it. */
#include "owned.h"
#include "files.h"
#include "owned_drawings.h"

#include "cli/cli.h"
#include "cli/panels.h"
#include "methods/methods.h"
#include "pictures/pictures_internal.h"
#include "pictures/runs.h"
#include "studies/contenders.h"

static void *create(const Settings *chosen, Error *error) { return solver_engine.create(chosen, error); }

/* Counts each step as one that sweeps solved instead. */
static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    solution->fallbacks.by_sweeps = 1;
    return solver_engine.solve(state, problem, solution, error);
}

static void destroy(void *state) { solver_engine.destroy(state); }

static const ContactSolverKind solver_of_test = {.description = {.name = "of-test",
                                                                 .summary = "a solver that only a test has",
                                                                 .caption = "solver of a test",
                                                                 .falls_back = true},
                                                 .create = create,
                                                 .solve = solve,
                                                 .destroy = destroy};

/* In place of methods/registry.c, which is not linked. */
const MethodKind method_kinds[] = {METHODS(METHOD_KIND_SOLVER, METHOD_KIND_STEPPING)
                                       METHOD_KIND_SOLVER(of_test, LIVE){0}};

/* What a command prints; the caller frees it. */
static char *run_command(bool (*command)(int, char **, Error *), char **argv) {
    Error error = {0};
    const char *path = temporary_path("printed");
    int argc = 0;
    while (argv[argc] != NULL) argc++;
    fflush(stdout);
    const int before = dup(STDOUT_FILENO);
    assert_non_null(freopen(path, "w", stdout));
    const bool same = command(argc, argv, &error);
    fflush(stdout);
    dup2(before, STDOUT_FILENO);
    close(before);
    assert_ok(same, error);
    return text_of(path);
}

/* The command writes a table to the path, and the table has the text. */
static void assert_table_has(bool (*command)(int, char **, Error *), char **argv, const char *path, const char *text) {
    free(run_command(command, argv));
    FREED char *table = text_of(path);
    if (strstr(table, text) == NULL) fail_msg("%s lacks %s", path, text);
}

TEST(methods_lists_it) {
    FREED char *printed = run_command(command_methods, (char *[]){"twinbox methods", NULL});
    assert_non_null(strstr(printed, "\nof-test           a solver that only a test has\n"));
    assert_non_null(strstr(printed, "engine"));
}

TEST(every_study_has_it) {
    for (ContenderStudy study = STUDY_CHART; study <= STUDY_STABILITY; study++) {
        OWN(ContenderList) list;
        assert_ok(contenders_parse(&list, NULL, study, &error), error);
        const Contender *last = &list.items[list.count - 1];
        assert_string_equal(last->name, "of-test");
        assert_string_equal(last->setting, "");
        assert_ptr_equal(last->method.kind->solver, &solver_of_test);
    }
}

TEST(a_chart_scores_it) {
    char folder[256];
    snprintf(folder, sizeof folder, "%s", temporary_path("chart"));
    char *arguments[] = {"twinbox chart",
                         SOURCE_DIR "/scenes/single.yaml",
                         "-o",
                         folder,
                         "--quick",
                         "--methods",
                         "of-test,engine:k=10",
                         NULL};
    assert_table_has(command_chart, arguments, temporary_path("chart/chart.csv"), "\nsingle,of-test,,frozen,impact,5,");
}

TEST(a_border_is_found_for_it) {
    char folder[256];
    snprintf(folder, sizeof folder, "%s", temporary_path("stability"));
    char *arguments[] = {"twinbox stability", "--scenes",   SOURCE_DIR "/scenes", "-o",      folder,
                         "--study",           "bomb_speed", "--methods",          "of-test", NULL};
    assert_table_has(command_stability, arguments, temporary_path("stability/stability.csv"),
                     "\nbomb_speed,of-test,,speed,m/s,");
}

TEST(its_fallbacks_are_counted) {
    char folder[256];
    snprintf(folder, sizeof folder, "%s", temporary_path("fallbacks"));
    char *study[] = {"twinbox stability", "--scenes",   SOURCE_DIR "/scenes", "-o",      folder,
                     "--study",           "bomb_speed", "--methods",          "of-test", NULL};
    free(run_command(command_stability, study));
    char *table = text_of(temporary_path("fallbacks/fallbacks.csv"));
    int steps, by_sweeps;
    assert_non_null(strstr(table, ",by_sweeps\n"));
    assert_int_equal(
        sscanf(strchr(table, '\n'), "\nbomb_speed,of-test,,speed,m/s,%*g,%d,0,0,0,%d\n", &steps, &by_sweeps), 2);
    assert_true(steps > 10);
    assert_int_equal(by_sweeps, steps);
    free(table);
    char *run[] = {"twinbox simulate", SOURCE_DIR "/scenes/single.yaml", "--frames", "7", "--method", "of-test", NULL};
    FREED char *printed = run_command(command_simulate, run);
    assert_non_null(strstr(printed, "\n    steps solved by sweeps instead: 7\n"));
}

TEST(a_picture_has_its_caption) {
    OWN(Picture) picture;
    OWN(Trajectory) *run = run_make("of-test", 2);
    const RenderOptions options = render_defaults(".");
    char name[CAPTION_TEXT_SIZE], note[CAPTION_TEXT_SIZE];
    assert_ok(picture_plan(&picture, (const Trajectory *[]){run}, 1, 640, 360, &error), error);
    assert_ok(picture_apply_options(&picture, &options, &error), error);
    caption_method(&picture, 0, name, note);
    assert_string_equal(name, "of-test");
    assert_string_equal(note, "solver of a test");
}

RUN_TESTS(NULL, NULL)
