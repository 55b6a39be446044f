/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The figure of a pair: its contact as the narrow phase found it; and the separating axis theorem. */
#include "base/base.h"
#include "engine/engine.h"
#include "figures/figure.h"
#include "figures/figures_internal.h"
#include "figures/sketch.h"
#include "pictures/picture.h"
#include "pixels/png.h"
#include "runs/trajectory.h"

#include <math.h>
#include <stdio.h>

static double dot(Vec2 a, Vec2 b) { return (double)a.x * (double)b.x + (double)a.y * (double)b.y; }

static void project_box(AxisOverlap *overlap, int i, const Box *box) {
    double middle = dot(box->position, overlap->axis);
    double reach = (double)box->half.x * fabs(dot(box->rotation.column1, overlap->axis)) +
                   (double)box->half.y * fabs(dot(box->rotation.column2, overlap->axis));
    overlap->low[i] = middle - reach;
    overlap->high[i] = middle + reach;
}

void separating_axes(AxisOverlap overlaps[SEPARATING_AXES], const Box *a, const Box *b) {
    for (int i = 0; i < SEPARATING_AXES; i++) {
        AxisOverlap *overlap = &overlaps[i];
        const Mat22 *rotation = i < 2 ? &a->rotation : &b->rotation;
        overlap->box = i / 2;
        overlap->letter = i % 2 == 0 ? 'x' : 'y';
        overlap->axis = i % 2 == 0 ? rotation->column1 : rotation->column2;
        project_box(overlap, 0, a);
        project_box(overlap, 1, b);
        overlap->depth = fmin(overlap->high[0] - overlap->low[1], overlap->high[1] - overlap->low[0]);
    }
}

int least_overlap(const AxisOverlap overlaps[SEPARATING_AXES]) {
    int least = 0;
    for (int i = 1; i < SEPARATING_AXES; i++)
        if (overlaps[i].depth < overlaps[least].depth) least = i;
    return least;
}

/* The narrow phase of a contact of a run: the axis along which two boxes touch, and their contact points. The poses
   are those before the step, for which the contact was found. */

static const double min_tilt = 10;      /* degrees; with less, the axes of the two boxes look the same */
static const double max_ratio = 4.5;    /* of sides; beyond, one box hides the details of the other */
static const double side_by_side = 130; /* mm; from this width on, both halves fit side by side */

/* How instructive a pair is; SHOWS_NOTHING: not the requested one. */
enum { SHOWS_NOTHING, SHOWS_SOMETHING, SHOWS_BOMB, SHOWS_ALL };

static Box box_of(const Trajectory *run, int frame, int body) {
    size_t i = trajectory_at(run, frame, body);
    return box_make(run->position[i], run->size[body], run->angle[i]);
}

static double figure_pair_tilt(const Trajectory *run, int frame, int a, int b) {
    const float *angle = run->angle + (size_t)frame * (size_t)run->bodies;
    double turned = fmod(fabs((double)angle[b] - (double)angle[a]) * 180 / M_PI, 90);
    return fmin(turned, 90 - turned);
}

static int rate_pair(const FigureSpec *spec, int step, int a, int b, int points) {
    const Trajectory *run = spec->runs[0];
    const int *requested = spec->bodies;
    if (spec->body_count > 0)
        return (requested[0] == a && requested[1] == b) || (requested[0] == b && requested[1] == a) ? SHOWS_ALL
                                                                                                    : SHOWS_NOTHING;
    if (run->fixed[a] || run->fixed[b]) return SHOWS_NOTHING;
    if (a != run->bomb && b != run->bomb) return SHOWS_SOMETHING;
    return points == 2 && figure_pair_tilt(run, step - 1, a, b) >= min_tilt ? SHOWS_ALL : SHOWS_BOMB;
}

/* Finds the most instructive pair of the first step from `first` on in which the bomb or the requested pair touches;
   if there is none, the first pair. */
static int find_pair(const FigureSpec *spec, int first, int end, Collision *collision) {
    const Trajectory *run = spec->runs[0];
    int best = SHOWS_NOTHING;
    for (int step = first; step < end && best < SHOWS_BOMB; step++)
        for (int64_t i = run->contact_start[step]; i < run->contact_start[step + 1];) {
            const TrajectoryContact *contact = &run->contacts[i];
            int points = 0;
            for (; i < run->contact_start[step + 1] && run->contacts[i].a == contact->a &&
                   run->contacts[i].b == contact->b;
                 i++)
                points++;
            int shows = rate_pair(spec, step, contact->a, contact->b, points);
            if (shows <= best) continue;
            best = shows;
            *collision = (Collision){.bodies = {contact->a, contact->b}, .step = step};
        }
    return best;
}

static bool refuse_no_pair(const FigureSpec *spec, Error *error) {
    const char *when = spec->time_count > 0 ? " in that step" : "";
    if (spec->body_count > 0)
        return error_input(error, spec->paths[0], "bodies %d and %d do not touch%s", spec->bodies[0], spec->bodies[1],
                           when);
    return error_input(error, spec->paths[0], "no two dynamic bodies touch%s", when);
}

static bool check_sizes(const FigureSpec *spec, const Collision *collision, Error *error) {
    double sides[2][2];
    for (int i = 0; i < 2; i++) {
        Vec2 size = spec->runs[0]->size[collision->bodies[i]];
        sides[i][0] = fmin((double)size.x, (double)size.y), sides[i][1] = fmax((double)size.x, (double)size.y);
    }
    double least = fmin(sides[0][0], sides[1][0]), most = fmax(sides[0][1], sides[1][1]);
    return most <= max_ratio * least ||
           error_input(error, spec->paths[0],
                       "bodies %d and %d have sides from %g to %g m: the ratio must be at most %g",
                       collision->bodies[0], collision->bodies[1], least, most, max_ratio);
}

static bool figure_pair_choose(const FigureSpec *spec, Collision *collision, Error *error) {
    const Trajectory *run = spec->runs[0];
    int frames[FIGURE_MOMENTS_MAX], count, first = 1, end = run->frames;
    if (spec->time_count > 1)
        return error_input(error, "--at", "this kind of figure shows one moment (got %d)", spec->time_count);
    if (!run_check_bodies(spec, error)) return false;
    if (spec->time_count > 0) {
        if (!run_frames(spec, 1, 1, frames, &count, error)) return false;
        first = frames[0] + 1, end = first + 1;
    }
    if (find_pair(spec, first, end, collision) == SHOWS_NOTHING) return refuse_no_pair(spec, error);
    for (int i = 0; i < 2; i++) {
        int body = collision->bodies[i];
        collision->boxes[i] = box_of(run, collision->step - 1, body);
        snprintf(collision->names[i], sizeof collision->names[i], body == run->bomb ? "bomb" : "box %d", body);
    }
    collision->bomb = run->bomb;
    collision->points = spec->points;
    if (!check_sizes(spec, collision, error)) return false;
    return collision_find(collision) ||
           error_input(error, spec->paths[0],
                       "bodies %d and %d touch in the step after %g s, but not at the poses stored for it",
                       collision->bodies[0], collision->bodies[1], (collision->step - 1) * (double)run->dt);
}

static const char overlaps_title[] = "Overlaps along the axes of both boxes",
                  contact_title[] = "Contact points: separations along the normal";

/* A half of the picture and its title above. */
typedef struct Half {
    View window;
    WrappedText title;
} Half;

static Half half_of(const FigureSpec *spec, const char *title, double left, double width) {
    return (Half){.window = {.low = {left, 0}, .high = {left + width, 0}},
                  .title = wrap_text(spec->points, width, "%s", title)};
}

static void draw_half_title(Sketch *sketch, const Half *half) {
    const double line = line_height(half->title.points);
    draw_wrapped(sketch, (Point){half->window.low.x, half->window.high.y + (half->title.lines - 0.4) * line}, INK,
                 &half->title);
}

/* The halves beside each other, or the second below the first. */
static void place_halves(const FigureSpec *spec, Half halves[2], double *height) {
    const double width = spec->width, line = line_height(spec->points), edge = PAGE_EDGE, gap = 3;
    const double least = 17 * line; /* mm: height of a half, for its labels */
    if (width >= side_by_side) {
        const double side = 0.44 * width, high = fmax(side, least);
        halves[0] = half_of(spec, overlaps_title, edge, width - side - gap - edge);
        halves[1] = half_of(spec, contact_title, width - side - edge, side);
        for (int i = 0; i < 2; i++) halves[i].window.low.y = edge, halves[i].window.high.y = edge + high;
        *height = edge + high + fmax(halves[0].title.lines, halves[1].title.lines) * line;
    } else {
        for (int i = 0; i < 2; i++)
            halves[i] = half_of(spec, i == 0 ? overlaps_title : contact_title, edge, width - 2 * edge);
        halves[1].window.low.y = edge, halves[1].window.high.y = edge + fmax(0.8 * width, least);
        halves[0].window.low.y = halves[1].window.high.y + (halves[1].title.lines + 0.6) * line;
        halves[0].window.high.y = halves[0].window.low.y + fmax(width, least);
        *height = halves[0].window.high.y + halves[0].title.lines * line;
    }
}

static bool figure_pair_draw(Sketch *sketch, const FigureSpec *spec, Error *error) {
    Collision collision;
    Half halves[2];
    double height;
    if (!figure_pair_choose(spec, &collision, error)) return false;
    if (spec->facts != NULL)
        *spec->facts = (FigureFacts){
            .frame_count = 1, .frames = {collision.step - 1}, .bodies = {collision.bodies[0], collision.bodies[1]}};
    const Vec2 down = collision_turn_up(&collision);
    const double line = line_height(spec->points);
    const WrappedText title = wrap_text(
        spec->points, spec->width - 2 * PAGE_EDGE, "%s, %.3f s, bodies %d and %d", run_name(spec, spec->runs[0]).text,
        (collision.step - 1) * (double)spec->runs[0]->dt, collision.bodies[0], collision.bodies[1]);
    place_halves(spec, halves, &height);
    sketch_begin(sketch, spec->width, height + (title.lines + 0.6) * line);
    if (!draw_overlaps(sketch, halves[0].window, &collision, &down, error) ||
        !draw_contact_closeup(sketch, halves[1].window, &collision, error))
        return false;
    for (int i = 0; i < 2; i++) draw_half_title(sketch, &halves[i]);
    draw_wrapped(sketch, (Point){PAGE_EDGE, sketch->height - 0.6 * line}, INK, &title);
    return true;
}

static void caption_body(FILE *out, const FigureSpec *spec, int body) {
    fprintf(out, body == spec->runs[0]->bomb ? "the bomb" : "body~%d", body);
}

static void figure_pair_caption(FILE *out, const FigureSpec *spec) {
    fputs("Narrow phase of ", out);
    caption_body(out, spec, spec->facts->bodies[0]);
    fputs(" and ", out);
    caption_body(out, spec, spec->facts->bodies[1]);
    fputs(" in the ", out);
    caption_scene(out, spec);
    caption_times(out, spec);
    fputs(
        ": overlaps along the axes of both boxes, and contact points with their separations along the normal. Method: ",
        out);
    caption_run(out, spec, spec->runs[0]);
    fputs(".", out);
}

const FigureKind figure_pair = {
    .name = "narrow-phase",
    .summary = "contact of two boxes of a run: overlaps, normal, points",
    .example = "narrow-phase engine.npz --bodies 2,11 -o contact.svg",
    .min_runs = 1,
    .max_runs = 1,
    .takes_times = true,
    .min_bodies = 2,
    .max_bodies = 2,
    .needs_contacts = true,
    .draw = figure_pair_draw,
    .caption = figure_pair_caption,
};
