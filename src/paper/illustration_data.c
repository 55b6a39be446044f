/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Figure 3: how training data are made. Left: the bomb's paths in some launches of the sweep. Right: one of the
   recorded rows, with the state of a pair and the change by its own impulses. */
#include "base/base.h"
#include "engine/engine.h"
#include "figures/sketch.h"
#include "methods/methods.h"
#include "methods/pair.h"
#include "paper/report_internal.h"
#include "pictures/picture.h"
#include "pixels/png.h"
#include "scenes/scenes.h"

#include <math.h>

/* Every 10th launch of the paper's sweep (3.3) is shown. The row is from the launch where the bomb hits the edge of the
   highest box, pushes it down and turns it. */
enum { SWEEP_LAUNCHES = 201, SWEEP_SHOWN_EVERY = 10, SWEEP_ROW_LAUNCH = 120 };

/* The pair of the bomb and a movable box, at the bomb's first touch. */
typedef struct SweepRow {
    int step, bodies[2], bomb;
    Box boxes[2];
    float inputs[PAIR_INPUTS], changes[PAIR_CHANGES]; /* pair_inputs() with PAIR_RELATIVE; pair_changes() */
} SweepRow;

static const FloatRange sweep = {-5, 0.05, SWEEP_LAUNCHES};
enum { PATH_POINTS = 200, BOMB_SHOWN_EVERY = 50 };

/* x of launch i, m */
static float sweep_x(int i) { return range_value(&sweep, i); }

/* The row has the numbers that `twinbox dataset` records. */
static void take_row(SweepRow *row, const EngineRun *run) {
    const ContactProblem *problem = world_problem(run->world);
    for (int i = 0, count; i < problem->contact_count; i += count) {
        const int a = problem->contacts[i].a, b = problem->contacts[i].b;
        const bool bomb = a == problem->bomb || b == problem->bomb;
        count = pair_contact_count(problem, i);
        if (!bomb || problem->bodies[a].inv_mass == 0 || problem->bodies[b].inv_mass == 0) continue;
        *row = (SweepRow){.step = run->frame,
                          .bodies = {a, b},
                          .bomb = problem->bomb,
                          .boxes = {engine_run_box(run, a), engine_run_box(run, b)}};
        pair_inputs(problem, NULL, i, PAIR_RELATIVE, row->inputs);
        pair_changes(problem, world_solution(run->world), i, count, row->changes);
        return;
    }
}

/* The bomb's path up to its first touch. */
typedef struct Path {
    int count;
    Point points[PATH_POINTS];
    bool touches;
} Path;

/* Adds the launch's touching pairs to *rows. row: NULL, or where the row is stored. */
static bool run_launch(Path *path, int *rows, SweepRow *row, const Scene *launched, const View *view, Error *error) {
    EngineRun run;
    if (!engine_run_begin(&run, launched, error)) return false;
    const int bomb = launched->body_count;
    bool ok = true;
    *path = (Path){0};
    while (ok && run.frame < launched->frames) {
        if (run.tracker.touch == 0 && world_body_count(run.world) > bomb && path->count < PATH_POINTS)
            path->points[path->count++] = view_place(view, world_bodies(run.world)[bomb].position);
        ok = engine_run_step(&run, error);
        const ContactProblem *problem = world_problem(run.world);
        for (int i = 0; ok && i < problem->contact_count; i += pair_contact_count(problem, i)) ++*rows;
        if (ok && row != NULL && run.tracker.touch == run.frame) take_row(row, &run);
    }
    path->touches = run.tracker.touch != 0;
    engine_run_end(&run);
    return ok;
}

static bool draw_launch(Sketch *sketch, const View *view, const Scene *scene, int i, SweepRow *row, int *rows,
                        Error *error) {
    Path path;
    Launch launch = launch_of(scene);
    launch.x = sweep_x(i);
    const Scene launched = launch_scene(scene, &launch);
    const bool of_row = i == SWEEP_ROW_LAUNCH;
    if (!run_launch(&path, rows, of_row ? row : NULL, &launched, view, error)) return false;
    if (i % BOMB_SHOWN_EVERY == 0 || of_row) {
        const BodyDef bomb = scene_bomb_body(&launched);
        const Box box = box_make(bomb.position, bomb.size, bomb.angle);
        const Pen pen = pen_fill(BOMB.fill, 0.75, BOMB.line);
        Point at = view_place(view, bomb.position);
        at.y += view->scale * (double)bomb.size.y / 2 + 2.4;
        sketch_box(sketch, view, &box, &pen);
        if (!of_row)
            sketch_text(sketch, at, &(TextStyle){7.5, TEXT_CENTER, INK, 0, false}, "%s m",
                        show_decimals((double)bomb.position.x, 1).text);
    }
    const uint32_t colour = of_row ? ACCENT : BOMB.fill;
    const Pen line = pen_line(colour, of_row ? 2.8 : 1.2, NULL), dot = pen_fill(colour, 1, NO_COLOUR);
    sketch_path(sketch, path.points, path.count, &line);
    if (path.touches) sketch_dot(sketch, path.points[path.count - 1], of_row ? 1 : 0.6, &dot);
    return true;
}

/* Runs the launches shown to their end, and draws the bomb's path up to its first touch over the scene's initial state.
   *rows: touching pairs, summed over all steps. ERROR_INPUT if the launch of the row touches no box. */
static bool draw_sweep(Sketch *sketch, const View *view, const Scene *scene, SweepRow *row, int *rows, Error *error) {
    *rows = 0;
    *row = (SweepRow){0};
    for (int i = 0; i < scene->body_count; i++) {
        const BodyDef *body = &scene->bodies[i];
        const Box box = box_make(body->position, body->size, body->angle);
        const Pen pen = body->fixed ? pen_fill(GROUND, 1, GROUND_LINE) : pen_fill(BOX_COLOUR, 0.3, BOX_INK);
        sketch_box(sketch, view, &box, &pen);
    }
    for (int i = 0; i < SWEEP_LAUNCHES; i += SWEEP_SHOWN_EVERY)
        if (!draw_launch(sketch, view, scene, i, row, rows, error)) return false;
    return row->step > 0 || error_input(error, scene->name, "the bomb launched from x = %g m touches no box",
                                        (double)sweep_x(SWEEP_ROW_LAUNCH));
}

static const double width = FIGURE_PAGE_WIDTH, height = 96, split = 73; /* mm */

/* In the order of pair_inputs() and pair_changes(). */
typedef struct NumberName {
    const char *name, *unit;
} NumberName;

static const NumberName input_names[PAIR_INPUTS] = {
    {"dx", "m"},    {"dy", "m"},     {"vxa", "m/s"},  {"vya", "m/s"},     {"vxb", "m/s"},
    {"vyb", "m/s"}, {"wa", "rad/s"}, {"wb", "rad/s"}, {"angle a", "rad"}, {"angle b", "rad"}};
static const NumberName change_names[PAIR_CHANGES] = {{"dvxa", "m/s"}, {"dvya", "m/s"}, {"dwa", "rad/s"},
                                                      {"dvxb", "m/s"}, {"dvyb", "m/s"}, {"dwb", "rad/s"}};
static const double speed_scale = 1.1; /* mm for 1 m/s */

enum { VELOCITY_A = 2, VELOCITY_B = 4 }; /* among the inputs */

/* Returns the tip. Arrows shorter than their head are left out. */
static Point draw_vector(Sketch *sketch, Point from, const float *v, uint32_t colour) {
    const double least = 1.5; /* mm */
    const Point to = {from.x + speed_scale * (double)v[0], from.y + speed_scale * (double)v[1]};
    if (hypot(to.x - from.x, to.y - from.y) >= least) sketch_arrow(sketch, from, to, colour, 2.6);
    return to;
}

static bool is_bomb_of(const SweepRow *row, int i) { return row->bodies[i] == row->bomb; }

static void draw_pair(Sketch *sketch, const SweepRow *row) {
    Vec2 middle = vec2_scale(0.5f, vec2_add(row->boxes[0].position, row->boxes[1].position));
    const View view = {{split, 44}, {split + 56, height - 6}, {(double)middle.x, (double)middle.y - 0.5}, 13};
    for (int i = 0; i < 2; i++) {
        const Pen pen = is_bomb_of(row, i) ? pen_fill(BOMB.fill, 0.3, BOMB.line) : pen_fill(BOX_COLOUR, 0.2, BOX_INK);
        sketch_box(sketch, &view, &row->boxes[i], &pen);
        Point at = view_place(&view, row->boxes[i].position);
        Point to = draw_vector(sketch, at, &row->inputs[i == 0 ? VELOCITY_A : VELOCITY_B], ACCENT);
        draw_vector(sketch, to, &row->changes[3 * i], NETWORK_COLOUR);
        const TextStyle name = {8.5, i == 0 ? TEXT_RIGHT : TEXT_LEFT, is_bomb_of(row, i) ? BOMB.line : BOX_INK, 0,
                                false};
        double side = (i == 0 ? -1 : 1) * view.scale * 0.6;
        sketch_text(sketch, (Point){at.x + side, at.y}, &name, "%c: %s", "ab"[i], is_bomb_of(row, i) ? "bomb" : "box");
    }
}

/* The legend of arrows and letters. */
static void draw_key(Sketch *sketch) {
    static const char *const arrows[] = {"velocity before", "velocity change"};
    static const char *const letters[] = {"dx, dy: b relative to a", "v: velocity, w: spin", "dv, dw: their changes"};
    const uint32_t colours[] = {ACCENT, NETWORK_COLOUR};
    const TextStyle words = {7.5, TEXT_LEFT, INK, 0, false};
    Point at = {split + 61, height - 11};
    for (int i = 0; i < 2; i++, at.y -= 5) {
        sketch_arrow(sketch, at, (Point){at.x + 10 * speed_scale, at.y}, colours[i], 2.6);
        sketch_text(sketch, (Point){at.x + 13, at.y}, &words, "%s", arrows[i]);
    }
    sketch_scale_bar(sketch, at, speed_scale, 10, "m/s", 7.5);
    at.y -= 3;
    for (int i = 0; i < 3; i++) sketch_text(sketch, (Point){at.x, at.y -= 5}, &words, "%s", letters[i]);
}

/* Names, numbers and units in a column from `at` down. */
static void draw_numbers(Sketch *sketch, Point at, const NumberName *names, const float *numbers, int count) {
    const TextStyle name = {7.5, TEXT_LEFT, INK, 0, false}, number = {7.5, TEXT_RIGHT, INK, 0, false};
    const TextStyle unit = {7.5, TEXT_LEFT, INK, 0, false};
    for (int i = 0; i < count; i++, at.y -= 4.2) {
        sketch_text(sketch, at, &name, "%s", names[i].name);
        sketch_text(sketch, (Point){at.x + 19.5, at.y}, &number, "%s", show_decimals((double)numbers[i], 3).text);
        sketch_text(sketch, (Point){at.x + 20.5, at.y}, &unit, "%s", names[i].unit);
    }
}

static void draw_row(Sketch *sketch, const SweepRow *row) {
    const Pen inputs = pen_fill(BOX_COLOUR, 0.08, BOX_INK), changes = pen_fill(NETWORK_COLOUR, 0.2, NETWORK_INK);
    const double top = 42, foot = 9, second = split + 34, third = split + 70;
    sketch_rectangle(sketch, (Point){split, foot}, (Point){third - 4, top}, &inputs);
    sketch_rectangle(sketch, (Point){third - 1, foot}, (Point){width - 0.5, top}, &changes);
    sketch_text(sketch, (Point){split + 2, top - 3.5}, &(TextStyle){8.5, TEXT_LEFT, BOX_INK, 0, false}, "Ten inputs");
    sketch_text(sketch, (Point){third + 1, top - 3.5}, &(TextStyle){8.5, TEXT_LEFT, NETWORK_INK, 0, false}, "Changes");
    draw_numbers(sketch, (Point){split + 2, top - 8.5}, input_names, row->inputs, 5);
    draw_numbers(sketch, (Point){second, top - 8.5}, input_names + 5, row->inputs + 5, 5);
    draw_numbers(sketch, (Point){third + 1, top - 8.5}, change_names, row->changes, 6);
    sketch_text(sketch, (Point){split, 4.5}, &(TextStyle){7.5, TEXT_LEFT, INK, 0, false},
                "The two outputs: velocity change of b relative to a, (%s, %s) m/s",
                show_decimals((double)row->changes[3] - (double)row->changes[0], 3).text,
                show_decimals((double)row->changes[4] - (double)row->changes[1], 3).text);
}

static bool draw_data(Sketch *sketch, Scene *const scenes[ILLUSTRATION_SCENES], char caption[CAPTION_SIZE],
                      Error *error) {
    const View view = {{1, 1}, {split - 6, height - 6}, {0, 7.5}, 5.1};
    const TextStyle title = {8.5, TEXT_LEFT, INK, 0, false};
    SweepRow row;
    int rows;
    if (!draw_sweep(sketch, &view, scenes[SCENE_STACK], &row, &rows, error)) return false;
    sketch_scale_bar(sketch, (Point){3, 4}, view.scale, 2, "m", 7.5);
    sketch_text(sketch, (Point){split - 8, 4}, &(TextStyle){7.5, TEXT_RIGHT, INK, 0, false}, "dot: first touch");
    draw_pair(sketch, &row);
    draw_key(sketch);
    draw_row(sketch, &row);
    sketch_text(sketch, (Point){1, height - 2.5}, &title, "%d of %d launches",
                (SWEEP_LAUNCHES - 1) / SWEEP_SHOWN_EVERY + 1, SWEEP_LAUNCHES);
    sketch_text(sketch, (Point){split, height - 2.5}, &title, "One row: bodies %d and %d, step %d, launch from %s m",
                row.bodies[0], row.bodies[1], row.step, show_decimals((double)sweep_x(SWEEP_ROW_LAUNCH), 1).text);
    char changes[2][2 * sizeof(ShownDecimals) + 2];
    for (int i = 0; i < 2; i++)
        snprintf(changes[i], sizeof changes[i], "%s, %s", show_decimals((double)row.changes[3 * i], 2).text,
                 show_decimals((double)row.changes[3 * i + 1], 2).text);
    snprintf(
        caption, CAPTION_SIZE,
        "How training data are made. In stack.yaml the bomb is launched from %d places, x = %s to %s m (every %dth is "
        "shown). Each touching pair gives one row per step, %d rows for the launches shown. Right: the row of bodies "
        "%d and %d in step %d of the launch from x = %s m. It has ten inputs and the changes by the pair's impulses, "
        "which change the velocity of the %s by (%s) m/s and that of the %s by (%s) m/s.",
        SWEEP_LAUNCHES, show_decimals((double)sweep_x(0), 0).text,
        show_decimals((double)sweep_x(SWEEP_LAUNCHES - 1), 0).text, SWEEP_SHOWN_EVERY, rows, row.bodies[0],
        row.bodies[1], row.step, show_decimals((double)sweep_x(SWEEP_ROW_LAUNCH), 1).text,
        is_bomb_of(&row, 0) ? "bomb" : "box", changes[0], is_bomb_of(&row, 1) ? "bomb" : "box", changes[1]);
    return true;
}

const Illustration illustration_data = {width, height, draw_data};
