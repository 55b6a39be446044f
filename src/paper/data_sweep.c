/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/base.h"
#include "engine/engine.h"
#include "figures/sketch.h"
#include "methods/pair.h"
#include "paper/report_internal.h"
#include "pictures/picture.h"
#include "pixels/png.h"
#include "scenes/scenes.h"

static const FloatRange sweep = {-5, 0.05, SWEEP_LAUNCHES};
enum { PATH_POINTS = 200, BOMB_SHOWN_EVERY = 50 };

float sweep_x(int i) { return range_value(&sweep, i); }

/* The numbers that `twinbox dataset` records. */
static void fill_row(SweepRow *row, const ContactProblem *problem, const ContactSolution *solution, int first) {
    pair_inputs(problem, NULL, first, PAIR_RELATIVE, row->inputs);
    pair_changes(problem, solution, first, pair_contact_count(problem, first), row->changes);
}

static void take_row(SweepRow *row, const EngineRun *run) {
    const ContactProblem *problem = world_problem(run->world);
    for (int i = next_pair(problem, -1); i < problem->contact_count; i = next_pair(problem, i)) {
        const int a = problem->contacts[i].a, b = problem->contacts[i].b;
        bool bomb = a == problem->marked || b == problem->marked;
        if (!bomb || problem->bodies[a].inv_mass == 0 || problem->bodies[b].inv_mass == 0) continue;
        *row = (SweepRow){.step = run->frame,
                          .bodies = {a, b},
                          .bomb = problem->marked,
                          .boxes = {engine_run_box(run, a), engine_run_box(run, b)}};
        fill_row(row, problem, world_solution(run->world), i);
        return;
    }
}

/* The bomb's path up to its first touch. */
typedef struct Path {
    int count;
    Point points[PATH_POINTS];
    bool touches;
} Path;

static void follow(Path *path, const EngineRun *run, const View *view) {
    int bomb = run->scene->body_count;
    if (run->tracker.touch != 0 || world_body_count(run->world) <= bomb || path->count == PATH_POINTS) return;
    path->points[path->count++] = view_place(view, world_bodies(run->world)[bomb].position);
}

static int count_pairs(const ContactProblem *problem) {
    int count = 0;
    for (int i = next_pair(problem, -1); i < problem->contact_count; i = next_pair(problem, i)) count++;
    return count;
}

/* Adds the launch's touching pairs to *rows. row: NULL, or where the row is stored. */
static bool run_launch(Path *path, int *rows, SweepRow *row, const Scene *launched, const View *view, Error *error) {
    EngineRun run;
    if (!engine_run_begin(&run, launched, error)) return false;
    bool ok = true;
    *path = (Path){0};
    while (ok && run.frame < launched->frames) {
        follow(path, &run, view);
        ok = engine_run_step(&run, error);
        if (ok) *rows += count_pairs(world_problem(run.world));
        if (ok && row != NULL && run.tracker.touch == run.frame) take_row(row, &run);
    }
    path->touches = run.tracker.touch != 0;
    engine_run_end(&run);
    return ok;
}

static void draw_stack(Sketch *sketch, const View *view, const Scene *scene) {
    for (int i = 0; i < scene->body_count; i++) {
        const BodyDef *body = &scene->bodies[i];
        const Box box = box_make(body->position, body->size, body->angle);
        const Pen pen = body->fixed ? pen_fill(GROUND, 1, GROUND_LINE) : pen_fill(BOX_COLOUR, 0.3, BOX_INK);
        sketch_box(sketch, view, &box, &pen);
    }
}

static void draw_bomb(Sketch *sketch, const View *view, const Scene *launched, bool named) {
    const BodyDef bomb = scene_bomb_body(launched);
    const Box box = box_make(bomb.position, bomb.size, bomb.angle);
    const Pen pen = pen_fill(BOMB.fill, 0.75, BOMB.line);
    sketch_box(sketch, view, &box, &pen);
    if (!named) return;
    Point at = view_place(view, bomb.position);
    at.y += view->scale * (double)bomb.size.y / 2 + 2.4;
    sketch_text(sketch, at, &(TextStyle){7.5, TEXT_CENTER, INK, 0, false}, "%s m",
                show_decimals((double)bomb.position.x, 1).text);
}

static void draw_path(Sketch *sketch, const Path *path, bool of_row) {
    uint32_t colour = of_row ? ACCENT : BOMB.fill;
    const Pen line = pen_line(colour, of_row ? 2.8 : 1.2, NULL), dot = pen_fill(colour, 1, NO_COLOUR);
    sketch_path(sketch, path->points, path->count, &line);
    if (path->touches) sketch_dot(sketch, path->points[path->count - 1], of_row ? 1 : 0.6, &dot);
}

static bool draw_launch(Sketch *sketch, const View *view, const Scene *scene, int i, SweepRow *row, int *rows,
                        Error *error) {
    Path path;
    Launch launch = launch_of(scene);
    launch.x = sweep_x(i);
    Scene launched = launch_scene(scene, &launch);
    bool of_row = i == SWEEP_ROW_LAUNCH;
    if (!run_launch(&path, rows, of_row ? row : NULL, &launched, view, error)) return false;
    if (i % BOMB_SHOWN_EVERY == 0 || of_row) draw_bomb(sketch, view, &launched, !of_row);
    draw_path(sketch, &path, of_row);
    return true;
}

bool sweep_draw(Sketch *sketch, const View *view, const Scene *scene, SweepRow *row, int *rows, Error *error) {
    *rows = 0;
    *row = (SweepRow){0};
    draw_stack(sketch, view, scene);
    for (int i = 0; i < SWEEP_LAUNCHES; i += SWEEP_SHOWN_EVERY)
        if (!draw_launch(sketch, view, scene, i, row, rows, error)) return false;
    return row->step > 0 || error_input(error, scene->name, "the bomb launched from x = %g m touches no box",
                                        (double)sweep_x(SWEEP_ROW_LAUNCH));
}
