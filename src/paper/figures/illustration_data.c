/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Figure 3: how training data are made. Left: the bomb's paths in some launches of the sweep. Right: one of the
   recorded rows, with the state of a pair and the change by its own impulses. */
#include "paper/figures/data_sweep.h"
#include "paper/figures/illustration_parts.h"

#include "picture/style.h"

#include <math.h>
#include <stdio.h>

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
    if (hypot(to.x - from.x, to.y - from.y) >= least) sketch_arrow(sketch, from, to, HEAD_AT_END, colour, 2.6);
    return to;
}

static bool is_bomb(const SweepRow *row, int i) { return row->bodies[i] == row->bomb; }

static void draw_pair(Sketch *sketch, const SweepRow *row) {
    Vec2 middle = vec2_scale(0.5f, vec2_add(row->boxes[0].position, row->boxes[1].position));
    const View view = {{split, 44}, {split + 56, height - 6}, {(double)middle.x, (double)middle.y - 0.5}, 13};
    for (int i = 0; i < 2; i++) {
        const Pen pen = is_bomb(row, i) ? pen_fill(BOMB.fill, 0.3, BOMB.line) : pen_fill(BOX_COLOUR, 0.2, BOX_INK);
        sketch_box(sketch, &view, &row->boxes[i], &pen);
        Point at = view_place(&view, row->boxes[i].position);
        Point to = draw_vector(sketch, at, &row->inputs[i == 0 ? VELOCITY_A : VELOCITY_B], ACCENT);
        draw_vector(sketch, to, &row->changes[3 * i], NETWORK_COLOUR);
        const TextStyle name = {8.5, i == 0 ? TEXT_RIGHT : TEXT_LEFT, is_bomb(row, i) ? BOMB.line : BOX_INK, 0, false};
        double side = (i == 0 ? -1 : 1) * view.scale * 0.6;
        sketch_text(sketch, (Point){at.x + side, at.y}, &name, "%c: %s", "ab"[i], is_bomb(row, i) ? "bomb" : "box");
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
        sketch_arrow(sketch, at, (Point){at.x + 10 * speed_scale, at.y}, HEAD_AT_END, colours[i], 2.6);
        sketch_text(sketch, (Point){at.x + 13, at.y}, &words, "%s", arrows[i]);
    }
    sketch_scale_bar(sketch, at, speed_scale, 10, "m/s", 7.5);
    at.y -= 3;
    for (int i = 0; i < 3; i++) sketch_text(sketch, (Point){at.x, at.y -= 5}, &words, "%s", letters[i]);
}

/* Names, numbers and units in a column from `at` down. */
static void draw_numbers(Sketch *sketch, Point at, const NumberName *names, const float *numbers, int count) {
    const TextStyle name = {7.5, TEXT_LEFT, INK_SOFT, 0, false}, number = {7.5, TEXT_RIGHT, INK, 0, false};
    const TextStyle unit = {7.5, TEXT_LEFT, INK_SOFT, 0, false};
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

static void write_caption(char caption[CAPTION_SIZE], const SweepRow *row, int rows) {
    char changes[2][2 * sizeof(ShownDecimals) + 2];
    for (int i = 0; i < 2; i++)
        snprintf(changes[i], sizeof changes[i], "%s, %s", show_decimals((double)row->changes[3 * i], 2).text,
                 show_decimals((double)row->changes[3 * i + 1], 2).text);
    snprintf(
        caption, CAPTION_SIZE,
        "How training data are made. In stack.yaml the bomb is launched from %d places, x = %s to %s m (every %dth is "
        "shown). Each touching pair gives one row per step, %d rows for the launches shown. Right: the row of bodies "
        "%d and %d in step %d of the launch from x = %s m. It has ten inputs and the changes by the pair's impulses, "
        "which change the velocity of the %s by (%s) m/s and that of the %s by (%s) m/s.",
        SWEEP_LAUNCHES, show_decimals((double)sweep_x(0), 0).text,
        show_decimals((double)sweep_x(SWEEP_LAUNCHES - 1), 0).text, SWEEP_SHOWN_EVERY, rows, row->bodies[0],
        row->bodies[1], row->step, show_decimals((double)sweep_x(SWEEP_ROW_LAUNCH), 1).text,
        is_bomb(row, 0) ? "bomb" : "box", changes[0], is_bomb(row, 1) ? "bomb" : "box", changes[1]);
}

static bool draw(Sketch *sketch, Scene *const scenes[ILLUSTRATION_SCENES], char caption[CAPTION_SIZE], Error *error) {
    const View view = {{1, 1}, {split - 6, height - 6}, {0, 7.5}, 5.1};
    SweepRow row;
    int rows;
    if (!sweep_draw(sketch, &view, scenes[SCENE_STACK], &row, &rows, error)) return false;
    sketch_scale_bar(sketch, (Point){3, 4}, view.scale, 2, "m", 7.5);
    sketch_text(sketch, (Point){split - 8, 4}, &(TextStyle){7.5, TEXT_RIGHT, INK, 0, false}, "dot: first touch");
    draw_pair(sketch, &row);
    draw_key(sketch);
    draw_row(sketch, &row);
    const TextStyle title = {8.5, TEXT_LEFT, INK, 0, false};
    sketch_text(sketch, (Point){1, height - 2.5}, &title, "%d of %d launches",
                (SWEEP_LAUNCHES - 1) / SWEEP_SHOWN_EVERY + 1, SWEEP_LAUNCHES);
    sketch_text(sketch, (Point){split, height - 2.5}, &title, "One row: bodies %d and %d, step %d, launch from %s m",
                row.bodies[0], row.bodies[1], row.step, show_decimals((double)sweep_x(SWEEP_ROW_LAUNCH), 1).text);
    write_caption(caption, &row, rows);
    return true;
}

const Illustration illustration_data = {width, height, draw};
