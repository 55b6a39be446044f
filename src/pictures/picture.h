/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a frame shows: camera, panels, captions, legend, timeline, theme. */
#pragma once
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "pictures/colours.h"
#include "pixels/gl.h"
#include "runs/framing.h"
#include "runs/trajectory.h"

#include <stdbool.h>
#include <stdint.h>

/* The camera, from metres to pixels: the same for all panels. */

/* A point (x, y) in metres is at pixel (left + scale * x, top - scale * y) of a panel. `left` and `top` are
   integers, and so is a large scale: grid lines at whole metres then fall between pixels and stay crisp. */
typedef struct Camera {
    double scale; /* pixels per metre */
    double left, top;
} Camera;

/* Width and height in metres that a panel should have room for. */
Vec2 camera_needs(const CameraFrame *frame);

/* For a panel of this size in pixels. */
Camera camera_fit(const CameraFrame *frame, int width, int height);

/* What a sequence shows besides the bodies, and how. All zero: panels side by side, light theme. */

enum { LOOK_RUNS_MAX = 6 };

typedef enum LookCompare {
    LOOK_SPLIT,     /* one panel per run */
    LOOK_OVERLAY,   /* one panel: the first run filled, the others as outlines */
    LOOK_DIFFERENCE /* one panel per run except the first, coloured by the distance from it; its bodies as outlines */
} LookCompare;

typedef enum LookCamera {
    LOOK_FIT,       /* fixed */
    LOOK_BOMB,      /* follows the first run's bomb */
    LOOK_DIVERGENCE /* moves close to the first divergence and back */
} LookCamera;

typedef enum LookTheme { LOOK_LIGHT, LOOK_DARK } LookTheme;

/* What stands in boxes that move and are large enough: nothing, the number of the body, its mass in kg, its name. */
typedef enum LookLabels { LOOK_NO_LABELS, LOOK_NUMBERS, LOOK_MASSES, LOOK_NAMES } LookLabels;

/* What --show and the check boxes of a page add to the bodies, a line each: name, what --help says after it, what it
   needs ("others": a second run; else runs that have "contacts", "velocities" or both), and the script in
   src/pictures/player that draws it in a page; NULL: a page has no such box. A new one has its line at the end, its
   entry in legend.c and player/legend.js, and is drawn where the others are: in marks.c, below or above the bodies, and
   in its script. */
#define SHOW_MARKS(MARK)                                                                   \
    MARK(GHOSTS, "ghosts", " (outlines of the first run)", "others", "layout.js")          \
    MARK(DISTANCE, "distance", " (colours)", "others", "boxes.js")                         \
    MARK(TRAILS, "trails", "", "", "picture.js")                                           \
    MARK(CONTACTS, "contacts", "", "contacts", "marks.js")                                 \
    MARK(IMPULSES, "impulses", "", "contacts", "marks.js")                                 \
    MARK(VELOCITIES, "velocities", " (arrows)", "velocities", "marks.js")                  \
    MARK(TIMELINE, "timeline", " (distance from the first run over time)", "others", NULL) \
    MARK(MODES, "modes", " (of contacts)", "contacts and velocities", "marks.js")

/* SHOW_GHOSTS, ...: the bits of `show`, each at the place of its line. */
#define SHOW_PLACE(NAME, ...) SHOW_PLACE_##NAME,
#define SHOW_BIT(NAME, ...) SHOW_##NAME = 1 << SHOW_PLACE_##NAME,
enum { SHOW_MARKS(SHOW_PLACE) SHOW_COUNT };
enum { SHOW_MARKS(SHOW_BIT) };
_Static_assert(SHOW_COUNT <= 31, "each mark has a bit of `show`, of which an int has the value");

typedef struct ShowMark {
    const char *name, *needs, *script;
} ShowMark;

extern const ShowMark show_marks[SHOW_COUNT];

/* Of modes of contacts, and last of those that the reference's contact does not have. */
extern const char *const mode_words[CONTACT_MODES + 1];

typedef struct RenderLook {
    LookCompare compare;
    LookCamera camera;
    CameraView view;             /* the fixed view, where a moving camera begins; width 0: that of `view_from` */
    const Trajectory *view_from; /* the run that the fixed camera shows; NULL: all */
    LookTheme theme;
    LookLabels labels;
    unsigned show; /* SHOW_GHOSTS | ... */
    bool approach; /* where the bomb appears and its way until it strikes, in every frame, instead of `show` */
    const char *costs[LOOK_RUNS_MAX]; /* cost of each run, as text; NULL: none */
    const char *end;                  /* title of the end card; NULL: a default */
} RenderLook;

/* The names used in options, in the order of the enums and of SHOW_MARKS; each list ends with NULL. */
extern const char *const look_compare_names[],
    *const look_camera_names[], *const look_theme_names[], *const look_labels_names[], *const look_show_names[];

/* The light theme's colours, 0xRRGGBB; those of bodies: pictures/colours.h. */

static const uint32_t PAGE = 0xF5F6F8, PANEL = 0xFFFFFF, FRAME = 0xC3C9D2;
static const uint32_t GRID = 0xF0F2F5, GRID_STRONG = 0xDFE3E9;
static const uint32_t INK = 0x1B2330, INK_SOFT = 0x667080;
static const uint32_t GROUND = 0xD3D8DF, GROUND_LINE = 0x5A6472;

#define BOMB_COLORS \
    { 0xA0200F, 0x4E0A03, 0xFFE9DF }
static const BodyColors BOMB = BOMB_COLORS;

/* The colours of a whole picture, 0xRRGGBB: light, as above, or dark. */
typedef struct Theme {
    uint32_t page, panel, frame, grid, grid_strong, ink, ink_soft, ground, ground_line;
    uint32_t impulse, velocity; /* arrows */
    uint32_t slips;             /* contacts that slide */
    uint32_t event;             /* event lines in the timeline */
    BodyColors bomb;
    bool ghost_is_band;         /* outlines of a run over others have the colour of its bands, else of its boxes */
    double ramp_near, ramp_far; /* range of the colour scale: large distances stand out most */
} Theme;

const Theme *theme_get(LookTheme theme);

/* Linear mix of two colours, `share` 0 to 1. */
uint32_t theme_mix(uint32_t from, uint32_t to, double share);

/* Position on the colour scale, 0 to 1: yellow, green, teal, blue, violet; CIE L* from 95 to 13 in equal steps, so
   that it is readable in grey and with all common kinds of colour blindness. */
uint32_t theme_ramp(const Theme *theme, double share);

/* The colours between which it mixes, at equal distances. */
enum { THEME_STOPS = 11 };
extern const uint32_t theme_stops[THEME_STOPS];

/* The key frames of a comparison: impact and first divergence. */

/* m; smaller distances are invisible in a picture */
#define EVENTS_VISIBLE_DISTANCE 1e-3

typedef struct Events {
    int impact;     /* trajectory_impact() of the first run that has one; -1: none */
    int divergence; /* first frame where a body is more than this from the first run's; -1: none */
    int run, body;  /* the run and the body that diverge first */
} Events;

/* Runs whose world differs from the first run's are not compared. */
Events events_find(const Trajectory *const *runs, int count);

/* The options of pictures/render.h; a picture needs some of them. */

enum {
    RENDER_PANELS_MAX = LOOK_RUNS_MAX,
    RENDER_SIDE_MIN = 64,
    RENDER_SIDE_MAX = 8192,
    RENDER_JOBS_MAX = 256,
    RENDER_SLOW_MAX = 16, /* factor */
    RENDER_HOLD_MAX = 60, /* s */
    RENDER_FPS_MIN = 1,
    RENDER_FPS_MAX = 240,
    RENDER_DURATION_MAX = 3600 /* s */
};

#define RENDER_DURATION_MIN 0.01 /* s */

typedef struct RenderOptions {
    int width, height; /* pixels, RENDER_SIDE_MIN .. RENDER_SIDE_MAX */
    ContextChoice context;
    int first, last;                         /* frames, inclusive; last -1: to the end */
    int jobs;                                /* processes, 1 .. RENDER_JOBS_MAX */
    const char *directory;                   /* created if missing */
    bool small;                              /* smallest files that libpng can write; slow */
    const char *title;                       /* in the header; NULL: the scene's name */
    const char *captions[RENDER_PANELS_MAX]; /* instead of a run's method and its description; NULL or "": these */
    const char *notes[RENDER_PANELS_MAX];    /* after a panel's method; NULL: none */
    /* The description of a run's method ("engine:k=20"), for its title and caption. NULL, or returns NULL: the text of
       the method is its title. */
    const MethodDescription *(*describe)(const char *method);
    ColourChoices colours;
    RenderLook look;           /* zeros: bodies side by side */
    int slow;                  /* slow-motion factor around the impact; 0, 1: none */
    double hold;               /* s, repeats the last frame */
    double fps;                /* pictures per second of real time; 0: the run's frames */
    double duration;           /* s, of the whole film: the run is shown faster or slower; 0: real time */
    bool title_card, end_card; /* before and after the run */
    bool resume;               /* keep the frames that an earlier, equal call has written */
    bool store_runs;           /* beside the frames, each as its trajectory_file_name() */
} RenderOptions;

/* The layout of a picture of a given size. */

typedef struct Layout {
    Font scene, status, title, method, axis; /* without glyphs if the picture is too small for text */
    int columns, rows;
    int left, right;                  /* inner edges of the margins */
    int header_baseline;              /* of the first line of the title */
    int header_lines, header_pitch;   /* number of its lines, and the distance between them */
    int title_rise;                   /* from the top of a panel up to the last baseline of its caption */
    int caption_lines, caption_pitch; /* number of its lines, and the distance between them */
    int axis_drop;                    /* from the bottom of a panel down to the baseline of its axis */
    int tick;                         /* length of a tick at the axis */
    int hairline;                     /* the thinnest line */
    Rect area;                        /* that the panels share, with the lines between them */
    int gap, row_gap;                 /* between panels */
    Rect panels[RENDER_PANELS_MAX];   /* all of equal size */
    int width, height;                /* of the picture */
    int legend_baseline;              /* of the first row; 0: no legend */
    int legend_rows, legend_pitch;    /* number of rows, and the distance between them */
    int key_baseline;                 /* of the key above the timeline */
    Rect timeline;                    /* the curves; empty: none */
} Layout;

/* Rows above and below the panels. */
typedef struct LayoutRows {
    int title, caption; /* lines of the header and of captions, at least 1 */
    int legend;
    bool timeline;
} LayoutRows;

/* The panels fill their area. */
Layout layout_make(int width, int height, int panels, int columns, LayoutRows rows);

/* A moment is what one picture of a video shows: a stored frame, a time between two frames, or a card. A video is a
   list of moments; without slow motion, hold and cards these are the stored frames in order. */

typedef enum MomentKind {
    MOMENT_STORED,  /* a frame as stored */
    MOMENT_BETWEEN, /* poses interpolated between a frame and the next */
    MOMENT_TITLE,   /* a card before the run */
    MOMENT_END      /* a card after the run */
} MomentKind;

typedef struct Moment {
    MomentKind kind;
    int frame; /* the frame shown, or the one before */
    int part,
        parts;   /* MOMENT_BETWEEN: position between this frame and the next, 0 < part < parts; otherwise part is 0, and
                        parts > 1 if the pictures beside it may be interpolated */
    double slow; /* times slower than real time; below 1: faster */
} Moment;

static inline Moment moment_stored(int frame) { return (Moment){MOMENT_STORED, frame, 0, 1, 1}; }

/* The position between the frame and the next, 0 <= fraction < 1. */
static inline double moment_fraction(Moment moment) { return (double)moment.part / moment.parts; }

/* The scales of arrows and colours, chosen once for all panels and frames. */

typedef struct Scales {
    double box;                             /* pixels, shorter side of the median box of the first run */
    double impulse, velocity;               /* pixels per N s and per m/s */
    double legend_impulse, legend_velocity; /* the values of the legend's arrows, round numbers */
    double max_arrow;                       /* pixels; a longer arrow grows by a third per decade, and has two heads */
    int last_decade;                        /* the colour scale ends at 10^last_decade m */
    bool exceeded;                          /* some distances exceed the end */
} Scales;

/* What the scales follow from. */
typedef struct ScaleMeasures {
    double impulse; /* N s, 90th percentile of the positive impulses; 0: no contacts */
    double speed;   /* m/s, of the fastest body */
    double box;     /* m, shorter side of the median box */
} ScaleMeasures;

/* False with error set if out of memory. */
bool scales_measure(const Trajectory *run, ScaleMeasures *measures, Error *error);

/* From the first run; `scale` in pixels per metre, `largest_distance` in m. Arrows are in proportion to the panel, but
   to its boxes where these are small, or they would cover them. False with error set if out of memory. */
bool scales_choose(Scales *scales, const Trajectory *run, const Layout *layout, double scale, double largest_distance,
                   Error *error);

/* Position of a distance (m) on the logarithmic colour scale, 0 to 1. */
double scales_share(const Scales *scales, double distance);

/* The picture of one frame of a comparison: panels side by side below one header. Independent of OpenGL. */

/* How far a run is from the one that the end card compares with. */
typedef struct CardRow {
    double last, largest; /* m: in the last frame of both, and in any */
    int frame;            /* the first in which that can be seen; -1: none */
} CardRow;

/* Everything that is chosen once per sequence, from the whole run, so that only bodies move between frames. */
typedef struct Picture {
    const Trajectory *runs[RENDER_PANELS_MAX]; /* one panel per run, unless the look requires otherwise */
    int count;
    int frames; /* of the longest run */
    Layout layout;
    Camera camera;           /* for a panel whose upper left corner is (0, 0) */
    double label_least;      /* pixels: letters of labels that are smaller are not drawn; 0: LABEL_LEAST */
    bool labels_apart;       /* boxes are drawn without them */
    double grid_scale;       /* pixels per metre used to choose the grid; constant while the camera moves */
    double largest_distance; /* m, over the whole run */
    const char *title;       /* as in RenderOptions; must outlive the picture */
    const char *captions[RENDER_PANELS_MAX];
    const char *notes[RENDER_PANELS_MAX];
    const MethodDescription *methods[RENDER_PANELS_MAX]; /* of the runs; NULL: unknown */
    RunColours colours[RENDER_PANELS_MAX];               /* of the runs, all different */
    RenderLook look;
    const Theme *theme;
    int panel_count; /* number of panels drawn */
    Events events;
    Scales scales;
    Camera *path;  /* [frames], or NULL if the camera is fixed */
    float *curves; /* [count][curve_points], m: the largest distance from the first run in each interval; NaN after
                      the run's end. NULL without a timeline. */
    int curve_points;
    int mode_base; /* the run with which modes of contacts are compared; -1: none */
    int card_base; /* the run that the end card compares with */
    CardRow card_rows[RENDER_PANELS_MAX];
} Picture;

/* Plans a picture with the default look. ERROR_INPUT if the runs cannot be shown side by side. The trajectories must
   outlive the picture. */
bool picture_plan(Picture *picture, const Trajectory *const *runs, int count, int width, int height, Error *error);

/* Takes the texts and the look from the options, or fails like look_check(). picture_free() frees the result, also
   after an error. */
bool picture_apply_options(Picture *picture, const RenderOptions *options, Error *error);
void picture_free(Picture *picture);

/* Plans and discards: whether the runs can be drawn with these options. */
bool picture_check(const Trajectory *const *runs, int count, const RenderOptions *options, Error *error);

/* ERROR_INPUT if the runs do not support the look: it compares different bodies, or follows a bomb that does not
   exist. */
bool look_check(const RenderLook *look, const Trajectory *const *runs, int count, Error *error);

/* The camera of a moment, for a panel whose upper left corner is (0, 0). */
Camera picture_camera(const Picture *picture, Moment moment);

/* Draws a moment into a cleared drawing. */
void picture_draw(const Picture *picture, Moment moment, Drawing *drawing);

/* The frame that a run shows: its last one after it has ended. */
int picture_run_frame(const Picture *picture, int run, int frame);

/* The run that a panel shows; for an overlay the first. */
int picture_run(const Picture *picture, int panel);

/* Whether a panel shows the run's bodies as outlines. */
bool picture_draws_outlines(const Picture *picture, int panel, int run);

/* The colours of a run's bodies, and of its bodies as outlines over those of other runs. */
const BodyColors *picture_body_colors(const Picture *picture, int run);
uint32_t picture_ghost_color(const Picture *picture, int run);

/* Whether the run's bodies are coloured by their distance from the first run's. */
bool picture_colors_distance(const Picture *picture, int run);

/* The largest distance (m) of a body from the same body in the first run; NaN for the first run and after the end of
   either. */
double picture_run_distance(const Picture *picture, int run, Moment moment);

/* The largest over all runs. */
double picture_distance(const Picture *picture, Moment moment);

/* Refuses a title or caption that is too long or cannot be drawn (pixels/type.h); `where`: its option. NULL passes. */
bool caption_check(const char *text, const char *where, Error *error);

/* Of a title, a caption or a name, bytes with the NUL. */
enum { CAPTION_TEXT_SIZE = 256 };
