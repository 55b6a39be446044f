/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The paper's figures: the engine's run that they follow, the one of the narrow phase, and the drawing of all. */
#include "base/base.h"
#include "base/file.h"
#include "engine/engine.h"
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

/* Figure 2: a collision of the bomb in the pyramid's run. Left: the boxes at true scale, with the contact points.
   Right: both boxes' projections on the four axes, by the separating axis theorem: the smallest overlap gives the
   normal. */

enum { AXES = 4 };                                          /* of the first box, x first, then of the second */
static const double width = FIGURE_PAGE_WIDTH, height = 76; /* mm */
static const double least_tilt = 10; /* degrees; below it the axes of the two boxes look the same */

typedef struct Span {
    double low, high; /* m from the world's origin */
} Span;

typedef struct Collision {
    Box boxes[2];
    int bodies[2], bomb, step;
    Manifold manifold;
    Span spans[AXES][2]; /* of both boxes along each axis */
    double overlaps[AXES];
    int least; /* of the overlaps */
} Collision;

static double dot(Vec2 a, Vec2 b) { return (double)a.x * (double)b.x + (double)a.y * (double)b.y; }

static Vec2 axis_of(const Collision *collision, int i) {
    const Mat22 *rotation = &collision->boxes[i / 2].rotation;
    return i % 2 == 0 ? rotation->column1 : rotation->column2;
}

static void find_overlaps(Collision *collision) {
    collision->least = 0;
    for (int i = 0; i < AXES; i++) {
        const Vec2 axis = axis_of(collision, i);
        Span *of = collision->spans[i];
        for (int k = 0; k < 2; k++) {
            const Box *box = &collision->boxes[k];
            const double middle = dot(box->position, axis),
                         reach = (double)box->half.x * fabs(dot(box->rotation.column1, axis)) +
                                 (double)box->half.y * fabs(dot(box->rotation.column2, axis));
            of[k] = (Span){middle - reach, middle + reach};
        }
        collision->overlaps[i] = fmin(of[0].high - of[1].low, of[1].high - of[0].low);
        if (collision->overlaps[i] < collision->overlaps[collision->least]) collision->least = i;
    }
}

/* A case with all that the caption describes: the bomb and a movable box, at an angle and with two contact points. Of
   two nearly equal overlaps the engine may choose the larger; then it is not this one. */
static bool find_in_step(Collision *collision, const EngineRun *run) {
    const ContactProblem *problem = world_problem(run->world);
    for (int i = 0, count; i < problem->contact_count; i += count) {
        const int a = problem->contacts[i].a, b = problem->contacts[i].b;
        const ProblemBody *body_a = &problem->bodies[a], *body_b = &problem->bodies[b];
        count = pair_contact_count(problem, i);
        const double turned = fmod(fabs((double)body_b->angle - (double)body_a->angle) * 180 / M_PI, 90);
        if ((a != problem->bomb && b != problem->bomb) || body_a->inv_mass == 0 || body_b->inv_mass == 0 ||
            count != 2 || fmin(turned, 90 - turned) < least_tilt)
            continue;
        *collision = (Collision){.boxes = {engine_run_box(run, a), engine_run_box(run, b)},
                                 .bodies = {a, b},
                                 .bomb = problem->bomb,
                                 .step = run->frame};
        manifold_compute(&collision->manifold, &collision->boxes[0], &collision->boxes[1]);
        find_overlaps(collision);
        if (fabs(dot(axis_of(collision, collision->least), collision->manifold.normal)) > 0.9999) return true;
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
                           least_tilt);
    return ok;
}

static bool is_bomb(const Collision *collision, int i) { return collision->bodies[i] == collision->bomb; }
static const char *name_of(const Collision *collision, int i) { return is_bomb(collision, i) ? "bomb" : "box"; }
static uint32_t ink_of(const Collision *collision, int i) { return is_bomb(collision, i) ? BOMB.line : BOX_INK; }

static Pen pen_of(const Collision *collision, int i) {
    return pen_fill(is_bomb(collision, i) ? BOMB.fill : BOX_COLOUR, is_bomb(collision, i) ? 0.28 : 0.13,
                    ink_of(collision, i));
}

static void draw_boxes(Sketch *sketch, const Collision *collision) {
    const Manifold *manifold = &collision->manifold;
    const Vec2 between = vec2_scale(0.5f, vec2_add(collision->boxes[0].position, collision->boxes[1].position)),
               middle = vec2_scale(0.5f, vec2_add(manifold->points[0].position, manifold->points[1].position));
    const View view = {{1, 1}, {86, height - 6}, {(double)between.x, (double)between.y}, 28};
    const Pen dot_pen = pen_fill(0xFFFFFF, 1, ACCENT);
    for (int i = 0; i < 2; i++) {
        const Pen pen = pen_of(collision, i);
        sketch_box(sketch, &view, &collision->boxes[i], &pen);
        sketch_text(sketch, view_place(&view, collision->boxes[i].position),
                    &(TextStyle){8.5, TEXT_CENTER, ink_of(collision, i), 0, false}, "%s", name_of(collision, i));
    }
    sketch_arrow(sketch, view_place(&view, middle),
                 view_place(&view, vec2_add(middle, vec2_scale(0.3f, manifold->normal))), ACCENT, 2.2);
    for (int i = 0; i < 2; i++) {
        const Vec2 at = manifold->points[i].position, out = vec2_sub(at, middle);
        sketch_dot(sketch, view_place(&view, at), 0.9, &dot_pen);
        sketch_text(sketch, view_place(&view, vec2_add(at, vec2_scale(0.3f / hypotf(out.x, out.y), out))),
                    &(TextStyle){7.5, TEXT_CENTER, ACCENT, 0, true}, "%.0f mm",
                    -1000 * (double)manifold->points[i].separation);
    }
    sketch_scale_bar(sketch, (Point){1, 3}, view.scale, 0.5, "m", 7.5);
}

/* On each axis the bar of the first box above that of the second; between the lines is the way that parts them. */
static void draw_overlaps(Sketch *sketch, const Collision *collision) {
    const double left = 112, scale = 24, thick = 3;
    for (int i = 0; i < AXES; i++) {
        const Span *of = collision->spans[i];
        const double low = fmin(of[0].low, of[1].low), row = height - 17 - 16.5 * i;
        const bool up = of[0].high - of[1].low < of[1].high - of[0].low;
        const double ends[2] = {of[up ? 1 : 0].low, of[up ? 0 : 1].high};
        const bool least = i == collision->least;
        const uint32_t ink = least ? ACCENT : INK_SOFT;
        const Pen line = pen_line(ink, least ? 3 : 1.2, NULL);
        for (int k = 0; k < 2; k++) {
            const Pen bar = pen_of(collision, k);
            const double foot = row - thick * k, begin = left + scale * (of[k].low - low);
            sketch_rectangle(sketch, (Point){begin, foot},
                             (Point){begin + scale * (of[k].high - of[k].low), foot + thick}, &bar);
            const double x = left + scale * (ends[k] - low);
            sketch_line(sketch, (Point){x, row - thick - 1.2}, (Point){x, row + thick + 1.2}, &line);
        }
        sketch_text(sketch, (Point){left - 3, row}, &(TextStyle){7.5, TEXT_RIGHT, INK, 0, false}, "%s %c",
                    name_of(collision, i / 2), "xy"[i % 2]);
        sketch_text(sketch, (Point){left + scale * ((ends[0] + ends[1]) / 2 - low), row + thick + 3.4},
                    &(TextStyle){7.5, TEXT_CENTER, ink, 0, false}, "%.0f mm%s", 1000 * collision->overlaps[i],
                    least ? ": smallest overlap" : "");
    }
}

static bool draw_narrow_phase(Sketch *sketch, Scene *const scenes[ILLUSTRATION_SCENES], char caption[CAPTION_SIZE],
                              Error *error) {
    const TextStyle title = {8.5, TEXT_LEFT, INK, 0, false};
    Collision c;
    if (!find_collision(&c, scenes[SCENE_PYRAMID], error)) return false;
    sketch_text(sketch, (Point){1, height - 2.5}, &title, "Contact points and normal (%s, %s)",
                show_decimals((double)c.manifold.normal.x, 3).text, show_decimals((double)c.manifold.normal.y, 3).text);
    sketch_text(sketch, (Point){97, height - 2.5}, &title, "Overlaps along the axes of both boxes");
    draw_boxes(sketch, &c);
    draw_overlaps(sketch, &c);
    snprintf(
        caption, CAPTION_SIZE,
        "The narrow phase for bodies %d and %d in step %d of pyramid.yaml, at true scale. The boxes overlap by %.0f "
        "and %.0f mm along the axes of the %s, and by %.0f and %.0f mm along those of the %s. The smallest overlap, "
        "%.0f mm, gives the normal (%s, %s). The incident edge, clipped to the sides of the reference edge, gives two "
        "contact points, %.0f and %.0f mm deep.",
        c.bodies[0], c.bodies[1], c.step, 1000 * c.overlaps[0], 1000 * c.overlaps[1], name_of(&c, 0),
        1000 * c.overlaps[2], 1000 * c.overlaps[3], name_of(&c, 1), 1000 * c.overlaps[c.least],
        show_decimals((double)c.manifold.normal.x, 3).text, show_decimals((double)c.manifold.normal.y, 3).text,
        -1000 * (double)c.manifold.points[0].separation, -1000 * (double)c.manifold.points[1].separation);
    return true;
}

const Illustration illustration_narrow_phase = {width, height, draw_narrow_phase};

static const char *const scene_names[ILLUSTRATION_SCENES] = {"single", "stack", "pyramid"};

static const Illustration *const figures[] = {&illustration_loop, &illustration_narrow_phase, &illustration_data,
                                              &illustration_scenes};

const char *const illustration_names[] = {"loop", "narrow-phase", "data", "scenes", NULL};

static bool draw_figure(const Illustration *figure, const char *name, Scene *const *scenes, const char *folder,
                        Error *error) {
    Sketch sketch;
    char stem[PATH_MAX], path[PATH_MAX + 4], caption[CAPTION_SIZE] = "", line[CAPTION_SIZE + 1];
    if (!file_path(stem, sizeof stem, error, "%s/%s", folder, name)) return false;
    sketch_begin(&sketch, figure->width, figure->height);
    const bool drawn = figure->draw(&sketch, scenes, caption, error) && sketch_draw(&sketch, stem, SKETCH_SVG, error);
    sketch_free(&sketch);
    snprintf(path, sizeof path, "%s.txt", stem);
    const int length = snprintf(line, sizeof line, "%s\n", caption);
    return drawn && file_write(path, line, (size_t)length, error);
}

bool illustrations_draw(const char *scenes_folder, const char *folder, Error *error) {
    Scene *scenes[ILLUSTRATION_SCENES] = {NULL};
    bool done = true;
    for (int i = 0; done && i < ILLUSTRATION_SCENES; i++) {
        char path[PATH_MAX];
        done = file_path(path, sizeof path, error, "%s/%s.yaml", scenes_folder, scene_names[i]) &&
               (scenes[i] = scene_read(path, error)) != NULL &&
               (scenes[i]->bomb.present || error_input(error, path, "the scene has no bomb to launch"));
    }
    for (size_t i = 0; done && illustration_names[i] != NULL; i++)
        done = draw_figure(figures[i], illustration_names[i], scenes, folder, error);
    for (int i = 0; i < ILLUSTRATION_SCENES; i++) scene_destroy(scenes[i]);
    return done;
}
