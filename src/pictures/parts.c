/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is drawn in panels, bodies and marks; the key events of runs; and where the parts of a picture are. */
#include "base/numbers.h"
#include "engine/engine.h"
#include "pictures/pictures_internal.h"
#include "pictures/picture.h"
#include "pixels/gl.h"
#include "pixels/png.h"
#include "runs/trajectory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A box of the given width and height in pixels, not rotated, at (0, 0). */
static Shape styled_box(const Picture *picture, double width, double height, const BodyColors *colors) {
    double side = fmin(width, height), limit = panel_side(picture);
    double outline = fmin(fmax(OUTLINE * side, MIN_OUTLINE), fmax(MAX_OUTLINE * limit, MIN_OUTLINE));
    return (Shape){.half_width = width / 2,
                   .half_height = height / 2,
                   .cosine = 1,
                   .radius = fmin(CORNER * side, MAX_CORNER * limit),
                   .outline = side < MIN_OUTLINED_SIDE ? 0 : outline,
                   .fill = colors->fill,
                   .line = colors->line,
                   .band = (side < MIN_OUTLINED_SIDE ? 0 : outline) + BAND * side,
                   .band_color = colors->band};
}

static void parts_place(Shape *shape, const Picture *picture, int panel, const Pose *pose) {
    Point at = panel_point(picture, panel, pose->x, pose->y);
    shape->x = at.x, shape->y = at.y;
    shape->cosine = cos(pose->angle), shape->sine = sin(pose->angle);
}

static void draw_part(Shape part, const Shape *whole, double up, const Rect *clip, Drawing *drawing) {
    part.cosine = whole->cosine, part.sine = whole->sine;
    part.x = whole->x - up * whole->sine, part.y = whole->y - up * whole->cosine;
    drawing_add_shape(drawing, &part, clip);
}

/* A dot in a ring, and a bar from the ring towards the local top. */
static void draw_target(const Shape *bomb, double radius, uint32_t light, const Rect *clip, Drawing *drawing) {
    const double third = radius / TARGET_THIRD;
    Shape bar = {.half_width = radius / TARGET_BAR, .half_height = TARGET_BAR_HEIGHT * radius, .fill = light};
    Shape ring = {.half_width = radius, .half_height = radius, .radius = radius, .outline = third};
    Shape dot = {.half_width = third, .half_height = third, .radius = third, .fill = light};
    ring.fill = bomb->fill, ring.line = light;
    draw_part(bar, bomb, TARGET_BAR_RISE * radius, clip, drawing);
    draw_part(ring, bomb, 0, clip, drawing);
    draw_part(dot, bomb, 0, clip, drawing);
}

/* Filled by the colour scale of the distance; the band contrasts with both its ends. Grey if there is no distance. */
static BodyColors distance_colors(const Picture *picture, int run, Moment moment, int body) {
    const Theme *theme = picture->theme;
    const Trajectory *first = picture->runs[0], *other = picture->runs[run];
    uint32_t line = picture_body_colors(picture, run)->line;
    bool ended = moment.frame >= first->frames || moment.frame >= other->frames;
    double distance = pose_distance(pose_at(first, moment, body), pose_at(other, moment, body));
    if (ended || isnan(distance)) return (BodyColors){theme->ground, line, theme->ground_line};
    double share = scales_share(&picture->scales, distance);
    uint32_t fill = theme_ramp(theme, share), white = 0xFFFFFF;
    bool is_light = (int)(fill >> 8 & 255) > LIGHT_GREEN;
    return (BodyColors){fill, line, is_light ? theme_mix(fill, 0, BAND_DARKER) : theme_mix(fill, white, BAND_LIGHTER)};
}

static BodyColors colors_of(const Picture *picture, int run, Moment moment, int body) {
    const Theme *theme = picture->theme;
    const Trajectory *trajectory = picture->runs[run];
    if (trajectory->fixed[body]) return (BodyColors){theme->ground, theme->ground_line, theme->ground};
    if (picture_colors_distance(picture, run)) return distance_colors(picture, run, moment, body);
    BodyColors colors = body == trajectory->bomb ? theme->bomb : *picture_body_colors(picture, run);
    if (picture->look.compare != LOOK_OVERLAY) return colors;
    return (BodyColors){theme_mix(colors.fill, theme->panel, FADE), colors.line,
                        theme_mix(colors.band, theme->panel, FADE)};
}

static Shape body_shape(const Picture *picture, int panel, int run, Moment moment, int body, const BodyColors *colors) {
    const Trajectory *trajectory = picture->runs[run];
    double scale = picture->camera.scale;
    Shape shape =
        styled_box(picture, scale * (double)trajectory->size[body].x, scale * (double)trajectory->size[body].y, colors);
    Pose pose = pose_at(trajectory, moment, body);
    parts_place(&shape, picture, panel, &pose);
    return shape;
}

/* Text in a box: a name, or up to three digits of a mass, as the page's script writes numbers. */
static void label_text(const Picture *picture, int run, int body, char *text, size_t size) {
    const double mass = (double)picture->runs[run]->mass[body];
    char rounded[32];
    if (picture->look.labels == LOOK_NUMBERS) {
        snprintf(text, size, "%d", body);
        return;
    }
    if (picture->look.labels == LOOK_NAMES) {
        snprintf(text, size, "%s", picture->runs[run]->name[body].text);
        return;
    }
    snprintf(rounded, sizeof rounded, "%.2e", mass);
    const int exponent = atoi(strchr(rounded, 'e') + 1), places = exponent < 2 ? 2 - exponent : 0;
    snprintf(text, size, "%.*f", places, strtod(rounded, NULL));
    if (places == 0) return;
    for (size_t end = strlen(text); end > 0 && (text[end - 1] == '0' || text[end - 1] == '.'); end--) {
        const bool point = text[end - 1] == '.';
        text[end - 1] = '\0';
        if (point) break;
    }
}

static bool is_light(uint32_t color) {
    const double red = (color >> 16 & 255) / 255.0, green = (color >> 8 & 255) / 255.0, blue = (color & 255) / 255.0;
    return RED_LIGHT * red * red + GREEN_LIGHT * green * green + BLUE_LIGHT * blue * blue > LABEL_DARK_FROM;
}

/* Width / size of the letters: digits take the same room whatever they are, letters of a name what they need. */
static double label_ems(const Picture *picture, const char *text) {
    if (picture->look.labels != LOOK_NAMES) return LABEL_EMS * fmax((double)strlen(text), LABEL_DIGITS);
    const Font font = font_pick(FONT_SEMIBOLD, LABEL_MEASURED);
    return fmax(font_width(&font, text) / (double)font.pixels, LABEL_EMS * LABEL_DIGITS);
}

/* Whether the label of a box of this shape is drawn: if it is large enough to be read, and inside the panel. */
static bool draw_label(const Picture *picture, int panel, int run, int body, const Shape *shape, Drawing *drawing) {
    if (picture->look.labels == LOOK_NO_LABELS || picture->runs[run]->fixed[body]) return false;
    char text[64];
    label_text(picture, run, body, text, sizeof text);
    if (text[0] == '\0') return false; /* no name */
    const double ems = label_ems(picture, text), side = 2 * fmin(shape->half_width, shape->half_height);
    const double most = LABEL_CIRCLE * side / sqrt(ems * ems + LABEL_CAP * LABEL_CAP);
    const Rect *rect = &picture->layout.panels[panel];
    if (!(most >= LABEL_LEAST) || !(shape->x > rect->left && shape->x < rect->right) ||
        !(shape->y > rect->top && shape->y < rect->bottom))
        return false;
    const Font font = font_pick(FONT_SEMIBOLD, most);
    const int width = font_width(&font, text), height = (int)ceil(LABEL_CAP * font.pixels);
    const int left = (int)rint(shape->x - width / 2.0), baseline = (int)rint(shape->y + height / 2.0);
    if (left < rect->left || left + width > rect->right || baseline - height < rect->top || baseline > rect->bottom)
        return false;
    font_add(drawing, &font, text, left, baseline, is_light(shape->fill) ? INK : PANEL);
    return true;
}

void body_draw(const Picture *picture, int panel, int run, Moment moment, int body, Drawing *drawing) {
    const Trajectory *trajectory = picture->runs[run];
    const Rect *clip = &picture->layout.panels[panel];
    bool fixed = trajectory->fixed[body], bomb = body == trajectory->bomb;
    BodyColors colors = colors_of(picture, run, moment, body);
    Shape shape = body_shape(picture, panel, run, moment, body, &colors);
    if (fixed) shape.radius = 0;
    if (fixed || bomb) shape.band = 0;
    drawing_add_shape(drawing, &shape, clip);
    double side = 2 * fmin(shape.half_width, shape.half_height);
    const bool labelled = draw_label(picture, panel, run, body, &shape, drawing);
    if (bomb && !labelled) draw_target(&shape, TARGET * side, colors.band, clip, drawing);
}

void body_draw_all(const Picture *picture, int panel, int run, Moment moment, bool fixed, Drawing *drawing) {
    const Trajectory *trajectory = picture->runs[run];
    for (int body = 0; body < trajectory->bodies; body++)
        if ((trajectory->fixed[body] != 0) == fixed && body != trajectory->bomb)
            body_draw(picture, panel, run, moment, body, drawing);
}

/* The first run's bomb keeps its colour; the others have the colour of their run. */
static uint32_t outline_color(const Picture *picture, int run, Moment moment, int body) {
    const Theme *theme = picture->theme;
    if (picture_colors_distance(picture, run)) return colors_of(picture, run, moment, body).fill;
    if (run > 0) return picture_body_colors(picture, run)->fill;
    return body == picture->runs[0]->bomb ? theme->bomb.fill : picture_ghost_color(picture, 0);
}

/* Coincident outlines of several runs: later ones are thinner, so all are visible. */
void body_draw_outlines(const Picture *picture, int panel, int run, Moment moment, Drawing *drawing) {
    const Trajectory *trajectory = picture->runs[run];
    int above = picture->look.compare == LOOK_OVERLAY ? picture->count - 1 - run : 0;
    double thickness = fmax(GHOST_OUTLINE * panel_side(picture), MIN_GHOST_OUTLINE) *
                       (1 + above * fmin(NESTED_STEP, NESTED_TOTAL / picture->count));
    for (int body = 0; body < trajectory->bodies; body++) {
        if (trajectory->fixed[body]) continue;
        Shape shape = body_shape(picture, panel, run, moment, body, picture_body_colors(picture, run));
        shape.hollow = true;
        shape.line = outline_color(picture, run, moment, body);
        shape.outline = thickness;
        drawing_add_shape(drawing, &shape, &picture->layout.panels[panel]);
    }
}

int body_draw_swatch(const Picture *picture, int run, bool hollow, int left, int baseline, int pixels,
                     Drawing *drawing) {
    int side = pixels * 3 / 4;
    const BodyColors *colors = picture_body_colors(picture, run);
    Shape shape = styled_box(picture, side, side, colors);
    shape.x = left + side / 2.0;
    shape.y = baseline - side / 2.0;
    shape.hollow = hollow;
    if (hollow)
        shape.line = run == 0 ? picture_ghost_color(picture, 0) : colors->fill,
        shape.outline = fmax(MIN_SWATCH_OUTLINE, side / SWATCH_OUTLINE);
    drawing_add_shape(drawing, &shape, &(Rect){left, baseline - side, left + side, baseline});
    return left + side;
}

static double mark_size(const Picture *picture, double share, double least, double box_share) {
    return fmax(fmin(fmax(share * panel_side(picture), least), box_share * picture->scales.box), FINEST);
}

double marks_dot_radius(const Picture *picture) { return mark_size(picture, MARK_DOT, MIN_DOT, DOT_BOX); }

double marks_line_thickness(const Picture *picture) { return mark_size(picture, MARK_LINE, MIN_LINE, LINE_BOX); }

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
        end = segment_end(trajectory, moment, body, frame, TRAIL_TOLERANCE / picture->camera.scale);
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

/* Beyond the longest arrow that has the scale, ten times the value are drawn a third longer, so that values still
   differ; thousands end at twice its length. The same in player/marks.js. */
static double drawn_length(double length, double max_arrow) {
    return length <= max_arrow ? length : max_arrow * (1 + fmin(log10(length / max_arrow) / 3, 1));
}

/* An arrow with `scale` pixels per unit; y up. */
static void draw_arrow(const Picture *picture, int panel, Point from, double x, double y, double scale, uint32_t color,
                       Drawing *drawing) {
    double length = scale * sqrt(x * x + y * y), max_arrow = picture->scales.max_arrow;
    bool truncated = length > max_arrow;
    double pixels = truncated ? scale * drawn_length(length, max_arrow) / length : scale;
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
    if (picture->look.show & LOOK_APPROACH) draw_approach(picture, panel, drawing);
    for (int run = first; run < runs_end(picture, first); run++) {
        if (picture->look.show & LOOK_VELOCITIES) draw_velocities(picture, panel, run, moment, drawing);
        if (picture->look.show & (LOOK_CONTACTS | LOOK_IMPULSES)) draw_contacts(picture, panel, run, moment, drawing);
    }
}

/* Searches only the frames before the earliest divergence found so far. */
static void find_divergence(Events *events, const Trajectory *const *runs, int other) {
    const Trajectory *a = runs[0], *b = runs[other];
    int frames = a->frames < b->frames ? a->frames : b->frames;
    if (events->divergence >= 0 && events->divergence < frames) frames = events->divergence;
    for (int frame = 0; frame < frames; frame++)
        for (int body = 0; body < a->bodies; body++)
            if (trajectory_state_difference(a, b, frame, body).distance > EVENTS_VISIBLE_DISTANCE) {
                events->divergence = frame, events->run = other, events->body = body;
                return;
            }
}

Events events_find(const Trajectory *const *runs, int count) {
    Events events = {.impact = -1, .divergence = -1, .run = -1, .body = -1};
    char what[256];
    for (int i = 0; i < count && events.impact < 0; i++) events.impact = trajectory_impact(runs[i]);
    for (int i = 1; i < count; i++)
        if (!trajectory_different_worlds(runs[0], runs[i], what, sizeof what)) find_divergence(&events, runs, i);
    return events;
}

const char *const part_names[] = {"header", "caption", "axis", "legend", "timeline"};

enum { MARK_REACH = 8 }; /* pixels that the mark of the present time reaches beyond the curves, at most */

/* The heights of a line of text above and below its baseline. */
static int above(const Font *font) { return font->pixels; }
static int parts_below(const Font *font) { return font->pixels * 3 / 8; }

static int parts_add(Part *parts, int count, PartKind kind, int panel, Rect rect) {
    parts[count] = (Part){kind, panel, rect};
    return count + 1;
}

/* Labels at an end of an axis reach beyond it by half their size. The left axis is beside the first column only. */
static int add_panel(Part *parts, int count, const Layout *layout, int panel) {
    const Rect *rect = &layout->panels[panel];
    const int baseline = rect->top - layout->title_rise - (layout->caption_lines - 1) * layout->caption_pitch,
              line = layout->hairline, half = layout->axis.pixels / 2;
    count = parts_add(parts, count, PART_CAPTION, panel,
                      (Rect){rect->left, baseline - above(&layout->title), rect->right, rect->top - line});
    count = parts_add(parts, count, PART_AXIS, panel,
                      (Rect){rect->left - layout->axis.pixels, rect->bottom, rect->right + line,
                             rect->bottom + layout->axis_drop + parts_below(&layout->axis)});
    if (panel % layout->columns != 0) return count;
    return parts_add(parts, count, PART_AXIS, panel, (Rect){0, rect->top - half, rect->left, rect->bottom + half});
}

/* Half of the distance between rows, and a pixel for rounding, above and below the middle of the text: arrows are
   higher than characters. */
static Rect legend_rect(const Layout *layout) {
    const int middle = layout->legend_baseline - parts_below(&layout->axis), half = layout->legend_pitch / 2 + 1;
    return (Rect){0, middle - half, layout->width, middle + (layout->legend_rows - 1) * layout->legend_pitch + half};
}

/* The lane above the curves keeps the mark below their top where there is text, and the row of the key is above. */
static Rect timeline_rect(const Layout *layout) {
    const Rect *plot = &layout->timeline;
    const bool text = layout->axis.glyphs != NULL;
    const int foot = text ? int_max(layout->axis_drop + parts_below(&layout->axis), MARK_REACH) : MARK_REACH;
    const int top = text ? layout->key_baseline - above(&layout->method) : plot->top - layout->left;
    return (Rect){0, top, layout->width, plot->bottom + foot};
}

int parts_find(const Picture *picture, Part parts[PARTS_MAX]) {
    const Layout *layout = &picture->layout;
    const bool text = layout->axis.glyphs != NULL;
    int count = 0;
    if (text)
        count = parts_add(parts, count, PART_HEADER, -1,
                          (Rect){0, 0, layout->width,
                                 layout->header_baseline + (layout->header_lines - 1) * layout->header_pitch +
                                     parts_below(&layout->scene)});
    for (int panel = 0; text && panel < picture->panel_count; panel++) count = add_panel(parts, count, layout, panel);
    if (layout->legend_baseline > 0) count = parts_add(parts, count, PART_LEGEND, -1, legend_rect(layout));
    if (picture->curves != NULL) count = parts_add(parts, count, PART_TIMELINE, -1, timeline_rect(layout));
    return count;
}
