/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "picture/marks.h"

#include "picture/panel.h"
#include "picture/pose.h"

static const double DOT = 0.0052, LINE = 0.0034;       /* of the panel's shorter side */
static const double LEAST_DOT = 2.2, LEAST_LINE = 1.4; /* pixels */
static const double LASTS = 2.0;                       /* s, that a trail goes back */
static const double FAR = 0.5;      /* m, that a body has to have moved in this time to have a trail */
static const double OLDEST = 0.15;  /* of a trail's colour at its end */
static const double SLOWEST = 0.05; /* m/s; what is slower has no arrow, or bodies at rest would bristle */
static const double EVEN = 0.4;     /* pixels, that a piece of a trail may be off */
enum { TRAIL_FRAMES_MAX = 600, TRAIL_EVERY = 2, PIECE_FRAMES = 8 };

double marks_dot(const Picture *picture) { return fmax(DOT * panel_side(picture), LEAST_DOT); }

double marks_line(const Picture *picture) { return fmax(LINE * panel_side(picture), LEAST_LINE); }

ArrowStyle marks_arrow(const Picture *picture, uint32_t color) {
    return (ArrowStyle){marks_line(picture), color, picture->theme->panel};
}

static int trail_frames(const Trajectory *run) {
    double frames = rint(LASTS / (double)run->dt);
    return frames < TRAIL_FRAMES_MAX ? (int)frames : TRAIL_FRAMES_MAX;
}

/* The first frame of a trail: of every second, so that its points stay where they are while it moves on. */
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
        if (pose_distance(pose, now) > FAR) return true;
    }
    return false;
}

static Pose trail_pose(const Trajectory *run, Moment moment, int body, int frame) {
    return frame >= moment.frame ? pose_at(run, moment, body) : pose_stored(run, frame, body);
}

/* How far (m) the points of a trail between two frames lie from the straight line that joins them. */
static double bend(const Trajectory *run, Moment moment, int body, int first, int end) {
    Pose a = trail_pose(run, moment, body, first), b = trail_pose(run, moment, body, end);
    double length = pose_distance(a, b), most = 0;
    for (int frame = first + TRAIL_EVERY; frame < end; frame += TRAIL_EVERY) {
        Pose p = pose_stored(run, frame, body);
        double off = fabs((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x));
        most = fmax(most, length > 0 ? off / length : pose_distance(a, p));
    }
    return most;
}

/* Where the piece of a trail ends that begins in a frame: the fewer pieces, the less to draw. */
static int piece_end(const Trajectory *run, Moment moment, int body, int first, double even) {
    int end = first + TRAIL_EVERY;
    while (end < moment.frame && end + TRAIL_EVERY <= first + PIECE_FRAMES &&
           bend(run, moment, body, first, end + TRAIL_EVERY) < even)
        end += TRAIL_EVERY;
    return end;
}

static void draw_trail(const Picture *picture, int panel, int run, Moment moment, int body, Drawing *drawing) {
    const Trajectory *trajectory = picture->panels[run];
    const Theme *theme = picture->theme;
    moment = pose_moment(trajectory, moment);
    int first = trail_start(trajectory, moment, body), length = trail_frames(trajectory);
    if (!moved_far(trajectory, moment, body, first)) return;
    uint32_t color = body == trajectory->bomb ? theme->bomb.fill : theme->bodies[run].fill;
    for (int frame = first, end; frame <= moment.frame; frame = end) {
        end = piece_end(trajectory, moment, body, frame, EVEN / picture->camera.scale);
        Pose a = trail_pose(trajectory, moment, body, frame), b = trail_pose(trajectory, moment, body, end);
        double age = fmin(1, (moment.frame + moment.part - frame) / length);
        Point from = panel_point(picture, panel, a.x, a.y), to = panel_point(picture, panel, b.x, b.y);
        stroke_line(drawing, from, to, marks_line(picture), theme_mix(theme->panel, color, 1 - (1 - OLDEST) * age),
                    &picture->layout.panels[panel]);
    }
}

/* Of an overlay all runs have marks, each in its panel else. */
static int runs_end(const Picture *picture, int first) {
    return picture->look.compare == LOOK_OVERLAY ? picture->count : first + 1;
}

void marks_draw_below(const Picture *picture, int panel, Moment moment, Drawing *drawing) {
    int first = picture_run(picture, panel);
    if ((picture->look.show & LOOK_TRAILS) == 0) return;
    for (int run = first; run < runs_end(picture, first); run++)
        for (int body = 0; body < picture->panels[run]->bodies; body++)
            if (!picture->panels[run]->fixed[body]) draw_trail(picture, panel, run, moment, body, drawing);
}

/* An arrow of this length in pixels per unit; y up. */
static void draw_arrow(const Picture *picture, int panel, Point from, double x, double y, double scale, uint32_t color,
                       Drawing *drawing) {
    double length = scale * sqrt(x * x + y * y), longest = picture->scales.longest;
    bool longer = length > longest;
    double pixels = longer ? scale * longest / length : scale;
    ArrowStyle style = marks_arrow(picture, color);
    stroke_arrow(drawing, from, (Point){from.x + pixels * x, from.y - pixels * y}, longer, &style,
                 &picture->layout.panels[panel]);
}

static void draw_velocities(const Picture *picture, int panel, int run, Moment moment, Drawing *drawing) {
    const Trajectory *trajectory = picture->panels[run];
    moment = pose_moment(trajectory, moment);
    for (int body = 0; body < trajectory->bodies; body++) {
        if (trajectory->fixed[body] || !trajectory_has(trajectory, moment.frame, body)) continue;
        Vec2 v = trajectory->velocity[(size_t)moment.frame * (size_t)trajectory->bodies + (size_t)body];
        double x = (double)v.x, y = (double)v.y;
        if (!(x * x + y * y > SLOWEST * SLOWEST)) continue;
        Pose pose = pose_at(trajectory, moment, body);
        draw_arrow(picture, panel, panel_point(picture, panel, pose.x, pose.y), x, y, picture->scales.velocity,
                   picture->theme->velocity, drawing);
    }
}

/* What body b gets, from where the two touch; body a gets the opposite. */
static void draw_impulse(const Picture *picture, int panel, const TrajectoryContact *contact, Drawing *drawing) {
    double nx = (double)contact->normal.x, ny = (double)contact->normal.y;
    double normal = (double)contact->normal_impulse, tangent = (double)contact->tangent_impulse;
    Point at = panel_point(picture, panel, (double)contact->point.x, (double)contact->point.y);
    draw_arrow(picture, panel, at, normal * nx + tangent * ny, normal * ny - tangent * nx, picture->scales.impulse,
               picture->theme->impulse, drawing);
}

/* Those of the next step, which come from these poses, and of the last one in the last frame. */
static void draw_contacts(const Picture *picture, int panel, int run, Moment moment, Drawing *drawing) {
    const Trajectory *trajectory = picture->panels[run];
    const Theme *theme = picture->theme;
    moment = pose_moment(trajectory, moment);
    int step = moment.frame + 1 < trajectory->frames ? moment.frame + 1 : moment.frame;
    int64_t first = trajectory->contact_start[step], end = trajectory->contact_start[step + 1];
    for (int64_t i = first; i < end && (picture->look.show & LOOK_IMPULSES) != 0; i++)
        draw_impulse(picture, panel, &trajectory->contacts[i], drawing);
    for (int64_t i = first; i < end && (picture->look.show & LOOK_CONTACTS) != 0; i++) {
        Vec2 at = trajectory->contacts[i].point;
        stroke_dot(drawing, panel_point(picture, panel, (double)at.x, (double)at.y), marks_dot(picture), theme->panel,
                   theme->impulse, &picture->layout.panels[panel]);
    }
}

void marks_draw_above(const Picture *picture, int panel, Moment moment, Drawing *drawing) {
    int first = picture_run(picture, panel);
    for (int run = first; run < runs_end(picture, first); run++) {
        if (picture->look.show & LOOK_VELOCITIES) draw_velocities(picture, panel, run, moment, drawing);
        if (picture->look.show & (LOOK_CONTACTS | LOOK_IMPULSES)) draw_contacts(picture, panel, run, moment, drawing);
    }
}
