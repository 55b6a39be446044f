/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "picture/marks.h"

#include "picture/panel.h"
#include "picture/pose.h"

static const double DOT = 0.0052, LINE = 0.0034; /* relative to shorter side of the panel */
static const double MIN_DOT = 2.2,
                    MIN_LINE = 1.4; /* pixels; smaller where boxes are so small that these would cover them */
static const double DOT_BOX = 0.13, LINE_BOX = 0.085; /* relative to the median box, at most */
static const double FINEST = 0.6;                     /* pixels; the smallest dot and the thinnest line */
static const double TRAIL_DURATION = 2.0;             /* s, duration of a trail */
static const double MIN_TRAIL = 0.5;                  /* m; a body that moved less in this time has no trail */
static const double OLDEST_OPACITY = 0.15;            /* opacity of a trail's oldest end */
static const double MIN_SPEED = 0.05; /* m/s; slower bodies have no arrow, or every resting body would show one */
static const double TOLERANCE = 0.4;  /* pixels; largest deviation of a segment from the trail */
enum { TRAIL_FRAMES_MAX = 600, TRAIL_EVERY = 2, SEGMENT_FRAMES = 8 };

static double mark_size(const Picture *picture, double share, double least, double box_share) {
    return fmax(fmin(fmax(share * panel_side(picture), least), box_share * picture->scales.box), FINEST);
}

double marks_dot_radius(const Picture *picture) { return mark_size(picture, DOT, MIN_DOT, DOT_BOX); }

double marks_line_thickness(const Picture *picture) { return mark_size(picture, LINE, MIN_LINE, LINE_BOX); }

ArrowStyle marks_arrow_style(const Picture *picture, uint32_t color) {
    return (ArrowStyle){marks_line_thickness(picture), color, picture->theme->panel};
}

static int trail_frames(const Trajectory *run) {
    double frames = rint(TRAIL_DURATION / (double)run->dt);
    return frames < TRAIL_FRAMES_MAX ? (int)frames : TRAIL_FRAMES_MAX;
}

/* The first frame of a trail, always an even one, so that the trail's points keep their positions as it advances. */
static int trail_start(const Trajectory *run, Moment moment, int body) {
    int first = moment.frame - trail_frames(run);
    if (first < 0) first = 0;
    first += first % TRAIL_EVERY;
    while (first < moment.frame && !trajectory_has(run, first, body)) first += TRAIL_EVERY;
    return first;
}

static bool moved_far(const Trajectory *run, Moment moment, int body, int first) {
    Pose now = pose_at(run, moment, body);
    for (int frame = first; frame < moment.frame; frame += TRAIL_EVERY) {
        Pose pose = pose_stored(run, frame, body);
        if (pose_distance(pose, now) > MIN_TRAIL) return true;
    }
    return false;
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

/* The end of the trail segment that starts at `first`; fewer segments are faster to draw. */
static int segment_end(const Trajectory *run, Moment moment, int body, int first, double tolerance) {
    int end = first + TRAIL_EVERY;
    while (end < moment.frame && end + TRAIL_EVERY <= first + SEGMENT_FRAMES &&
           max_deviation(run, moment, body, first, end + TRAIL_EVERY) < tolerance)
        end += TRAIL_EVERY;
    return end;
}

static void draw_trail(const Picture *picture, int panel, int run, Moment moment, int body, Drawing *drawing) {
    const Trajectory *trajectory = picture->runs[run];
    const Theme *theme = picture->theme;
    moment = pose_moment(trajectory, moment);
    int first = trail_start(trajectory, moment, body), length = trail_frames(trajectory);
    if (!moved_far(trajectory, moment, body, first)) return;
    uint32_t color = body == trajectory->bomb ? theme->bomb.fill : picture_body_colors(picture, run)->fill;
    for (int frame = first, end; frame <= moment.frame; frame = end) {
        end = segment_end(trajectory, moment, body, frame, TOLERANCE / picture->camera.scale);
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
    if ((picture->look.show & LOOK_TRAILS) == 0) return;
    for (int run = first; run < runs_end(picture, first); run++)
        for (int body = 0; body < picture->runs[run]->bodies; body++)
            if (!picture->runs[run]->fixed[body]) draw_trail(picture, panel, run, moment, body, drawing);
}

/* An arrow with `scale` pixels per unit; y up. */
static void draw_arrow(const Picture *picture, int panel, Point from, double x, double y, double scale, uint32_t color,
                       Drawing *drawing) {
    double length = scale * sqrt(x * x + y * y), max_arrow = picture->scales.max_arrow;
    bool truncated = length > max_arrow;
    double pixels = truncated ? scale * max_arrow / length : scale;
    ArrowStyle style = marks_arrow_style(picture, color);
    stroke_arrow(drawing, from, (Point){from.x + pixels * x, from.y - pixels * y}, truncated, &style,
                 &picture->layout.panels[panel]);
}

static void draw_velocities(const Picture *picture, int panel, int run, Moment moment, Drawing *drawing) {
    const Trajectory *trajectory = picture->runs[run];
    moment = pose_moment(trajectory, moment);
    for (int body = 0; body < trajectory->bodies; body++) {
        if (trajectory->fixed[body] || !trajectory_has(trajectory, moment.frame, body)) continue;
        Vec2 v = trajectory->velocity[(size_t)moment.frame * (size_t)trajectory->bodies + (size_t)body];
        double x = (double)v.x, y = (double)v.y;
        if (!(x * x + y * y > MIN_SPEED * MIN_SPEED)) continue;
        Pose pose = pose_at(trajectory, moment, body);
        draw_arrow(picture, panel, panel_point(picture, panel, pose.x, pose.y), x, y, picture->scales.velocity,
                   picture->theme->velocity, drawing);
    }
}

/* The impulse on body b at the contact point; body a receives the opposite. */
static void draw_impulse(const Picture *picture, int panel, const TrajectoryContact *contact, Drawing *drawing) {
    double nx = (double)contact->normal.x, ny = (double)contact->normal.y;
    double normal = (double)contact->normal_impulse, tangent = (double)contact->tangent_impulse;
    Point at = panel_point(picture, panel, (double)contact->point.x, (double)contact->point.y);
    draw_arrow(picture, panel, at, normal * nx + tangent * ny, normal * ny - tangent * nx, picture->scales.impulse,
               picture->theme->impulse, drawing);
}

/* The contacts of the next step, which result from these poses; in the last frame, those of the last step. */
static void draw_contacts(const Picture *picture, int panel, int run, Moment moment, Drawing *drawing) {
    const Trajectory *trajectory = picture->runs[run];
    const Theme *theme = picture->theme;
    moment = pose_moment(trajectory, moment);
    int step = moment.frame + 1 < trajectory->frames ? moment.frame + 1 : moment.frame;
    int64_t first = trajectory->contact_start[step], end = trajectory->contact_start[step + 1];
    for (int64_t i = first; i < end && (picture->look.show & LOOK_IMPULSES) != 0; i++)
        draw_impulse(picture, panel, &trajectory->contacts[i], drawing);
    for (int64_t i = first; i < end && (picture->look.show & LOOK_CONTACTS) != 0; i++) {
        Vec2 at = trajectory->contacts[i].point;
        stroke_dot(drawing, panel_point(picture, panel, (double)at.x, (double)at.y), marks_dot_radius(picture),
                   theme->panel, theme->impulse, &picture->layout.panels[panel]);
    }
}

void marks_draw_above(const Picture *picture, int panel, Moment moment, Drawing *drawing) {
    int first = picture_run(picture, panel);
    for (int run = first; run < runs_end(picture, first); run++) {
        if (picture->look.show & LOOK_VELOCITIES) draw_velocities(picture, panel, run, moment, drawing);
        if (picture->look.show & (LOOK_CONTACTS | LOOK_IMPULSES)) draw_contacts(picture, panel, run, moment, drawing);
    }
}
