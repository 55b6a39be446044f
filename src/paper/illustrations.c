/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The paper's figures: the engine's run that they follow, the one of the narrow phase, and the drawing of all. */
#include "base/base.h"
#include "base/file.h"
#include "engine/engine.h"
#include "figures/figure.h"
#include "figures/sketch.h"
#include "methods/methods.h"
#include "methods/pair.h"
#include "paper/paper_report.h"
#include "paper/report_internal.h"
#include "pictures/picture.h"
#include "pixels/png.h"
#include "runs/runs.h"
#include "scenes/scenes.h"

#include <limits.h>
#include <math.h>

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

static const double width = FIGURE_PAGE_WIDTH, height = 84, split = 97; /* mm */

/* Angle between the sides of two boxes, degrees. */
static double illustrations_tilt(const ProblemBody *a, const ProblemBody *b) {
    double turned = fmod(fabs((double)b->angle - (double)a->angle) * 180 / M_PI, 90);
    return fmin(turned, 90 - turned);
}

/* The bomb and a movable box, at an angle and with two contact points: a case with all that the caption describes. */
static bool shows_all(const ContactProblem *problem, int first) {
    int a = problem->contacts[first].a, b = problem->contacts[first].b;
    const ProblemBody *body_a = &problem->bodies[a], *body_b = &problem->bodies[b];
    return (a == problem->bomb || b == problem->bomb) && body_a->inv_mass > 0 && body_b->inv_mass > 0 &&
           pair_contact_count(problem, first) == 2 && illustrations_tilt(body_a, body_b) >= LEAST_TILT;
}

static bool find_in_step(Collision *collision, const EngineRun *run) {
    const ContactProblem *problem = world_problem(run->world);
    for (int i = next_pair(problem, -1); i < problem->contact_count; i = next_pair(problem, i)) {
        if (!shows_all(problem, i)) continue;
        int a = problem->contacts[i].a, b = problem->contacts[i].b;
        *collision = (Collision){.boxes = {engine_run_box(run, a), engine_run_box(run, b)},
                                 .bodies = {a, b},
                                 .bomb = problem->bomb,
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

static void caption_of(char caption[CAPTION_SIZE], const Collision *c) {
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

static bool draw_narrow_phase(Sketch *sketch, Scene *const scenes[ILLUSTRATION_SCENES], char caption[CAPTION_SIZE],
                              Error *error) {
    Collision collision;
    if (!find_collision(&collision, scenes[SCENE_PYRAMID], error)) return false;
    if (!draw_overlaps(sketch, (View){.low = {1, 1}, .high = {split - 3, height - 5}}, &collision, NULL, error) ||
        !draw_contact_closeup(sketch, (View){.low = {split, 1}, .high = {width - 1, height - 7}}, &collision, error))
        return false;
    const TextStyle title = {8.5, TEXT_LEFT, INK, 0, false};
    sketch_text(sketch, (Point){1, height - 2.5}, &title, "Overlaps along the axes of both boxes");
    sketch_text(sketch, (Point){split, height - 2.5}, &title, "Contact points: separations along the normal");
    caption_of(caption, &collision);
    return true;
}

const Illustration illustration_narrow_phase = {width, height, draw_narrow_phase};

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
