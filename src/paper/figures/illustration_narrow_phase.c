/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Figure 2: a collision of the bomb in the pyramid's run, at true scale. Left: the overlaps along the four axes. Right:
   the contact points from the smallest overlap. */
#include "figure/narrow_phase.h"
#include "paper/figures/illustration_parts.h"
#include "paper/figures/engine_run.h"

#include "pair/pair.h"

#include <math.h>

#define LEAST_TILT 10.0 /* degrees; below it the axes of the two boxes look the same */

static const double width = FIGURE_PAGE_WIDTH, height = 84, split = 97; /* mm */

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

static void write_caption(char caption[CAPTION_SIZE], const Collision *c) {
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

static bool draw(Sketch *sketch, Scene *const scenes[ILLUSTRATION_SCENES], char caption[CAPTION_SIZE], Error *error) {
    Collision collision;
    if (!find_collision(&collision, scenes[SCENE_PYRAMID], error)) return false;
    draw_overlaps(sketch, (View){.low = {1, 0}, .high = {split + 4, height - 5}}, &collision);
    draw_contact_closeup(sketch, (View){.low = {split, 1}, .high = {width - 1, height - 7}}, &collision);
    const TextStyle title = {8.5, TEXT_LEFT, INK, 0, false};
    sketch_text(sketch, (Point){1, height - 2.5}, &title, "Overlaps along the axes of both boxes");
    sketch_text(sketch, (Point){split, height - 2.5}, &title, "Contact points: separations along the normal");
    write_caption(caption, &collision);
    return true;
}

const Illustration illustration_narrow_phase = {width, height, draw};
