/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of a picture: poses, marks, captions, cards, grids, extents. */
#pragma once
#include "base/base.h"
#include "pictures/picture.h"
#include "pictures/style.h"
#include "pixels/gl.h"
#include "pixels/png.h"
#include "runs/trajectory.h"

#include <math.h>

/* The pose of a body at a moment. */

typedef struct Pose {
    double x, y, angle; /* m, rad; NaN or infinite if the body does not exist */
} Pose;

/* The moment that a run shows: its last frame after it has ended. */
static inline Moment pose_moment(const Trajectory *run, Moment moment) {
    if (moment.frame >= run->frames - 1) moment.frame = run->frames - 1, moment.part = 0;
    return moment;
}

static inline Pose pose_stored(const Trajectory *run, int frame, int body) {
    size_t i = trajectory_at(run, frame, body);
    return (Pose){(double)run->position[i].x, (double)run->position[i].y, (double)run->angle[i]};
}

/* Linear interpolation between two frames, as the engine moves bodies: x += v dt. Angles do not wrap in a run, so no
   shortest arc is needed. A body appears with its first frame; one that disappears keeps its last pose. */
static inline Pose pose_at(const Trajectory *run, Moment moment, int body) {
    moment = pose_moment(run, moment);
    Pose pose = pose_stored(run, moment.frame, body);
    if (moment.part == 0 || !trajectory_has(run, moment.frame + 1, body)) return pose;
    const Pose next = pose_stored(run, moment.frame + 1, body);
    const double fraction = moment_fraction(moment);
    return (Pose){pose.x + fraction * (next.x - pose.x), pose.y + fraction * (next.y - pose.y),
                  pose.angle + fraction * (next.angle - pose.angle)};
}

static inline int pose_step(const Trajectory *run, Moment moment) {
    return trajectory_contact_step(run, pose_moment(run, moment).frame);
}

/* m. sqrt is correctly rounded on every machine; hypot is not. */
static inline double pose_distance(Pose a, Pose b) {
    double x = a.x - b.x, y = a.y - b.y;
    return sqrt(x * x + y * y);
}

/* One panel: grid, bodies, axes, marks. */

/* The static layer: grid, static bodies, axes. Its shapes are behind all others. */
void panel_draw_static(const Picture *picture, int panel, Moment moment, Drawing *drawing);

/* The dynamic bodies, the bomb on top, and the marks. */
void panel_draw_moving(const Picture *picture, int panel, Moment moment, Drawing *drawing);

/* Converts a point from metres to pixels of the picture. */
Point panel_point(const Picture *picture, int panel, double x, double y);

/* The shorter side of a panel in pixels; line thicknesses are relative to it. */
double panel_side(const Picture *picture);

/* The number of dynamic bodies whose centre is outside the panel, without the bomb: an arrow points to it. */
int panel_count_out_of_view(const Picture *picture, int panel, Moment moment);

/* The legend of outlines, colours, dots and arrows, in rows below the panels. */
#define ARROW_NOTE "(two heads: ten times as much is a third longer)"

/* The rows it needs at the picture's width; 0: nothing to explain. */
int legend_rows(const Picture *picture);
void legend_draw(const Picture *picture, Drawing *drawing);

/* A moving camera, planned for the whole run so that it can anticipate. */

/* The cameras of all frames, for panels of this size; the caller frees them. `fit` is the fixed camera. NULL with
   error set if out of memory. Uses only + - * /, so the result is the same on every machine. */
Camera *camera_path(const Trajectory *const *runs, int frames, LookCamera kind, const Events *events, const Camera *fit,
                    int width, int height, Error *error);

/* The camera at a moment, interpolated between frames. */
Camera camera_at(const Camera *path, int frames, Moment moment, int width, int height);

/* Below the panels: the largest distance of each run from the first over time; logarithmic, as errors grow by powers
   of ten. */

/* Fills the picture's curves if the look shows them. */
bool timeline_plan(Picture *picture, Error *error);

/* Axes, curves, event lines, title and key. */
void timeline_draw_static(const Picture *picture, Drawing *drawing);

/* The current time and the runs' current distances. */
void timeline_draw_moving(const Picture *picture, Moment moment, Drawing *drawing);

/* A title on several lines. */

enum { TEXT_LINES_MAX = 4 };

typedef struct TextLines {
    int count; /* lines that the text needs; at least 1 */
    char lines[TEXT_LINES_MAX][CAPTION_TEXT_SIZE];
} TextLines;

/* Breaks a text at spaces, or within a word longer than a line, into lines of at most `first` pixels and then `others`.
   If it needs more than TEXT_LINES_MAX, the last of these has the rest. The first stays empty if only the others have
   room for the first word. */
TextLines text_lines(const Font *font, const char *text, int first, int others);

/* Where a picture has its texts, axes and curves. Whatever is drawn outside the panels and their frames is in one of
   these parts. */

typedef enum PartKind { PART_HEADER, PART_CAPTION, PART_AXIS, PART_LEGEND, PART_TIMELINE } PartKind;

typedef struct Part {
    PartKind kind;
    int panel; /* captions and axes: the panel; otherwise -1 */
    Rect rect;
} Part;

/* Two axes and a caption for each panel, and one of each other kind. */
enum { PARTS_MAX = 3 * RENDER_PANELS_MAX + 3 };

/* The names in manifests, in the order of PartKind. */
extern const char *const part_names[];

/* Fills `parts` and returns their number; 0 in a picture too small for text and without a timeline. */
int parts_find(const Picture *picture, Part parts[PARTS_MAX]);

/* Marks in a panel: trails below the bodies, contacts and arrows above, and what points to a bomb outside. */

void marks_draw_below(const Picture *picture, int panel, Moment moment, Drawing *drawing);
void marks_draw_above(const Picture *picture, int panel, Moment moment, Drawing *drawing);

/* The bomb's way until it strikes. */
DashedLine approach_line(const Picture *picture);

/* In pixels: radius of contact dots, thickness of trails and arrows. */
double marks_dot_radius(const Picture *picture);
double marks_line_thickness(const Picture *picture);
ArrowStyle marks_arrow_style(const Picture *picture, uint32_t color);

/* The mark of a contact that does this; its tangent has this cosine and sine. `wrong`: the reference's does
   something else. */
typedef struct ModeMark {
    Point at;
    double cosine, sine, radius; /* pixels: of a contact's dot */
    ContactMode mode;
    bool wrong;
} ModeMark;
void marks_draw_mode(const Picture *picture, const ModeMark *mark, const Rect *clip, Drawing *drawing);

/* The grid of panels in which the scene is largest, and their camera. */

/* The texts of the picture. They depend only on the trajectories and options, not on the machine or the time. */

/* The title, on up to TEXT_LINES_MAX lines, and the slow motion; at the right the frame, the simulated time and, for
   two panels, their distance. */
void caption_header(const Picture *picture, Moment moment, Drawing *drawing);

/* Above a panel, its method and, if there are more than two runs, its distance from the first run. Nothing is cut: a
   long name goes on on further lines; descriptions stand beside the names, in smaller type, below the names, or
   nowhere, in all panels alike. The number of bodies out of view stands in the panel if there is no room beside the
   name. */
void caption_panel(const Picture *picture, int panel, Moment moment, Drawing *drawing);

/* Of the longest caption, at the panels' width; of an overlay, lines that its runs share. */
int caption_lines(const Picture *picture);

/* Refuses captions that the options set and that need more than TEXT_LINES_MAX lines. */
bool captions_fit(const Picture *picture, Error *error);

/* The title in the header: its first line beside the numbers at the right, in any frame. */
TextLines caption_header_title(const Picture *picture);

/* Pixels that a panel needs for the shortest form of any run's name; or for the whole name beside a distance. */
int caption_least_width(const Picture *picture, bool whole);

/* Draws a name in at most `room` pixels: in the font if it fits, otherwise in the small one, there cut if need be.
   Returns the x where it ends. */
int caption_name_draw(const Picture *picture, const Font *font, const char *name, int x, int baseline, int room,
                      Drawing *drawing);

/* Shares room between texts of these widths: the largest width that none has to exceed for all to fit. */
int caption_fair_width(const int *widths, int count, int room);

/* "pyramid_settled" -> "Pyramid settled": the options' title, or the scene's name. */
void caption_title(const Picture *picture, char title[CAPTION_TEXT_SIZE]);

/* The name of a run's method (methods/methods.h) and what it is: "engine" and "physics engine, sequential impulses"; of
   an external one with what its program calls itself. The second may be empty. Or the caption that the options set for
   the run, without a second. */
void caption_method(const Picture *picture, int run, char name[CAPTION_TEXT_SIZE], char note[CAPTION_TEXT_SIZE]);

/* Text after the name: the options' note, the cost and what the method is. */
void caption_notes(const Picture *picture, int run, const char *note, char *text, size_t size);

/* Formats a distance for captions with at most four characters: "0.35", "35.2", "352", ">999", or a dash for NaN. */
void caption_distance(char *text, size_t size, double metres);

/* Numbers with a label and a unit in captions. */

typedef struct CaptionItem {
    char label[16], number[CAPTION_TEXT_SIZE], unit[8];
} CaptionItem;

/* The title card before a run and the end card with its results. */

/* The title of a card, MOMENT_TITLE or MOMENT_END, in its lines. */
TextLines card_head(const Picture *picture, MomentKind kind);

/* What the end card's table has: picture->card_base and card_rows. */
void card_plan(Picture *picture);

/* `moment` has kind MOMENT_TITLE or MOMENT_END. */
void card_draw(const Picture *picture, Moment moment, Drawing *drawing);

/* Draws boxes, filled or as outlines, into a panel and clipped to it. */

/* A body's box in a panel, in these colours. */
Shape body_shape(const Picture *picture, int panel, int run, Moment moment, int body, const BodyColors *colors);

/* Draws a body of a run; the bomb with its target. */
void body_draw(const Picture *picture, int panel, int run, Moment moment, int body, Drawing *drawing);

/* The label of a body's box of this shape. False: none, or not large enough to be read, or not inside the panel. */
typedef struct BodyLabel {
    char text[64];
    Font font;
    int left, baseline;
    uint32_t ink;
} BodyLabel;
bool body_label(const Picture *picture, int panel, int run, int body, const Shape *shape, BodyLabel *label);

/* Draws all static bodies of a run (`fixed`), or all dynamic bodies except the bomb. */
void body_draw_all(const Picture *picture, int panel, int run, Moment moment, bool fixed, Drawing *drawing);

/* Draws the outlines of a run's dynamic bodies. */
void body_draw_outlines(const Picture *picture, int panel, int run, Moment moment, Drawing *drawing);

/* Draws a small box in the run's colours, filled or as outline, on the baseline of text of this size. Returns its
   right edge. */
int body_draw_swatch(const Picture *picture, int run, bool hollow, int left, int baseline, int pixels,
                     Drawing *drawing);
