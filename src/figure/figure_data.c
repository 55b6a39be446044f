/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Figure 3: how training data are made. Left the bomb's paths in every so many of the launches of the sweep, right one
   of the rows that they leave: what a pair was, and what its own impulses changed. */
#include "figure/engine_figure.h"
#include "figure/engine_run.h"

#include "common/parse.h"
#include "dynamics/pair.h"
#include "render/style.h"
#include "scene/launch.h"

#include <stdio.h>
#include <string.h>

static const double width = 174, height = 98; /* mm */

/* The paper's sweep (3.3), every how many of its launches are shown, and the one whose row is: the bomb comes down on
   the edge of the highest box, which it turns. */
static const FloatRange sweep = {-5, 0.05, 201};
enum { SHOWN_EVERY = 10, ROW_LAUNCH = 120, PATH_MAX_POINTS = 400, PATH_AFTER = 24 };

/* The first pair of the bomb with a box that can move. */
typedef struct Row {
    int step, bodies[2], bomb;
    Box boxes[2];
    BodyVelocity before[2];
    float inputs[PAIR_INPUTS], changes[PAIR_CHANGES];
} Row;

typedef struct Sweep {
    int launches; /* shown */
    int rows;     /* touching pairs in all steps of the launches shown */
    float x;      /* m, of the launch whose row is shown */
    Row row;
} Sweep;

/* As twinbox dataset records them. */
static void fill_row(Row *row, const ContactProblem *problem, const ContactSolution *solution, int first) {
    pair_inputs(problem, NULL, first, PAIR_RELATIVE, row->inputs);
    pair_changes(problem, solution, first, pair_contact_count(problem, first), row->changes);
}

static void take_row(Row *row, const EngineRun *run) {
    const ContactProblem *problem = world_problem(run->world);
    for (int i = next_pair(problem, -1); i < problem->contact_count; i = next_pair(problem, i)) {
        const int bodies[2] = {problem->contacts[i].a, problem->contacts[i].b};
        bool bomb = bodies[0] == problem->bomb || bodies[1] == problem->bomb;
        if (!bomb || problem->bodies[bodies[0]].inv_mass == 0 || problem->bodies[bodies[1]].inv_mass == 0) continue;
        *row = (Row){.step = run->frame, .bodies = {bodies[0], bodies[1]}, .bomb = problem->bomb};
        for (int k = 0; k < 2; k++) {
            const ProblemBody *body = &problem->bodies[bodies[k]];
            row->boxes[k] = engine_run_box(run, bodies[k]);
            row->before[k] = (BodyVelocity){body->velocity, body->angular_velocity};
        }
        fill_row(row, problem, world_solution(run->world), i);
        return;
    }
}

/* The bomb's way: up to its first touch, and a little farther. */
typedef struct Path {
    int count, touch; /* points; those up to the touch */
    Point points[PATH_MAX_POINTS];
} Path;

static bool run_launch(Sweep *shown, Path *path, const Scene *launched, const View *view, bool wanted, Error *error) {
    EngineRun run;
    if (!engine_run_begin(&run, launched, error)) return false;
    bool ok = true;
    *path = (Path){0};
    while (ok && run.frame < launched->frames) {
        const Body *bodies = world_bodies(run.world);
        int bomb = world_problem(run.world)->bomb, since = run.tracker.touch == 0 ? 0 : run.frame - run.tracker.touch;
        if (bomb >= 0 && since <= PATH_AFTER && path->count < PATH_MAX_POINTS)
            path->points[path->count++] = view_place(view, bodies[bomb].position);
        bool touched = run.tracker.touch != 0;
        ok = engine_run_step(&run, error);
        if (!ok) break;
        if (!touched && run.tracker.touch != 0) {
            path->touch = path->count;
            if (wanted) take_row(&shown->row, &run);
        }
        const ContactProblem *problem = world_problem(run.world);
        for (int i = next_pair(problem, -1); i < problem->contact_count; i = next_pair(problem, i)) shown->rows++;
    }
    engine_run_end(&run);
    return ok;
}

static void put_path(Sketch *sketch, const View *view, const Path *path, bool wanted) {
    const Pen before = pen_line(wanted ? ACCENT : BOMB.fill, wanted ? 3 : 1.2, NULL);
    const Pen dot = pen_fill(wanted ? ACCENT : BOMB.fill, 1, NO_COLOUR);
    (void)view;
    int touch = path->touch > 0 ? path->touch : path->count;
    sketch_path(sketch, path->points, touch, &before);
    if (path->touch > 0) sketch_dot(sketch, path->points[touch - 1], wanted ? 1.1 : 0.7, &dot);
}

static void put_stack(Sketch *sketch, const View *view, const Scene *scene) {
    for (int i = 0; i < scene->body_count; i++) {
        const BodyDef *body = &scene->bodies[i];
        const Box box = box_make(body->position, body->size, body->angle);
        const Pen pen = body->fixed ? pen_fill(GROUND, 1, GROUND_LINE) : pen_fill(BOX_COLOUR, 0.3, BOX_INK);
        sketch_box(sketch, view, &box, &pen);
    }
}

static bool put_sweep(Sketch *sketch, Sweep *shown, const Scene *scene, Error *error) {
    const View view = {{1, 1}, {86, height - 7}, {0, 7.6}, 5.1};
    put_stack(sketch, &view, scene);
    for (int i = 0; i < sweep.count; i += SHOWN_EVERY) {
        Path path;
        Launch launch = launch_of(scene);
        launch.x = range_value(&sweep, i);
        Scene launched = launch_scene(scene, &launch);
        bool wanted = i == ROW_LAUNCH;
        if (!run_launch(shown, &path, &launched, &view, wanted, error)) return false;
        put_path(sketch, &view, &path, wanted);
        if (wanted) shown->x = launch.x;
        shown->launches++;
        BodyDef bomb = scene_bomb_body(&launched);
        if (i % 50 != 0) continue;
        const Box box = box_make(bomb.position, bomb.size, bomb.angle);
        const Pen pen = pen_fill(BOMB.fill, 0.5, BOMB.line);
        sketch_box(sketch, &view, &box, &pen);
    }
    return true;
}

static void put_velocity(Sketch *sketch, Point at, Vec2 velocity, uint32_t colour) {
    const double scale = 1.0; /* mm for 1 m/s */
    Point to = {at.x + scale * (double)velocity.x, at.y + scale * (double)velocity.y};
    sketch_arrow(sketch, at, to, HEAD_AT_END, colour, 2.4);
}

static void put_pair(Sketch *sketch, const Row *row) {
    Vec2 middle = vec2_scale(0.5f, vec2_add(row->boxes[0].position, row->boxes[1].position));
    const View view = {{92, 44}, {width - 1, height - 7}, {(double)middle.x, (double)middle.y}, 14};
    for (int i = 0; i < 2; i++) {
        bool bomb = row->bodies[i] == row->bomb;
        const Pen pen = bomb ? pen_fill(BOMB.fill, 0.2, BOMB.line) : pen_fill(BOX_COLOUR, 0.2, BOX_INK);
        sketch_box(sketch, &view, &row->boxes[i], &pen);
        Point at = view_place(&view, row->boxes[i].position);
        put_velocity(sketch, at, row->before[i].linear, ACCENT);
        put_velocity(sketch, (Point){at.x + 4, at.y}, vec2(row->changes[3 * i], row->changes[3 * i + 1]), NETWORK_INK);
    }
}

static bool draw(Sketch *sketch, Scene *const scenes[FIGURE_SCENES], char caption[CAPTION_SIZE], Error *error) {
    Sweep shown = {0};
    if (!put_sweep(sketch, &shown, scenes[SCENE_STACK], error)) return false;
    put_pair(sketch, &shown.row);
    snprintf(caption, CAPTION_SIZE, "rows %d launches %d x %g", shown.rows, shown.launches, (double)shown.x);
    return true;
}

const EngineFigure figure_data = {width, height, draw};
