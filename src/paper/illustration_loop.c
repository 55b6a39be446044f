/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Figure 4: the three scenes with the bomb in flight, rendered, with the bomb's path drawn over them. */
#include "base/base.h"
#include "engine/engine.h"
#include "figures/sketch.h"
#include "methods/methods.h"
#include "methods/pair.h"
#include "paper/report_internal.h"
#include "pictures/picture.h"
#include "pictures/render.h"
#include "pixels/gl.h"
#include "pixels/png.h"
#include "runs/runs.h"
#include "runs/trajectory.h"
#include "scenes/scenes.h"

#include <stdlib.h>
#include <string.h>

/* What each picture shows, m. */
static const double view_left = -8, view_bottom = -1, view_width = 16, view_height = 22.6;

/* On the page, mm; the scale is 39 pixels per metre in the PNG. */
static const double width = FIGURE_PAGE_WIDTH, height = 87, scale = 3.302, gap = 3.4, lowest = 1;

/* The renderer then has 39 pixels per metre, too. */
enum { RENDER_WIDTH = 1300, RENDER_HEIGHT = 1075 };

static const char *const titles[ILLUSTRATION_SCENES] = {"1  Single", "2  Stack", "3  Pyramid"};

/* The part of a rendered frame inside the figure's window. */
static Image *cut_window(const Image *frame, const Picture *picture, Error *error) {
    const Rect *panel = &picture->layout.panels[0];
    const Camera *camera = &picture->camera;
    int x0 = panel->left + (int)lrint(camera->left + camera->scale * view_left);
    int y0 = panel->top + (int)lrint(camera->top - camera->scale * (view_bottom + view_height));
    int columns = (int)lrint(camera->scale * view_width), rows = (int)lrint(camera->scale * view_height);
    if (x0 < panel->left || y0 < panel->top || x0 + columns > panel->right || y0 + rows > panel->bottom)
        return error_input(error, picture->runs[0]->scene, "the picture does not show all of the figure's window"),
               NULL;
    Image *window = image_create(columns, rows, error);
    for (int y = 0; window != NULL && y < rows; y++)
        memcpy(window->pixels + (size_t)y * (size_t)columns * 4,
               frame->pixels + ((size_t)(y0 + y) * (size_t)frame->width + (size_t)x0) * 4, (size_t)columns * 4);
    return window;
}

static Image *render_last(const Trajectory *run, Error *error) {
    const RenderOptions options = {.width = RENDER_WIDTH, .height = RENDER_HEIGHT};
    Picture picture;
    if (!picture_plan(&picture, &run, 1, options.width, options.height, error)) return NULL;
    Image *image = image_create(options.width, options.height, error), *window = NULL;
    Renderer *renderer = image != NULL ? renderer_create(&run, 1, &options, error) : NULL;
    if (renderer != NULL && renderer_draw(renderer, run->frames - 1, image, error))
        window = cut_window(image, &picture, error);
    renderer_destroy(renderer);
    image_destroy(image);
    return window;
}

/* The step of the bomb's first touch; 0 with error set if it never touches. */
static int touching_step(const Scene *scene, Error *error) {
    EngineRun run;
    if (!engine_run_begin(&run, scene, error)) return 0;
    bool touched = engine_run_to_touch(&run, error);
    engine_run_end(&run);
    return touched ? run.frame : 0;
}

/* The scene's run up to two thirds of the bomb's flight. */
static Trajectory *run_part(const Scene *scene, Error *error) {
    int touch = touching_step(scene, error), begin = scene->bomb.frame;
    if (touch == 0) return NULL;
    Scene part = *scene;
    part.frames = begin + (touch - begin) * 2 / 3;
    part.camera_center = vec2((float)(view_left + view_width / 2), (float)(view_bottom + view_height / 2));
    part.camera_size = vec2((float)view_width, (float)view_height);
    Method engine;
    return method_parse(&engine, "engine", error) ? simulate(&part, &engine, NULL, error) : NULL;
}

/* Index of the bomb's state in a frame. */
static size_t bomb_row(const Trajectory *run, int frame) {
    return (size_t)frame * (size_t)run->bodies + (size_t)run->bomb;
}

/* Where the bomb came from and where it goes, at a distance from the bomb itself. */
static void draw_path(Sketch *sketch, const View *view, const Trajectory *run, int begin) {
    const Pen dashed = pen_line(BOMB.fill, 1.8, "(6,5)");
    const size_t first = bomb_row(run, begin), last = bomb_row(run, run->frames - 1);
    const Vec2 from = run->position[first], to = run->position[last], v = run->velocity[last];
    const Box start = box_make(from, run->size[run->bomb], run->angle[first]);
    const float clear = 0.8f, seconds = 0.12f, speed = hypotf(v.x, v.y), away = hypotf(to.x - from.x, to.y - from.y);
    sketch_box(sketch, view, &start, &dashed);
    if (away > clear) {
        Vec2 end = vec2_add(to, vec2_scale(clear / away, vec2_sub(from, to)));
        sketch_line(sketch, view_place(view, from), view_place(view, end), &dashed);
    }
    if (speed == 0) return;
    Vec2 tail = vec2_add(to, vec2_scale(clear / speed, v));
    sketch_arrow(sketch, view_place(view, tail), view_place(view, vec2_add(tail, vec2_scale(seconds, v))), HEAD_AT_END,
                 ACCENT, 2);
}

static int count_boxes(const Scene *scene) {
    int count = 0;
    for (int i = 0; i < scene->body_count; i++) count += !scene->bodies[i].fixed;
    return count;
}

static double bomb_speed(const Trajectory *run) {
    Vec2 v = run->velocity[bomb_row(run, run->frames - 1)];
    return (double)hypotf(v.x, v.y);
}

static void draw_words(Sketch *sketch, const View *view, const char *title, const Scene *scene, const Trajectory *run) {
    const TextStyle heading = {8.5, TEXT_LEFT, INK, 0, false}, words = {7.5, TEXT_LEFT, INK_SOFT, 0, false};
    int boxes = count_boxes(scene);
    sketch_text(sketch, (Point){view->low.x, height - 2.8}, &heading, "%s: %d %s", title, boxes,
                boxes == 1 ? "box" : "boxes");
    sketch_text(sketch, (Point){view->low.x, height - 7}, &words, "Step %d: bomb of %g kg at %.1f m/s", run->frames - 1,
                (double)scene->bomb.mass.value, bomb_speed(run));
}

static bool draw_scene(Sketch *sketch, int i, const Scene *scene, int *step, Error *error) {
    Trajectory *run = run_part(scene, error);
    if (run == NULL) return false;
    const double x = (width - 3 * scale * view_width - 2 * gap) / 2 + i * (scale * view_width + gap);
    const View view = {{x, lowest},
                       {x + scale * view_width, lowest + scale * view_height},
                       {view_left + view_width / 2, view_bottom + view_height / 2},
                       scale};
    Image *window = render_last(run, error);
    if (window != NULL) {
        sketch_image(sketch, window, view.low, scale * view_width);
        draw_path(sketch, &view, run, scene->bomb.frame);
        draw_words(sketch, &view, titles[i], scene, run);
        sketch_rectangle(sketch, view.low, view.high, &(Pen){NO_COLOUR, 1, FRAME, 1.8, NULL});
        if (i == 0) sketch_scale_bar(sketch, (Point){x + 2.5, lowest + 1.6}, view.scale, 5, "m", 7.5);
    }
    *step = run->frames - 1;
    image_destroy(window);
    trajectory_destroy(run);
    return window != NULL;
}

static bool illustration_scenes_draw(Sketch *sketch, Scene *const scenes[ILLUSTRATION_SCENES],
                                     char caption[CAPTION_SIZE], Error *error) {
    int steps[ILLUSTRATION_SCENES];
    for (int i = 0; i < ILLUSTRATION_SCENES; i++)
        if (!draw_scene(sketch, i, scenes[i], &steps[i], error)) return false;
    snprintf(
        caption, CAPTION_SIZE,
        "The three scenes at one scale, at two thirds of the bomb's flight to its first touch: %d box (single.yaml, "
        "step %d), a stack of %d (stack.yaml, step %d) and a pyramid of %d, still falling into place (pyramid.yaml, "
        "step %d). Dashed: the bomb's start. Arrow: its path in 0.12 s.",
        count_boxes(scenes[0]), steps[0], count_boxes(scenes[1]), steps[1], count_boxes(scenes[2]), steps[2]);
    return true;
}

const Illustration illustration_scenes = {width, height, illustration_scenes_draw};

/* Figure 1: the operational loop, with the counts of the step after the bomb's first touch. In that step each stage
   finds fewer pairs than the one before. */

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
    for (int i = next_pair(problem, -1); i < problem->contact_count; i = next_pair(problem, i)) counts->touching++;
    Vec2 v = world_bodies(run->world)[problem->bomb].velocity;
    counts->bomb_moved = (double)(scene->dt * hypotf(v.x, v.y));
    return counts->candidates >= 0 || error_memory(error, "figure");
}

/* mm */
static const double box_width = 51, box_height = 20, column = 60.5, low_row = 23, high_row = 55;

static Point corner(int column_number, double row) { return (Point){1 + column * column_number, row}; }

static void draw_stage(Sketch *sketch, Point at, const char *title, const char *first, const char *second,
                       const Pen *pen, uint32_t ink) {
    sketch_rectangle(sketch, at, (Point){at.x + box_width, at.y + box_height}, pen);
    const TextStyle heading = {9, TEXT_LEFT, ink, 0, false}, words = {7.5, TEXT_LEFT, INK, 0, false};
    sketch_text(sketch, (Point){at.x + 2.5, at.y + 15.8}, &heading, "%s", title);
    sketch_text(sketch, (Point){at.x + 2.5, at.y + 9.2}, &words, "%s", first);
    sketch_text(sketch, (Point){at.x + 2.5, at.y + 4.4}, &words, "%s", second);
}

static void draw_arrows(Sketch *sketch) {
    double low = low_row + box_height / 2, high = high_row + box_height / 2;
    double left = 1 + box_width / 2, right = left + 2 * column;
    for (int i = 0; i < 2; i++) {
        double end = corner(i, 0).x + box_width, begin = corner(i + 1, 0).x;
        sketch_arrow(sketch, (Point){end + 0.8, high}, (Point){begin - 0.8, high}, HEAD_AT_END, INK, 2);
        sketch_arrow(sketch, (Point){begin - 0.8, low}, (Point){end + 0.8, low}, HEAD_AT_END, INK, 2);
    }
    double top = low_row + box_height + 0.8, bottom = high_row - 0.8;
    sketch_arrow(sketch, (Point){right, bottom}, (Point){right, top}, HEAD_AT_END, INK, 2);
    sketch_arrow(sketch, (Point){left, top}, (Point){left, bottom}, HEAD_AT_END, INK, 2);
}

static void draw_network(Sketch *sketch, const StepCounts *counts) {
    const Pen pen = {NETWORK_COLOUR, 0.12, NETWORK_INK, 1.6, "(12,6)"};
    Point low = {corner(1, 0).x - 20, 1}, high = {low.x + box_width + 40, 15};
    sketch_rectangle(sketch, low, high, &pen);
    const TextStyle heading = {9, TEXT_CENTER, NETWORK_INK, 0, false}, words = {7.5, TEXT_CENTER, INK, 0, false};
    double middle = (low.x + high.x) / 2;
    sketch_text(sketch, (Point){middle, 11}, &heading, "Neural network, in place of the solver");
    sketch_text(sketch, (Point){middle, 5}, &words, "%d predictions, one per touching pair: %d inputs, %d outputs",
                counts->touching, PAIR_INPUTS, PAPER_OUTPUTS);
    sketch_arrow(sketch, (Point){middle, high.y + 0.6}, (Point){middle, low_row - 0.8}, HEAD_AT_END, NETWORK_INK, 2);
}

enum { LINE_SIZE = 96 };

static void draw_stages(Sketch *sketch, const StepCounts *c) {
    const Pen stage = pen_fill(BOX_COLOUR, 0.08, BOX_INK), solving = pen_fill(NETWORK_COLOUR, 0.3, NETWORK_INK);
    char first[LINE_SIZE], second[LINE_SIZE];
    snprintf(first, LINE_SIZE, "Bounding boxes of %d bodies:", c->bodies);
    snprintf(second, LINE_SIZE, "%d of %d pairs overlap", c->candidates, c->could_touch);
    draw_stage(sketch, corner(0, high_row), "1  Broad phase", first, second, &stage, BOX_INK);
    snprintf(first, LINE_SIZE, "%d of these pairs touch: %d arbiters", c->touching, c->touching);
    snprintf(second, LINE_SIZE, "with %d contact points", c->points);
    draw_stage(sketch, corner(1, high_row), "2  Narrow phase", first, second, &stage, BOX_INK);
    snprintf(first, LINE_SIZE, "Adds %.3f m/s to the", c->gravity);
    snprintf(second, LINE_SIZE, "velocities of %d bodies", c->moving);
    draw_stage(sketch, corner(2, high_row), "3  Gravity", first, second, &stage, BOX_INK);
    snprintf(first, LINE_SIZE, "%d points: mass, bias, friction", c->points);
    snprintf(second, LINE_SIZE, "Warm start at %d of them", c->warm);
    draw_stage(sketch, corner(2, low_row), "4  Contact problem", first, second, &stage, BOX_INK);
    snprintf(first, LINE_SIZE, "%d sweeps over %d points:", c->sweeps, c->points);
    snprintf(second, LINE_SIZE, "%d pairs of impulses", c->sweeps * c->points);
    draw_stage(sketch, corner(1, low_row), "5  Constraint solving", first, second, &solving, NETWORK_INK);
    snprintf(first, LINE_SIZE, "New velocities move %d bodies", c->moving);
    snprintf(second, LINE_SIZE, "for 1/%.4g s, the bomb %.2f m", c->steps_a_second, c->bomb_moved);
    draw_stage(sketch, corner(0, low_row), "6  Integration", first, second, &stage, BOX_INK);
}

static bool illustration_loop_draw(Sketch *sketch, Scene *const scenes[ILLUSTRATION_SCENES], char caption[CAPTION_SIZE],
                                   Error *error) {
    EngineRun run;
    StepCounts counts;
    if (!engine_run_begin(&run, scenes[SCENE_STACK], error)) return false;
    bool done = engine_run_to_touch(&run, error) && engine_run_step(&run, error) && count_step(&counts, &run, error);
    engine_run_end(&run);
    if (!done) return false;
    draw_stages(sketch, &counts);
    draw_arrows(sketch);
    draw_network(sketch, &counts);
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

const Illustration illustration_loop = {FIGURE_PAGE_WIDTH, 76, illustration_loop_draw};
