/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "owned.h"

#include "figures/run_figure.h"
#include "pixels/type.h"
#include "pictures/mesa.h"

TEST(every_run_has_a_row_and_every_moment_a_column) {
    Trajectory *runs[] = {run_make("engine", 31), run_make("pair-net", 31)};
    FigureSpec spec = spec_of(runs, 2);
    spec.time_count = 3;
    spec.times[0] = 0, spec.times[1] = 0.1, spec.times[2] = 0.5;
    Sketch sketch;
    draw_kind(&sketch, "strip", &spec);
    assert_int_equal(count_marks(&sketch, MARK_IMAGE), 6);
    assert_texts(&sketch, "0.00 s", "0.10 s", "0.50 s", "engine", "pair-net");
    /* Rows in the order of runs, columns in the order of moments, all of equal size, without overlap and inside the
       page. */
    const SketchMark *first = nth_mark(&sketch, MARK_IMAGE, 0);
    double height = first->width * first->image->height / first->image->width;
    for (int i = 0; i < 6; i++) {
        const SketchMark *mark = nth_mark(&sketch, MARK_IMAGE, i);
        assert_near(mark->width, first->width, 1e-9);
        assert_near(mark->at.x, first->at.x + i % 3 * (first->width + 1.2), 1e-9);
        assert_near(mark->at.y, first->at.y - i / 3 * (height + 1.2), 1e-9);
        assert_true(mark->at.x > 0 && mark->at.x + mark->width < sketch.width);
    }
    assert_near(sketch.width, FIGURE_PAGE_WIDTH, 0);
    free_drawn(&sketch, runs, 2);
}

/* Pixels of the images that are light where a box without a label is dark, or dark where it is light. */
static int count_changed(const Sketch *plain, const Sketch *labelled) {
    const Image *a = nth_mark(plain, MARK_IMAGE, 0)->image, *b = nth_mark(labelled, MARK_IMAGE, 0)->image;
    int count = 0;
    for (int i = 0; i < 4 * a->width * a->height; i++) count += abs(a->pixels[i] - b->pixels[i]) > 60;
    return count;
}

/* As text, which can be searched: the picture is the one without. */
TEST(boxes_have_labels) {
    Trajectory *run = run_make("engine", 31);
    run->bomb = -1; /* its target is not drawn where it has a label */
    FigureSpec spec = spec_of(&run, 1);
    spec.moments = 1;
    Sketch plain, labelled;
    draw_kind(&plain, "strip", &spec);
    spec.labels = LOOK_NUMBERS;
    draw_kind(&labelled, "strip", &spec);
    assert_int_equal(count_changed(&plain, &labelled), 0);
    assert_texts(&labelled, "1", "2");
    sketch_free(&labelled);
    spec.labels = LOOK_NAMES;
    expect_kind_refused("strip", &spec, "no body of run 1 (engine) has one");
    free_drawn(&plain, &run, 1);
}

/* A contact that sticks in the reference's run and slips in the other, and one that both have open. */
TEST(modes_of_contacts_are_marked_counted_and_named) {
    Trajectory *runs[] = {run_make("engine", 3), run_make("reference", 3)};
    for (int i = 0; i < 2; i++) {
        TrajectoryContact contact = {.a = GROUND_BODY, .b = FIRST_BOX, .point = {-2, 0}, .normal = {0, 1}};
        add_contact(runs[i], 1, contact);
        contact.feature = 1, contact.normal_impulse = 1;
        add_contact(runs[i], 1, contact);
        trajectory_end_contacts(runs[i]);
    }
    runs[0]->velocity[RUN_BODIES + FIRST_BOX].x = 0.02F;
    FigureSpec spec = spec_of(runs, 2);
    spec.time_count = 1, spec.times[0] = 0;
    Sketch plain, marked;
    draw_kind(&plain, "strip", &spec);
    spec.show = SHOW_MODES;
    draw_kind(&marked, "strip", &spec);
    assert_texts(&marked, "1 of 2 contacts as the reference", "open", "sticks", "slips", "not as the reference");
    /* Two contacts and a circle, and two; four samples and a circle. */
    assert_int_equal(count_marks(&marked, MARK_PATH) - count_marks(&plain, MARK_PATH), 3 + 2 + 5);
    sketch_free(&marked);
    runs[1]->no_velocities = true;
    expect_kind_refused("strip", &spec, "'modes' cannot be shown: run 2 (reference) has no velocities");
    free_drawn(&plain, runs, 2);
}

TEST(moments_go_from_the_first_frame_to_the_last_of_the_shortest_run) {
    Trajectory *runs[] = {run_make("engine", 121), run_make("engine", 61)};
    FigureSpec spec = spec_of(runs, 2);
    spec.moments = 3;
    Sketch sketch;
    draw_kind(&sketch, "strip", &spec);
    assert_texts(&sketch, "0.00 s", "0.50 s", "1.00 s");
    free_drawn(&sketch, runs, 2);
}

/* The window covers the dynamic bodies: the bomb falls from 5.6 m, the boxes stand on the ground, 6 m wide in all. */
TEST(the_window_holds_what_moves) {
    Trajectory *run = run_make("engine", 3);
    FigureSpec spec = spec_of(&run, 1);
    spec.moments = 1;
    Sketch sketch;
    draw_kind(&sketch, "strip", &spec);
    const SketchMark *mark = nth_mark(&sketch, MARK_IMAGE, 0);
    double turned = 0.5 * (2 * cos(0.2) + sin(0.2)), bomb = 0.75 * (cos(0.2) + sin(0.2));
    double wide = 2 + turned + 2.5 + 0.8, low = 0.5 - 0.5 * (cos(0.2) + 2 * sin(0.2)), high = 5.6 + bomb - low + 0.8;
    assert_near((double)mark->image->height / mark->image->width, high / wide, 0.01);
    free_drawn(&sketch, &run, 1);
}

/* A page of a given height: its cells fill it, and the window is wider than the bodies. */
TEST(a_given_height_is_filled) {
    Trajectory *runs[] = {run_make("engine", 3), run_make("engine", 3)};
    FigureSpec spec = spec_of(runs, 2);
    spec.moments = 3, spec.height = 60;
    Sketch sketch;
    draw_kind(&sketch, "strip", &spec);
    const double pixel = 25.4 / spec.dpi;
    assert_near(sketch.height, 60, 2 * pixel);
    const SketchMark *first = nth_mark(&sketch, MARK_IMAGE, 0), *last = nth_mark(&sketch, MARK_IMAGE, 2);
    assert_true(last->at.x + last->width > sketch.width - 1);
    assert_true(first->image->width > first->image->height);
    free_drawn(&sketch, runs, 2);
}

/* Only what is asked for sets the window: the boxes stand near the ground, the bomb falls from 5.6 m. */
TEST(the_bodies_in_question_set_the_window) {
    OWN(Trajectory) *run = run_make("engine", 3);
    *run_position(run, 2, SECOND_BOX) = vec2(-50, 3);
    FigureSpec spec = spec_of(&run, 1);
    spec.moments = 1; /* the last */
    spec.body_count = 1, spec.bodies[0] = FIRST_BOX;
    Sketch sketch;
    draw_kind(&sketch, "strip", &spec);
    const SketchMark *cell = nth_mark(&sketch, MARK_IMAGE, 0);
    const double side = (double)run->size[FIRST_BOX].x, up = (double)run->size[FIRST_BOX].y;
    const double margin = fmin(side, up) / 2;
    assert_near((double)cell->image->height / cell->image->width, (up + 2 * margin) / (side + 2 * margin), 0.01);
    assert_int_equal(count_texts(&sketch, "1 out of view"), 0); /* the second box is not in question */
    sketch_free(&sketch);
    spec.body_count = 1, spec.bodies[0] = run->bodies;
    expect_kind_refused("strip", &spec, "--bodies: error: there is no body");
}

TEST(who_has_left_is_counted) {
    Trajectory *runs[] = {run_make("engine", 3), run_make("pair-net", 3)};
    *run_position(runs[1], 2, FIRST_BOX) = vec2(-50, 3);
    *run_position(runs[1], 2, BOMB_BODY) = vec2(1e30f, -1e30f);
    FigureSpec spec = spec_of(runs, 2);
    spec.moments = 2;
    Sketch sketch;
    draw_kind(&sketch, "strip", &spec);
    assert_int_equal(count_texts(&sketch, "2 out of view"), 1);
    free_drawn(&sketch, runs, 2);
}

static double row_height(const Sketch *sketch) {
    const SketchMark *cell = nth_mark(sketch, MARK_IMAGE, 0);
    return cell->width * cell->image->height / cell->image->width;
}

/* The lines of a name that stands beside its row, turned; their number. */
static int read_turned(const Sketch *sketch, char name[256]) {
    int lines = 0;
    name[0] = '\0';
    for (size_t i = 0; i < sketch->mark_count; i++)
        if (sketch->marks[i].kind == MARK_TEXT && sketch->marks[i].style.degrees == 90) {
            const char *line = sketch->texts + sketch->marks[i].text;
            assert_true(type_width(line, sketch->marks[i].style.points) <= row_height(sketch) + 1e-9);
            if (lines++ > 0) assert_int_equal(name[strlen(name) - 1], ':'); /* no line ends inside a setting */
            text_add(name, 256, "%s", line);
        }
    return lines;
}

/* Whatever the width of the page, the method's name and its settings are there as a whole: turned beside the row in at
   most two lines, or above it in one. */
TEST(names_are_never_cut) {
    static const char *const names[] = {"momentum:k=20", "playback:launches=a-name-that-fits-nowhere.csv"};
    int beside = 0, above = 0;
    for (int i = 0; i < 2; i++) {
        OWN(Trajectory) *run = run_make(names[i], 61);
        FigureSpec spec = spec_of(&run, 1);
        for (int moments = 2; moments <= 12; moments += 5)
            for (spec.width = 60 + 14 * moments; spec.width < 260; spec.width += 41.5) {
                spec.moments = moments;
                Sketch sketch;
                char name[256];
                draw_kind(&sketch, "strip", &spec);
                const int turned = read_turned(&sketch, name);
                assert_in_range(turned, 0, 2);
                if (turned > 0)
                    assert_string_equal(name, names[i]);
                else
                    assert_int_equal(count_texts(&sketch, names[i]), 1);
                beside += turned > 0, above += turned == 0;
                sketch_free(&sketch);
            }
    }
    assert_true(beside > 0 && above > 0);
}

RUN_TESTS(NULL, NULL)
