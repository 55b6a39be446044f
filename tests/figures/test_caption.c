/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Captions for LaTeX: what they state, and that no name breaks them. */
#include "owned.h"
#include "files.h"

#include "figures/figures_internal.h"
#include "figures/run_figure.h"

enum { FRAMES = 61, IMPACT = 30 };

static Trajectory *runs[3];

FIXTURE(make) {
    static const char *const methods[] = {"engine", "momentum:k=20", "pair-net:network=nets/my_net.npz"};
    for (int i = 0; i < 3; i++) {
        TrajectoryContact contact = {
            .a = FIRST_BOX, .b = BOMB_BODY, .point = {1, (float)i}, .normal = {0, 1}, .normal_impulse = 2};
        runs[i] = run_make(methods[i], FRAMES);
        run_position(runs[i], FRAMES - 1, FIRST_BOX)->x += (float)i;
        assert_ok(trajectory_add_contact(runs[i], IMPACT, &contact, &error), error);
        trajectory_end_contacts(runs[i]);
    }
}

FIXTURE(destroy) {
    for (int i = 0; i < 3; i++) trajectory_destroy(runs[i]);
}

/* Draws a figure and returns its caption. */
static char *caption_of(const char *kind_name, FigureSpec spec) {
    Error error = {0};
    FigureFacts facts = {0};
    Sketch sketch = {0};
    const char *path = temporary_path("caption.tex");
    const FigureKind *kind = figure_kind(kind_name, &error);
    spec.facts = &facts;
    assert_ok(kind != NULL && kind->draw(&sketch, &spec, &error), error);
    assert_ok(figure_write_caption(kind, &spec, path, &error), error);
    sketch_free(&sketch);
    return text_of(path);
}

/* Up to the version. */
static void assert_caption(const char *kind, FigureSpec spec, const char *wanted) {
    char *text = caption_of(kind, spec), whole[2000];
    snprintf(whole, sizeof whole, "\\caption{%s Drawn with twinbox~", wanted);
    if (strlen(text) > strlen(whole)) text[strlen(whole)] = '\0';
    assert_string_equal(text, whole);
    free(text);
}

/* As the name of a scene. */
TEST(every_character_stands_for_itself) {
    static const char *const cases[][2] = {{"stack", "stack"},
                                           {"two_boxes", "two\\_boxes"},
                                           {"100% & $5 #1 {x}", "100\\% \\& \\$5 \\#1 \\{x\\}"},
                                           {"a\\b~c^d", "a\\textbackslash{}b\\textasciitilde{}c\\textasciicircum{}d"},
                                           {"a<b>c|d", "a\\textless{}b\\textgreater{}c\\textbar{}d"},
                                           {"a--b---c", "a-{}-b-{}-{}-c"},
                                           {"?`!```'',,", "?{}`!{}`{}`{}`'{}',{},"},
                                           {"Übung Voncilă", "Übung Voncilă"},
                                           {"\\input{/etc/passwd}", "\\textbackslash{}input\\{/etc/passwd\\}"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char before[sizeof runs[0]->scene];
        strcpy(before, runs[0]->scene);
        strcpy(runs[0]->scene, cases[i][0]);
        FREED char *text = caption_of("strobe", spec_of(runs, 1));
        strcpy(runs[0]->scene, before);
        assert_non_null(strstr(text, printed("scene \\texttt{%s} at", cases[i][1])));
    }
}

#define ENGINE "\\texttt{engine} (physics engine, sequential impulses)"
#define MOMENTUM "\\texttt{momentum:k=20} (sequential impulses with momentum)"
#define SCENE "scene \\texttt{two\\_boxes}"

static FigureSpec at_times(int count, double first, double second, double third) {
    FigureSpec spec = spec_of(runs, count);
    spec.time_count = 3;
    spec.times[0] = first, spec.times[1] = second, spec.times[2] = third;
    return spec;
}

TEST(a_strip_names_times_and_rows) {
    assert_caption("strip", at_times(3, 0.1, 0.25, 1),
                   "The " SCENE " at 0.1, 0.25 and 1~s, a column each. Rows from top to bottom: " ENGINE ", " MOMENTUM
                   " and \\texttt{pair-net} (neural network for pairs).");
    FigureSpec named = at_times(1, 0.1, 0.25, 1);
    named.captions[0] = "Ours & 1_st";
    assert_caption("strip", named,
                   "The " SCENE
                   " at 0.1, 0.25 and 1~s, by Ours \\& 1\\_st (\\texttt{engine}, physics engine, sequential "
                   "impulses).");
    FigureSpec many = spec_of(runs, 1);
    many.moments = 11;
    assert_caption("strip", many, "The " SCENE " at 11 moments from 0 to 1~s, by " ENGINE ".");
}

TEST(one_moment_is_named) {
    const char *const text =
        "Contacts of the " SCENE " at 0.483~s: contact points, normals and impulses of the next step. ";
    char wanted[600];
    snprintf(wanted, sizeof wanted, "%sMethod: %s.", text, ENGINE);
    assert_caption("annotated", spec_of(runs, 1), wanted);
    snprintf(wanted, sizeof wanted, "%sFrom left to right: %s and %s.", text, ENGINE, MOMENTUM);
    assert_caption("annotated", spec_of(runs, 2), wanted);
}

TEST(a_divergence_names_the_first_run_and_the_impact) {
    assert_caption("divergence", spec_of(runs, 2),
                   "Runs of the " SCENE " by " MOMENTUM
                   ": largest distance of a body from its position in the run by " ENGINE
                   ", over time. The dashed vertical line marks the impact of the bomb at 0.50~s.");
}

TEST(a_strobe_names_its_moments) {
    assert_caption("strobe", at_times(1, 0.25, 0.5, 0.75),
                   "One run of the " SCENE
                   " at 0.25, 0.5 and 0.75~s in one picture; earlier moments are paler. Method: " ENGINE ".");
}

RUN_TESTS(make, destroy)
