/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "made.h"

#include "figures/plot.h"
#include "figures/sketch.h"
#include "figures/run_figure.h"
#include "pixels/type.h"

#define STACK SOURCE_DIR "/scenes/stack.yaml"

/* The second box of a run departs by a factor of ten every tenth of a second, from the first frame on. */
static Trajectory *run_apart(void) {
    Trajectory *run = run_make("pair-net", 61);
    for (int frame = 0; frame < 61; frame++) run_position(run, frame, SECOND_BOX)->y += powf(10, (float)frame / 6 - 6);
    return run;
}

/* The longest line is neither axis nor guide. */
static const SketchMark *longest_line(const Sketch *sketch) {
    const SketchMark *longest = NULL;
    for (size_t i = 0; i < sketch->mark_count; i++) {
        const SketchMark *mark = &sketch->marks[i];
        if (mark->kind == MARK_PATH && !mark->closed && (longest == NULL || mark->count > longest->count))
            longest = mark;
    }
    return longest;
}

TEST(growth_by_a_factor_is_a_straight_line) {
    Trajectory *runs[] = {run_make("engine", 61), run_apart()};
    FigureSpec spec = spec_of(runs, 2);
    Sketch sketch;
    add_contact(runs[0], 40, (TrajectoryContact){.a = 1, .b = BOMB_BODY});
    trajectory_end_contacts(runs[0]);
    draw_kind(&sketch, "divergence", &spec);
    const SketchMark *line = longest_line(&sketch);
    assert_int_equal(line->count, 61);
    assert_int_equal(line->pen.line, 0xE69F00); /* of pair-net, in the light theme */
    const Point *points = sketch.points + line->first;
    /* float32 positions: distances below a tenth of a millimetre are coarse. */
    double across = (points[60].x - points[0].x) / 60, up = (points[60].y - points[30].y) / 30;
    for (int i = 20; i < 61; i++) {
        assert_near(points[i].x, points[0].x + across * i, 1e-9);
        assert_near(points[i].y, points[60].y - up * (60 - i), 0.05);
    }
    bool impact = false;
    for (size_t i = 0; i < sketch.mark_count; i++) {
        const SketchMark *mark = &sketch.marks[i];
        if (mark->kind == MARK_PATH && mark->pen.dashes != NULL && mark->count == 2)
            impact |= fabs(sketch.points[mark->first].x - points[40].x) < 1e-9;
    }
    assert_true(impact);
    assert_texts(&sketch, "pair-net vs engine", "largest distance (m)", "time (s)", "0.0", "1.0");
    free_drawn(&sketch, runs, 2);
}

/* One frame that differs is a mark at its time, and the label of the axis is on the page. */
TEST(a_frame_alone_is_drawn) {
    Trajectory *runs[] = {run_make("engine", 61), run_make("pair-net", 61)};
    run_position(runs[1], 30, SECOND_BOX)->y += 0.5F;
    FigureSpec spec = spec_of(runs, 2);
    Sketch none, drawn;
    spec.width = FIGURE_WIDTH_MIN;
    draw_kind(&drawn, "divergence", &spec);
    const SketchMark *label = NULL, *dot = NULL;
    for (size_t i = 0; i < drawn.mark_count; i++) {
        const SketchMark *mark = &drawn.marks[i];
        if (mark->kind == MARK_TEXT && strcmp(drawn.texts + mark->text, "largest distance (m)") == 0) label = mark;
        if (mark->kind == MARK_PATH && mark->closed && mark->count > 8) dot = mark;
    }
    assert_true(label != NULL && dot != NULL);
    const double half = type_width("largest distance (m)", spec.points) / 2;
    assert_true(label->at.y - half > 0 && label->at.y + half < drawn.height);
    sketch_free(&drawn);
    *run_position(runs[1], 30, SECOND_BOX) = *run_position(runs[0], 30, SECOND_BOX);
    assert_refused(figure_kind("divergence", &error)->draw(&none, &spec, &error), "never diverges");
    for (int i = 0; i < 2; i++) trajectory_destroy(runs[i]);
}

TEST(a_plot_places_decades_evenly) {
    PlotPanel plot = {.box = {10, 20, 60, 40}, .x = plot_linear_axis(0, 2, ""), .y = plot_log_axis(1e-6, 1e2, "")};
    plot_panel_place(&plot);
    const double decade = plot_place(&plot, 0, 1e-3).y - plot_place(&plot, 0, 1e-4).y;
    for (int power = -6; power < 2; power++)
        assert_near(plot_place(&plot, 0, pow(10, power + 1)).y - plot_place(&plot, 0, pow(10, power)).y, decade, 1e-9);
    assert_near(plot_place(&plot, 0, 1).x, 10, 1e-12);
    assert_near(plot_place(&plot, 1, 1).x, 40, 1e-12);
    assert_true(plot_place(&plot, 0, 1e-6).y > 20 && plot_place(&plot, 0, 1e2).y < 60);
}

static Trajectory *simulate_stack(const char *method_name, float bomb_shift, int frames) {
    OWN(Scene) *scene = scene_from(STACK);
    scene->frames = frames;
    Trajectory *run = run_by(scene, method_name);
    for (int frame = 0; frame <= frames; frame++) run->position[frame * run->bodies + run->bomb].x += bomb_shift;
    return run;
}

/* The band starts with a micrometre, rounded to float32 at the body's position, and every moment has an upper and a
   lower end. */
TEST(the_band_begins_with_the_shift) {
    Trajectory *runs[] = {simulate_stack("engine", 0, 40), simulate_stack("engine", 0.5f, 40)};
    FigureSpec spec = spec_of(runs, 2);
    spec.scene = STACK;
    Sketch sketch;
    draw_kind(&sketch, "divergence", &spec);
    assert_texts(&sketch, "engine, one of 5 bodies shifted by 1 \xC2\xB5m", "impact");
    const SketchMark *band = NULL, *line = longest_line(&sketch);
    for (size_t i = 0; i < sketch.mark_count && band == NULL; i++)
        if (sketch.marks[i].closed && sketch.marks[i].count == 82) band = &sketch.marks[i];
    assert_non_null(band);
    const Point *points = sketch.points + band->first, *line_points = sketch.points + line->first;
    /* The other run's distance is half a metre throughout: 5.7 decades above. */
    for (int i = 0; i <= 40; i++) {
        assert_near(line_points[i].y, line_points[0].y, 1e-3);
        assert_near(points[i].x, line_points[i].x, 1e-9);
        assert_near(points[81 - i].x, line_points[i].x, 1e-9);
        assert_true(points[i].y >= points[81 - i].y);
    }
    assert_near(points[0].y, points[81].y, 1.2); /* the shift, rounded at 5 m and at 0 */
    assert_true(points[40].y > points[0].y + 10);
    free_drawn(&sketch, runs, 2);
}

TEST(what_cannot_be_shown_is_refused) {
    Trajectory *runs[] = {run_make("engine", 11), run_make("engine", 11)};
    FigureSpec spec = spec_of(runs, 2);
    spec.scene = STACK;
    expect_kind_refused("divergence", &spec, "that run does not state its scene_hash");
    runs[0]->scene_hash = 1;
    expect_kind_refused("divergence", &spec, "stack.yaml: error: is not the scene of the run");
    trajectory_destroy(runs[0]);
    trajectory_destroy(runs[1]);
    Trajectory *changed[] = {simulate_stack("engine", 0, 20), simulate_stack("engine", 1, 20)};
    spec = spec_of(changed, 2);
    spec.scene = STACK;
    changed[0]->velocity[7 * changed[0]->bodies + 3].x += 1;
    expect_kind_refused("divergence", &spec, "stack.yaml run again differs from this run from frame 7 on");
    trajectory_destroy(changed[0]);
    trajectory_destroy(changed[1]);
}

RUN_TESTS(NULL, NULL)
