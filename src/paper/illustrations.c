/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/base.h"
#include "base/file.h"
#include "engine/engine.h"
#include "figures/figure.h"
#include "figures/sketch.h"
#include "methods/methods.h"
#include "methods/pair.h"
#include "paper/report.h"
#include "paper/report_internal.h"
#include "pictures/picture.h"
#include "pixels/png.h"
#include "runs/runs.h"
#include "scenes/scenes.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

bool engine_run_begin(EngineRun *run, const Scene *launched, Error *error) {
    *run = (EngineRun){.scene = launched, .tracker = {.impact_frames = launched->bomb.impact_frames}};
    Method engine;
    if (!method_parse(&engine, "engine", error)) return false;
    run->world = scene_world(launched, error);
    if (run->world != NULL) run->stepper = stepper_create(&engine, launched, error);
    if (run->stepper != NULL) return true;
    world_destroy(run->world);
    return false;
}

void engine_run_end(EngineRun *run) {
    stepper_destroy(run->stepper);
    world_destroy(run->world);
}

bool engine_run_step(EngineRun *run, Error *error) {
    const Step step = {.scene = run->scene, .frame = run->frame + 1};
    if (!simulate_step(run->stepper, run->world, &step, error)) return false;
    run->frame++;
    phase_next(&run->tracker, world_problem(run->world), run->frame);
    return true;
}

bool engine_run_to_touch(EngineRun *run, Error *error) {
    while (run->tracker.touch == 0) {
        if (run->frame == run->scene->frames)
            return error_input(error, run->scene->name, "the bomb touches no box in %d steps", run->frame);
        if (!engine_run_step(run, error)) return false;
    }
    return true;
}

Box engine_run_box(const EngineRun *run, int body) {
    const ProblemBody *of = &world_problem(run->world)->bodies[body];
    return box_make(of->position, of->size, of->angle);
}

int next_pair(const ContactProblem *problem, int first) {
    return first < 0 ? 0 : first + pair_contact_count(problem, first);
}

/* Figure 2: a collision of the bomb in the pyramid's run, at true scale. Left: the overlaps along the four axes. Right:
   the contact points from the smallest overlap. */

#define LEAST_TILT 10.0 /* degrees; below it the axes of the two boxes look the same */

static const double illustration_narrow_phase_width = FIGURE_PAGE_WIDTH, illustration_narrow_phase_height = 84,
                    illustration_narrow_phase_split = 97; /* mm */

/* Angle between the sides of two boxes, degrees. */
static double tilt(const ProblemBody *a, const ProblemBody *b) {
    double turned = fmod(fabs((double)b->angle - (double)a->angle) * 180 / M_PI, 90);
    return fmin(turned, 90 - turned);
}

/* The bomb and a movable box, at an angle and with two contact points: a case with all that the caption describes. */
static bool shows_all(const ContactProblem *problem, int first) {
    int a = problem->contacts[first].a, b = problem->contacts[first].b;
    const ProblemBody *body_a = &problem->bodies[a], *body_b = &problem->bodies[b];
    return (a == problem->marked || b == problem->marked) && body_a->inv_mass > 0 && body_b->inv_mass > 0 &&
           pair_contact_count(problem, first) == 2 && tilt(body_a, body_b) >= LEAST_TILT;
}

static bool find_in_step(Collision *collision, const EngineRun *run) {
    const ContactProblem *problem = world_problem(run->world);
    for (int i = next_pair(problem, -1); i < problem->contact_count; i = next_pair(problem, i)) {
        if (!shows_all(problem, i)) continue;
        int a = problem->contacts[i].a, b = problem->contacts[i].b;
        *collision = (Collision){.boxes = {engine_run_box(run, a), engine_run_box(run, b)},
                                 .bodies = {a, b},
                                 .bomb = problem->marked,
                                 .step = run->frame,
                                 .points = 8};
        for (int k = 0; k < 2; k++)
            snprintf(collision->names[k], sizeof collision->names[k], "%s", is_bomb(collision, k) ? "bomb" : "box");
        /* Of two nearly equal overlaps the engine may choose the larger. */
        if (collision_find(collision) && collision->least == least_overlap(collision->overlaps)) return true;
    }
    return false;
}

static bool find_collision(Collision *collision, const Scene *scene, Error *error) {
    EngineRun run;
    if (!engine_run_begin(&run, scene, error)) return false;
    bool ok = true, found = false;
    while (ok && !found && run.frame < scene->frames) {
        ok = engine_run_step(&run, error);
        found = ok && find_in_step(collision, &run);
    }
    engine_run_end(&run);
    if (ok && !found)
        return error_input(error, scene->name, "the bomb touches no box in two points at %g degrees or more",
                           LEAST_TILT);
    return ok;
}

static void illustration_narrow_phase_write_caption(char caption[CAPTION_SIZE], const Collision *c) {
    const AxisOverlap *o = c->overlaps;
    const Manifold *manifold = &c->manifold;
    snprintf(
        caption, CAPTION_SIZE,
        "The narrow phase for bodies %d and %d in step %d of pyramid.yaml, at true scale. The boxes overlap by %.0f "
        "and %.0f mm along the axes of the %s, and by %.0f and %.0f mm along those of the %s. The smallest overlap, "
        "%.0f mm, gives the normal (%s, %s). The incident edge, clipped to the sides of the reference edge, gives two "
        "contact points, %.0f and %.0f mm deep.",
        c->bodies[0], c->bodies[1], c->step, 1000 * o[0].depth, 1000 * o[1].depth, name_of(c, 0), 1000 * o[2].depth,
        1000 * o[3].depth, name_of(c, 1), 1000 * o[c->least].depth, show_decimals((double)manifold->normal.x, 3).text,
        show_decimals((double)manifold->normal.y, 3).text, -1000 * (double)manifold->points[0].separation,
        -1000 * (double)manifold->points[1].separation);
}

static bool illustration_narrow_phase_draw(Sketch *sketch, Scene *const scenes[ILLUSTRATION_SCENES],
                                           char caption[CAPTION_SIZE], Error *error) {
    Collision collision;
    if (!find_collision(&collision, scenes[SCENE_PYRAMID], error)) return false;
    draw_overlaps(
        sketch,
        (View){.low = {1, 0}, .high = {illustration_narrow_phase_split + 4, illustration_narrow_phase_height - 5}},
        &collision);
    draw_contact_closeup(sketch,
                         (View){.low = {illustration_narrow_phase_split, 1},
                                .high = {illustration_narrow_phase_width - 1, illustration_narrow_phase_height - 7}},
                         &collision);
    const TextStyle title = {8.5, TEXT_LEFT, INK, 0, false};
    sketch_text(sketch, (Point){1, illustration_narrow_phase_height - 2.5}, &title,
                "Overlaps along the axes of both boxes");
    sketch_text(sketch, (Point){illustration_narrow_phase_split, illustration_narrow_phase_height - 2.5}, &title,
                "Contact points: separations along the normal");
    illustration_narrow_phase_write_caption(caption, &collision);
    return true;
}

const Illustration illustration_narrow_phase = {illustration_narrow_phase_width, illustration_narrow_phase_height,
                                                illustration_narrow_phase_draw};

/* Figure 3: how training data are made. Left: the bomb's paths in some launches of the sweep. Right: one of the
   recorded rows, with the state of a pair and the change by its own impulses. */

static const double illustration_data_width = FIGURE_PAGE_WIDTH, illustration_data_height = 96,
                    illustration_data_split = 73; /* mm */

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

static bool illustration_data_is_bomb(const SweepRow *row, int i) { return row->bodies[i] == row->bomb; }

static void draw_pair(Sketch *sketch, const SweepRow *row) {
    Vec2 middle = vec2_scale(0.5f, vec2_add(row->boxes[0].position, row->boxes[1].position));
    const View view = {{illustration_data_split, 44},
                       {illustration_data_split + 56, illustration_data_height - 6},
                       {(double)middle.x, (double)middle.y - 0.5},
                       13};
    for (int i = 0; i < 2; i++) {
        const Pen pen = illustration_data_is_bomb(row, i) ? pen_fill(BOMB.fill, 0.3, BOMB.line)
                                                          : pen_fill(BOX_COLOUR, 0.2, BOX_INK);
        sketch_box(sketch, &view, &row->boxes[i], &pen);
        Point at = view_place(&view, row->boxes[i].position);
        Point to = draw_vector(sketch, at, &row->inputs[i == 0 ? VELOCITY_A : VELOCITY_B], ACCENT);
        draw_vector(sketch, to, &row->changes[3 * i], NETWORK_COLOUR);
        const TextStyle name = {8.5, i == 0 ? TEXT_RIGHT : TEXT_LEFT,
                                illustration_data_is_bomb(row, i) ? BOMB.line : BOX_INK, 0, false};
        double side = (i == 0 ? -1 : 1) * view.scale * 0.6;
        sketch_text(sketch, (Point){at.x + side, at.y}, &name, "%c: %s", "ab"[i],
                    illustration_data_is_bomb(row, i) ? "bomb" : "box");
    }
}

/* The legend of arrows and letters. */
static void draw_key(Sketch *sketch) {
    static const char *const arrows[] = {"velocity before", "velocity change"};
    static const char *const letters[] = {"dx, dy: b relative to a", "v: velocity, w: spin", "dv, dw: their changes"};
    const uint32_t colours[] = {ACCENT, NETWORK_COLOUR};
    const TextStyle words = {7.5, TEXT_LEFT, INK, 0, false};
    Point at = {illustration_data_split + 61, illustration_data_height - 11};
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
    const double top = 42, foot = 9, second = illustration_data_split + 34, third = illustration_data_split + 70;
    sketch_rectangle(sketch, (Point){illustration_data_split, foot}, (Point){third - 4, top}, &inputs);
    sketch_rectangle(sketch, (Point){third - 1, foot}, (Point){illustration_data_width - 0.5, top}, &changes);
    sketch_text(sketch, (Point){illustration_data_split + 2, top - 3.5},
                &(TextStyle){8.5, TEXT_LEFT, BOX_INK, 0, false}, "Ten inputs");
    sketch_text(sketch, (Point){third + 1, top - 3.5}, &(TextStyle){8.5, TEXT_LEFT, NETWORK_INK, 0, false}, "Changes");
    draw_numbers(sketch, (Point){illustration_data_split + 2, top - 8.5}, input_names, row->inputs, 5);
    draw_numbers(sketch, (Point){second, top - 8.5}, input_names + 5, row->inputs + 5, 5);
    draw_numbers(sketch, (Point){third + 1, top - 8.5}, change_names, row->changes, 6);
    sketch_text(sketch, (Point){illustration_data_split, 4.5}, &(TextStyle){7.5, TEXT_LEFT, INK, 0, false},
                "The two outputs: velocity change of b relative to a, (%s, %s) m/s",
                show_decimals((double)row->changes[3] - (double)row->changes[0], 3).text,
                show_decimals((double)row->changes[4] - (double)row->changes[1], 3).text);
}

static void illustration_data_write_caption(char caption[CAPTION_SIZE], const SweepRow *row, int rows) {
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
        illustration_data_is_bomb(row, 0) ? "bomb" : "box", changes[0],
        illustration_data_is_bomb(row, 1) ? "bomb" : "box", changes[1]);
}

static bool illustration_data_draw(Sketch *sketch, Scene *const scenes[ILLUSTRATION_SCENES], char caption[CAPTION_SIZE],
                                   Error *error) {
    const View view = {{1, 1}, {illustration_data_split - 6, illustration_data_height - 6}, {0, 7.5}, 5.1};
    SweepRow row;
    int rows;
    if (!sweep_draw(sketch, &view, scenes[SCENE_STACK], &row, &rows, error)) return false;
    sketch_scale_bar(sketch, (Point){3, 4}, view.scale, 2, "m", 7.5);
    sketch_text(sketch, (Point){illustration_data_split - 8, 4}, &(TextStyle){7.5, TEXT_RIGHT, INK, 0, false},
                "dot: first touch");
    draw_pair(sketch, &row);
    draw_key(sketch);
    draw_row(sketch, &row);
    const TextStyle title = {8.5, TEXT_LEFT, INK, 0, false};
    sketch_text(sketch, (Point){1, illustration_data_height - 2.5}, &title, "%d of %d launches",
                (SWEEP_LAUNCHES - 1) / SWEEP_SHOWN_EVERY + 1, SWEEP_LAUNCHES);
    sketch_text(sketch, (Point){illustration_data_split, illustration_data_height - 2.5}, &title,
                "One row: bodies %d and %d, step %d, launch from %s m", row.bodies[0], row.bodies[1], row.step,
                show_decimals((double)sweep_x(SWEEP_ROW_LAUNCH), 1).text);
    illustration_data_write_caption(caption, &row, rows);
    return true;
}

const Illustration illustration_data = {illustration_data_width, illustration_data_height, illustration_data_draw};

static const char *const scene_names[ILLUSTRATION_SCENES] = {"single", "stack", "pyramid"};

static const Illustration *const figures[] = {&illustration_loop, &illustration_narrow_phase, &illustration_data,
                                              &illustration_scenes};

const char *const illustration_names[] = {"loop", "narrow-phase", "data", "scenes", NULL};

static bool write_caption(const char *folder, const char *name, const char *caption, Error *error) {
    char path[PATH_MAX], line[CAPTION_SIZE + 1];
    int length = snprintf(line, sizeof line, "%s\n", caption);
    return file_path(path, sizeof path, error, "%s/%s.txt", folder, name) &&
           file_write(path, line, (size_t)length, error);
}

static bool draw_figure(const Illustration *figure, const char *name, Scene *const *scenes, const char *folder,
                        Error *error) {
    Sketch sketch;
    char stem[PATH_MAX], caption[CAPTION_SIZE] = "";
    if (!file_path(stem, sizeof stem, error, "%s/%s", folder, name)) return false;
    sketch_begin(&sketch, figure->width, figure->height);
    bool drawn = figure->draw(&sketch, scenes, caption, error) && sketch_draw(&sketch, stem, SKETCH_SVG, error);
    sketch_free(&sketch);
    return drawn && write_caption(folder, name, caption, error);
}

static Scene *read_scene(const char *folder, const char *name, Error *error) {
    char path[PATH_MAX];
    if (!file_path(path, sizeof path, error, "%s/%s.yaml", folder, name)) return NULL;
    Scene *scene = scene_read(path, error);
    if (scene == NULL || scene->bomb.present) return scene;
    error_input(error, path, "the scene has no bomb to launch");
    scene_destroy(scene);
    return NULL;
}

bool illustrations_draw(const char *scenes_folder, const char *folder, Error *error) {
    Scene *scenes[ILLUSTRATION_SCENES] = {NULL};
    bool done = true;
    for (int i = 0; done && i < ILLUSTRATION_SCENES; i++) {
        scenes[i] = read_scene(scenes_folder, scene_names[i], error);
        done = scenes[i] != NULL;
    }
    for (size_t i = 0; done && illustration_names[i] != NULL; i++)
        done = draw_figure(figures[i], illustration_names[i], scenes, folder, error);
    for (int i = 0; i < ILLUSTRATION_SCENES; i++) scene_destroy(scenes[i]);
    return done;
}
