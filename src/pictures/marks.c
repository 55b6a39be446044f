/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Marks in panels, and the scales of arrows and colours: trails below the bodies; contacts, arrows and the bomb's way
   above them; and what points to a bomb outside. */
#include "base/base.h"
#include "base/numbers.h"
#include "engine/engine.h"
#include "pictures/pictures_internal.h"
#include "pictures/picture.h"
#include "pixels/gl.h"
#include "runs/compare_runs.h"
#include "runs/trajectory.h"

#include <math.h>
#include <stdlib.h>

static const double MAX_SPEED = 1e4; /* m/s; faster bodies, of an exploding run, do not count */

static int compare_floats(const void *a, const void *b) {
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

bool scales_measure(const Trajectory *run, ScaleMeasures *measures, Error *error) {
    double square = 0;
    for (size_t i = 0; i < (size_t)run->frames * (size_t)run->bodies; i++) {
        double x = (double)run->velocity[i].x, y = (double)run->velocity[i].y, v = x * x + y * y;
        if (v > square && v < MAX_SPEED * MAX_SPEED) square = v;
    }
    *measures = (ScaleMeasures){.speed = sqrt(square), .box = 1};

    const size_t contacts = (size_t)run->contact_start[run->frames], bodies = (size_t)run->bodies;
    float *values = malloc(((contacts > bodies ? contacts : bodies) + 1) * sizeof *values);
    size_t count = 0;
    if (values == NULL) return error_memory(error, "render");
    for (size_t i = 0; i < contacts; i++) {
        float normal = run->contacts[i].normal_impulse;
        if (normal > 0 && isfinite(normal)) values[count++] = normal;
    }
    qsort(values, count, sizeof *values, compare_floats);
    if (count > 0) measures->impulse = (double)values[count - 1 - count / 10];

    count = 0;
    for (int body = 0; body < run->bodies; body++)
        if (!run->fixed[body] && body != run->bomb) values[count++] = fminf(run->size[body].x, run->size[body].y);
    qsort(values, count, sizeof *values, compare_floats);
    if (count > 0) measures->box = (double)values[count / 2];
    free(values);
    return true;
}

/* Sets the pixels per unit, and the value of the legend's arrow. */
static void choose_scale(double *scale, double *legend, double value, double pixels, double max_legend) {
    *scale = value > 1e-9 ? pixels / value : pixels;
    *legend = round_down(fmin(max_legend / *scale, 5e12));
}

bool scales_choose(Scales *scales, const Trajectory *run, const Layout *layout, double scale, double largest_distance,
                   Error *error) {
    Rect panel = layout->panels[0];
    double side = fmin(panel.right - panel.left, panel.bottom - panel.top);
    ScaleMeasures measures;
    if (!scales_measure(run, &measures, error)) return false;
    const double box = scales->box = scale * measures.box, legend = fmin(LEGEND_ARROW * side, LEGEND_ARROW_BOXES * box);
    scales->max_arrow = fmin(MAX_ARROW * side, MAX_ARROW_BOXES * box);
    choose_scale(&scales->impulse, &scales->legend_impulse, measures.impulse,
                 fmin(COMMON_ARROW * side, COMMON_ARROW_BOXES * box), legend);
    choose_scale(&scales->velocity, &scales->legend_velocity, measures.speed,
                 fmin(FASTEST_ARROW * side, FASTEST_ARROW_BOXES * box), legend);
    double power = 1;
    for (scales->last_decade = 0; power < largest_distance && scales->last_decade < SCALE_LAST_DECADE; power *= 10)
        scales->last_decade++;
    scales->exceeded = power < largest_distance;
    return true;
}

double scales_share(const Scales *scales, double distance) {
    if (!(distance > 1e-3)) return 0;
    return fmin(1, (log10(distance) - SCALE_FIRST_DECADE) / (scales->last_decade - SCALE_FIRST_DECADE));
}

static double mark_size(const Picture *picture, double share, double least, double box_share) {
    return fmax(fmin(fmax(share * panel_side(picture), least), box_share * picture->scales.box), FINEST);
}

double marks_dot_radius(const Picture *picture) { return mark_size(picture, MARK_DOT, MIN_DOT, DOT_BOX); }

double marks_line_thickness(const Picture *picture) { return mark_size(picture, MARK_LINE, MIN_LINE, LINE_BOX); }

ArrowStyle marks_arrow_style(const Picture *picture, uint32_t color) {
    return (ArrowStyle){marks_line_thickness(picture), color, picture->theme->panel};
}

static Pose trail_pose(const Trajectory *run, Moment moment, int body, int frame) {
    return frame >= moment.frame ? pose_at(run, moment, body) : pose_stored(run, frame, body);
}

/* The largest distance (m) of the trail's points between two frames from the chord. */
static double max_deviation(const Trajectory *run, Moment moment, int body, int first, int end) {
    Pose a = trail_pose(run, moment, body, first), b = trail_pose(run, moment, body, end);
    double length = pose_distance(a, b), most = 0;
    for (int frame = first + TRAIL_EVERY; frame < end; frame += TRAIL_EVERY) {
        Pose p = pose_stored(run, frame, body);
        double off = fabs((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x));
        most = fmax(most, length > 0 ? off / length : pose_distance(a, p));
    }
    return most;
}

static void draw_trail(const Picture *picture, int panel, int run, Moment moment, int body, Drawing *drawing) {
    const Trajectory *trajectory = picture->runs[run];
    const Theme *theme = picture->theme;
    moment = pose_moment(trajectory, moment);
    const int length = (int)fmin(rint(TRAIL_DURATION / (double)trajectory->dt), TRAIL_FRAMES_MAX);

    /* Always an even first frame, so that the trail's points keep their positions as it advances. */
    int first = moment.frame > length ? moment.frame - length : 0;
    first += first % TRAIL_EVERY;
    while (first < moment.frame && !trajectory_has(trajectory, first, body)) first += TRAIL_EVERY;

    const Pose now = pose_at(trajectory, moment, body);
    bool far = false;
    for (int frame = first; !far && frame < moment.frame; frame += TRAIL_EVERY)
        far = pose_distance(pose_stored(trajectory, frame, body), now) > MIN_TRAIL;
    if (!far) return;

    const double tolerance = TRAIL_TOLERANCE / picture->camera.scale;
    uint32_t color = body == trajectory->bomb ? theme->bomb.fill : picture_body_colors(picture, run)->fill;
    for (int frame = first, end; frame <= moment.frame; frame = end) {
        end = frame + TRAIL_EVERY; /* fewer segments are faster to draw */
        while (end < moment.frame && end + TRAIL_EVERY <= frame + SEGMENT_FRAMES &&
               max_deviation(trajectory, moment, body, frame, end + TRAIL_EVERY) < tolerance)
            end += TRAIL_EVERY;
        Pose a = trail_pose(trajectory, moment, body, frame), b = trail_pose(trajectory, moment, body, end);
        double age = fmin(1, (moment.frame + moment_fraction(moment) - frame) / length);
        Point from = panel_point(picture, panel, a.x, a.y), to = panel_point(picture, panel, b.x, b.y);
        stroke_line(drawing, from, to, marks_line_thickness(picture),
                    theme_mix(theme->panel, color, 1 - (1 - OLDEST_OPACITY) * age), &picture->layout.panels[panel]);
    }
}

/* An overlay draws the marks of all runs; otherwise each panel those of its run. */
static int runs_end(const Picture *picture, int first) {
    return picture->look.compare == LOOK_OVERLAY ? picture->count : first + 1;
}

void marks_draw_below(const Picture *picture, int panel, Moment moment, Drawing *drawing) {
    int first = picture_run(picture, panel);
    if ((picture->look.show & SHOW_TRAILS) == 0) return;
    for (int run = first; run < runs_end(picture, first); run++)
        for (int body = 0; body < picture->runs[run]->bodies; body++)
            if (!picture->runs[run]->fixed[body]) draw_trail(picture, panel, run, moment, body, drawing);
}

/* An arrow with `scale` pixels per unit; y up. Beyond the longest that has the scale, ten times the value are drawn a
   third longer, so that values still differ; thousands end at twice its length. The same in player/marks.js. */
static void draw_arrow(const Picture *picture, int panel, Point from, double x, double y, double scale, uint32_t color,
                       Drawing *drawing) {
    const double length = scale * sqrt(x * x + y * y), longest = picture->scales.max_arrow;
    const bool truncated = length > longest;
    const double drawn = truncated ? longest * (1 + fmin(log10(length / longest) / 3, 1)) : length,
                 pixels = truncated ? scale * drawn / length : scale;
    ArrowStyle style = marks_arrow_style(picture, color);
    stroke_arrow(drawing, from, (Point){from.x + pixels * x, from.y - pixels * y}, truncated, &style,
                 &picture->layout.panels[panel]);
}

static void draw_velocities(const Picture *picture, int panel, int run, Moment moment, Drawing *drawing) {
    const Trajectory *trajectory = picture->runs[run];
    moment = pose_moment(trajectory, moment);
    for (int body = 0; body < trajectory->bodies; body++) {
        if (trajectory->fixed[body] || !trajectory_has(trajectory, moment.frame, body)) continue;
        Vec2 v = trajectory->velocity[trajectory_at(trajectory, moment.frame, body)];
        double x = (double)v.x, y = (double)v.y;
        if (!(x * x + y * y > MIN_SPEED * MIN_SPEED)) continue;
        Pose pose = pose_at(trajectory, moment, body);
        draw_arrow(picture, panel, panel_point(picture, panel, pose.x, pose.y), x, y, picture->scales.velocity,
                   picture->theme->velocity, drawing);
    }
}

/* A ring is open, a square sticks, a bar along the surface slips; around what the reference's contact does not do, a
   circle. The same in player/marks.js. */
void marks_draw_mode(const Picture *picture, const ModeMark *mark, const Rect *clip, Drawing *drawing) {
    const Theme *theme = picture->theme;
    const double side = MODE_SIDE * mark->radius, bar = mark->mode == CONTACT_SLIPS ? MODE_BAR : 1;
    Shape shape = {.x = mark->at.x,
                   .y = mark->at.y,
                   .half_width = bar * side + MODE_HALO,
                   .half_height = side / bar + MODE_HALO,
                   .cosine = mark->cosine,
                   .sine = mark->sine,
                   .outline = MODE_HALO,
                   .fill = mark->mode == CONTACT_SLIPS ? theme->slips : theme->impulse,
                   .line = theme->panel};
    const double ring = MODE_WRONG * mark->radius;
    if (mark->wrong)
        drawing_add_shape(drawing,
                          &(Shape){.x = mark->at.x,
                                   .y = mark->at.y,
                                   .half_width = ring,
                                   .half_height = ring,
                                   .cosine = 1,
                                   .radius = ring,
                                   .outline = fmax(1, mark->radius / 3),
                                   .fill = theme->panel,
                                   .line = theme->impulse},
                          clip);
    if (mark->mode == CONTACT_OPEN)
        stroke_dot(drawing, mark->at, mark->radius, theme->panel, theme->impulse, clip);
    else
        drawing_add_shape(drawing, &shape, clip);
}

static void draw_modes(const Picture *picture, int panel, int run, Moment moment, Drawing *drawing) {
    const Trajectory *trajectory = picture->runs[run];
    const Trajectory *base = picture->mode_base >= 0 ? picture->runs[picture->mode_base] : NULL;
    const int step = pose_step(trajectory, moment);
    for (int64_t i = trajectory->contact_start[step]; i < trajectory->contact_start[step + 1]; i++) {
        const TrajectoryContact *contact = &trajectory->contacts[i];
        const ModeMark mark = {.at = panel_point(picture, panel, (double)contact->point.x, (double)contact->point.y),
                               .cosine = (double)contact->normal.y,
                               .sine = -(double)contact->normal.x,
                               .radius = marks_dot_radius(picture),
                               .mode = trajectory_mode(trajectory, step, i),
                               .wrong = base != NULL &&
                                        !trajectory_same_mode(trajectory, step, i, base, pose_step(base, moment))};
        marks_draw_mode(picture, &mark, &picture->layout.panels[panel], drawing);
    }
}

/* An impulse is that on body b at the contact point; body a receives the opposite. */
static void draw_contacts(const Picture *picture, int panel, int run, Moment moment, Drawing *drawing) {
    const Trajectory *trajectory = picture->runs[run];
    const Theme *theme = picture->theme;
    const int step = pose_step(trajectory, moment);
    int64_t first = trajectory->contact_start[step], end = trajectory->contact_start[step + 1];
    for (int64_t i = first; i < end && (picture->look.show & SHOW_IMPULSES) != 0; i++) {
        const TrajectoryContact *contact = &trajectory->contacts[i];
        const double nx = (double)contact->normal.x, ny = (double)contact->normal.y;
        const double normal = (double)contact->normal_impulse, tangent = (double)contact->tangent_impulse;
        draw_arrow(picture, panel, panel_point(picture, panel, (double)contact->point.x, (double)contact->point.y),
                   normal * nx + tangent * ny, normal * ny - tangent * nx, picture->scales.impulse, theme->impulse,
                   drawing);
    }
    for (int64_t i = first; i < end && (picture->look.show & SHOW_CONTACTS) != 0; i++) {
        Vec2 at = trajectory->contacts[i].point;
        stroke_dot(drawing, panel_point(picture, panel, (double)at.x, (double)at.y), marks_dot_radius(picture),
                   theme->panel, theme->impulse, &picture->layout.panels[panel]);
    }
}

/* At the edge of a panel, an arrow in the bomb's colour to a bomb that is outside. */
static void draw_pointer(const Picture *picture, int panel, Moment moment, Drawing *drawing) {
    const Trajectory *run = picture->runs[picture_run(picture, panel)];
    const Rect *rect = &picture->layout.panels[panel];
    if (run->bomb < 0 || !trajectory_has(run, pose_moment(run, moment).frame, run->bomb)) return;
    const Pose pose = pose_at(run, moment, run->bomb);
    const Point at = panel_point(picture, panel, pose.x, pose.y);
    const Vec2 size = run->size[run->bomb];
    const double reach = 0.5 * picture->camera.scale * (double)fminf(size.x, size.y);
    const double line = fmax(POINTER_LINE * panel_side(picture), MIN_POINTER_LINE), inset = POINTER_INSET * line;
    const Point edge = {fmin(fmax(at.x, rect->left + inset), rect->right - inset),
                        fmin(fmax(at.y, rect->top + inset), rect->bottom - inset)};
    const double x = at.x - edge.x, y = at.y - edge.y, away = sqrt(x * x + y * y);
    if (!(away > reach + inset)) return;
    const double tail = fmax(POINTER * panel_side(picture), MIN_POINTER) / away;
    const ArrowStyle style = {line, picture->theme->bomb.fill, picture->theme->panel};
    stroke_arrow(drawing, (Point){edge.x - tail * x, edge.y - tail * y}, edge, false, &style, rect);
}

DashedLine approach_line(const Picture *picture) {
    const double thickness = fmax(GHOST_OUTLINE * panel_side(picture), MIN_GHOST_OUTLINE);
    return (DashedLine){.thickness = thickness, .color = picture->theme->bomb.fill, .dash = {.on = 4, .off = 3}};
}

/* Where the bomb appears, as outline, and a dashed line to where it strikes. */
static void draw_approach(const Picture *picture, int panel, Drawing *drawing) {
    const int index = picture_run(picture, panel);
    const Trajectory *run = picture->runs[index];
    if (run->bomb < 0) return;
    const Rect *rect = &picture->layout.panels[panel];
    const int impact = trajectory_impact(run), last = impact >= 0 ? impact : run->frames - 1;
    int frame = bomb_first_frame(run);
    Shape shape = body_shape(picture, panel, index, moment_stored(frame), run->bomb, &picture->theme->bomb);
    DashedLine line = approach_line(picture);
    shape.hollow = true, shape.line = line.color, shape.outline = line.thickness;
    drawing_add_shape(drawing, &shape, rect);
    for (; frame < last; frame++) {
        const Pose from = pose_stored(run, frame, run->bomb), to = pose_stored(run, frame + 1, run->bomb);
        stroke_dashed(drawing, panel_point(picture, panel, from.x, from.y), panel_point(picture, panel, to.x, to.y),
                      &line, rect);
    }
}

void marks_draw_above(const Picture *picture, int panel, Moment moment, Drawing *drawing) {
    int first = picture_run(picture, panel);
    draw_pointer(picture, panel, moment, drawing);
    if (picture->look.approach) draw_approach(picture, panel, drawing);
    for (int run = first; run < runs_end(picture, first); run++) {
        if (picture->look.show & SHOW_VELOCITIES) draw_velocities(picture, panel, run, moment, drawing);
        if (picture->look.show & (SHOW_CONTACTS | SHOW_IMPULSES)) draw_contacts(picture, panel, run, moment, drawing);
        if (picture->look.show & SHOW_MODES) draw_modes(picture, panel, run, moment, drawing);
    }
}
