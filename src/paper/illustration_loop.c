/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Figure 1: the operational loop, with the counts of the step after the bomb's first touch. In that step each stage
   finds fewer pairs than the one before. */
#include "base/base.h"
#include "engine/engine.h"
#include "figures/sketch.h"
#include "methods/pair.h"
#include "paper/report_internal.h"
#include "pictures/picture.h"
#include "scenes/scenes.h"

#include <math.h>
#include <stdlib.h>

enum { PAPER_OUTPUTS = 2 }; /* the change of the relative velocity along x and y */

typedef struct StepCounts {
    int bodies, moving, could_touch, candidates, touching, points, warm, sweeps, step;
    double steps_a_second; /* 1/s */
    double gravity;        /* m/s that it adds in a step */
    double bomb_moved;     /* m */
} StepCounts;

/* Repeats the broad phase, whose result the world does not keep. -1 if out of memory. */
static int count_candidates(const EngineRun *run) {
    const ContactProblem *problem = world_problem(run->world);
    size_t count = (size_t)problem->body_count;
    Bounds *bounds = malloc(count * sizeof *bounds);
    bool *fixed = malloc(count * sizeof *fixed);
    PairList list = {0};
    int candidates = -1;
    if (bounds != NULL && fixed != NULL) {
        for (int i = 0; i < problem->body_count; i++) {
            Box box = engine_run_box(run, i);
            bounds[i] = bounds_of_box(&box);
            fixed[i] = problem->bodies[i].inv_mass == 0;
        }
        if (broad_phase_find(&list, bounds, fixed, problem->body_count)) candidates = (int)list.count;
    }
    free(bounds);
    free(fixed);
    free(list.pairs);
    return candidates;
}

static bool count_step(StepCounts *counts, const EngineRun *run, Error *error) {
    const ContactProblem *problem = world_problem(run->world);
    const Scene *scene = run->scene;
    *counts = (StepCounts){.bodies = problem->body_count,
                           .candidates = count_candidates(run),
                           .points = problem->contact_count,
                           .sweeps = scene->iterations,
                           .step = run->frame,
                           .steps_a_second = 1 / (double)scene->dt,
                           .gravity = (double)(scene->dt * hypotf(scene->gravity.x, scene->gravity.y))};
    for (int i = 0; i < problem->body_count; i++) counts->moving += problem->bodies[i].inv_mass > 0;
    int fixed = counts->bodies - counts->moving;
    counts->could_touch = counts->bodies * (counts->bodies - 1) / 2 - fixed * (fixed - 1) / 2;
    for (int i = 0; i < problem->contact_count; i++) counts->warm += problem->contacts[i].warm_normal != 0;
    for (int i = 0; i < problem->contact_count; i += pair_contact_count(problem, i)) counts->touching++;
    Vec2 v = world_bodies(run->world)[problem->bomb].velocity;
    counts->bomb_moved = (double)(scene->dt * hypotf(v.x, v.y));
    return counts->candidates >= 0 || error_memory(error, "figure");
}

/* mm */
static const double box_width = 51, box_height = 20, column = 60.5, low_row = 23, high_row = 55;

static Point corner(int column_number, double row) { return (Point){1 + column * column_number, row}; }

enum { STAGES = 6, SOLVING = 4, LINE_SIZE = 96 };

static void draw_stages(Sketch *sketch, const StepCounts *c) {
    static const char *const titles[STAGES] = {"1  Broad phase",     "2  Narrow phase",       "3  Gravity",
                                               "4  Contact problem", "5  Constraint solving", "6  Integration"};
    const Point places[STAGES] = {corner(0, high_row), corner(1, high_row), corner(2, high_row),
                                  corner(2, low_row),  corner(1, low_row),  corner(0, low_row)};
    const Pen stage = pen_fill(BOX_COLOUR, 0.08, BOX_INK), solving = pen_fill(NETWORK_COLOUR, 0.3, NETWORK_INK);
    char lines[STAGES][2][LINE_SIZE];
    snprintf(lines[0][0], LINE_SIZE, "Bounding boxes of %d bodies:", c->bodies);
    snprintf(lines[0][1], LINE_SIZE, "%d of %d pairs overlap", c->candidates, c->could_touch);
    snprintf(lines[1][0], LINE_SIZE, "%d of these pairs touch: %d arbiters", c->touching, c->touching);
    snprintf(lines[1][1], LINE_SIZE, "with %d contact points", c->points);
    snprintf(lines[2][0], LINE_SIZE, "Adds %.3f m/s to the", c->gravity);
    snprintf(lines[2][1], LINE_SIZE, "velocities of %d bodies", c->moving);
    snprintf(lines[3][0], LINE_SIZE, "%d points: mass, bias, friction", c->points);
    snprintf(lines[3][1], LINE_SIZE, "Warm start at %d of them", c->warm);
    snprintf(lines[4][0], LINE_SIZE, "%d sweeps over %d points:", c->sweeps, c->points);
    snprintf(lines[4][1], LINE_SIZE, "%d pairs of impulses", c->sweeps * c->points);
    snprintf(lines[5][0], LINE_SIZE, "New velocities move %d bodies", c->moving);
    snprintf(lines[5][1], LINE_SIZE, "for 1/%.4g s, the bomb %.2f m", c->steps_a_second, c->bomb_moved);
    for (int i = 0; i < STAGES; i++) {
        const Point at = places[i];
        const TextStyle heading = {9, TEXT_LEFT, i == SOLVING ? NETWORK_INK : BOX_INK, 0, false},
                        words = {7.5, TEXT_LEFT, INK, 0, false};
        sketch_rectangle(sketch, at, (Point){at.x + box_width, at.y + box_height}, i == SOLVING ? &solving : &stage);
        sketch_text(sketch, (Point){at.x + 2.5, at.y + 15.8}, &heading, "%s", titles[i]);
        sketch_text(sketch, (Point){at.x + 2.5, at.y + 9.2}, &words, "%s", lines[i][0]);
        sketch_text(sketch, (Point){at.x + 2.5, at.y + 4.4}, &words, "%s", lines[i][1]);
    }
}

/* From stage to stage, then the network below the fifth. */
static void draw_arrows_and_network(Sketch *sketch, const StepCounts *counts) {
    const double low = low_row + box_height / 2, high = high_row + box_height / 2;
    const double left = 1 + box_width / 2, right = left + 2 * column;
    for (int i = 0; i < 2; i++) {
        const double end = corner(i, 0).x + box_width, begin = corner(i + 1, 0).x;
        sketch_arrow(sketch, (Point){end + 0.8, high}, (Point){begin - 0.8, high}, INK, 2);
        sketch_arrow(sketch, (Point){begin - 0.8, low}, (Point){end + 0.8, low}, INK, 2);
    }
    const double top = low_row + box_height + 0.8, bottom = high_row - 0.8;
    sketch_arrow(sketch, (Point){right, bottom}, (Point){right, top}, INK, 2);
    sketch_arrow(sketch, (Point){left, top}, (Point){left, bottom}, INK, 2);

    const Pen pen = {NETWORK_COLOUR, 0.12, NETWORK_INK, 1.6, "(12,6)"};
    const Point from = {corner(1, 0).x - 20, 1}, to = {from.x + box_width + 40, 15};
    const TextStyle heading = {9, TEXT_CENTER, NETWORK_INK, 0, false}, words = {7.5, TEXT_CENTER, INK, 0, false};
    const double middle = (from.x + to.x) / 2;
    sketch_rectangle(sketch, from, to, &pen);
    sketch_text(sketch, (Point){middle, 11}, &heading, "Neural network, in place of the solver");
    sketch_text(sketch, (Point){middle, 5}, &words, "%d predictions, one per touching pair: %d inputs, %d outputs",
                counts->touching, PAIR_INPUTS, PAPER_OUTPUTS);
    sketch_arrow(sketch, (Point){middle, to.y + 0.6}, (Point){middle, low_row - 0.8}, NETWORK_INK, 2);
}

static bool draw_loop(Sketch *sketch, Scene *const scenes[ILLUSTRATION_SCENES], char caption[CAPTION_SIZE],
                      Error *error) {
    EngineRun run;
    StepCounts counts;
    if (!engine_run_begin(&run, scenes[SCENE_STACK], error)) return false;
    bool done = engine_run_to_touch(&run, error) && engine_run_step(&run, error) && count_step(&counts, &run, error);
    engine_run_end(&run);
    if (!done) return false;
    draw_stages(sketch, &counts);
    draw_arrows_and_network(sketch, &counts);
    const TextStyle words = {7.5, TEXT_CENTER, INK_SOFT, 0, false};
    sketch_text(sketch, (Point){corner(1, 0).x + box_width / 2, (low_row + box_height + high_row) / 2}, &words,
                "One step of 1/%.4g s; counts of step %d of the stack, just after the bomb's first touch",
                counts.steps_a_second, counts.step);
    snprintf(
        caption, CAPTION_SIZE,
        "The operational loop, with the counts of step %d of stack.yaml, the one after the bomb's first touch. Of %d "
        "pairs of bodies, %d have overlapping bounding boxes; %d of these touch, in %d points, of which %d have a warm "
        "start. The network replaces stage 5 only.",
        counts.step, counts.could_touch, counts.candidates, counts.touching, counts.points, counts.warm);
    return true;
}

const Illustration illustration_loop = {FIGURE_PAGE_WIDTH, 76, draw_loop};
