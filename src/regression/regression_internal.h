/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of this room: the steps of a comparison, pixels that do not count, the naming of changes, the report,
   approval. */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "pixels/png.h"
#include "regression/compare.h"
#include "regression/flip.h"
#include "regression/naming.h"
#include "regression/regression.h"
#include "regression/report.h"
#include "runs/trajectory.h"

#include <limits.h>
#include <stdio.h>

/* The steps of regression_run(). */

/* Compares the states behind the pictures. */

/* Finds and compares the .npz files of the same name in both folders. Ignores those that are a trajectory in neither
   folder; ERROR_INPUT if only one of the two is a trajectory. */
bool regression_find_runs(Regression *regression, Error *error);
void regression_free_run(RegressionRun *run);

/* Sets the states verdict of a frame. data: the two PNG files, whose texts are read. False with error set when memory
   is short. */
bool regression_judge_states(const Regression *regression, RegressionFrame *frame, uint8_t *const data[SIDES],
                             Error *error);

/* What the options and rules of a comparison mean for a frame: its limits, and the pixels that it ignores. */

/* Reads the rules that the options name, or RULES_NAME in the expected folder if it is there. For folders, each rule
   must match a frame: ERROR_INPUT otherwise. */
bool regression_read_rules(Regression *regression, Error *error);

/* The difference of a channel that its limits ignore. */
int regression_level(const Regression *regression, const RegressionFrame *frame);

/* *alone: the pictures can be compared row by row: no pixel is ignored, no limit needs FLIP, no change has a name.
   False with error set if out of memory. */
bool regression_needs_rows_alone(Regression *regression, const RegressionFrame *frame, bool *alone, Error *error);

/* *named: whether the changes of a frame can have names: both folders say what their pictures show. Thread-safe. */
bool regression_may_name(Regression *regression, const RegressionFrame *frame, bool *named, Error *error);

/* Sets `changes` to these regions, without names. */
bool regression_keep_regions(RegressionFrame *frame, const ImageRegions *regions, Error *error);

/* Whether the masks of a frame of this size could hide all its pixels, or not fit: false is certain, true is not. */
bool regression_may_hide_all(const Regression *regression, const RegressionFrame *frame, int width, int height);

/* Cuts both pictures of a frame to their overlap, and marks in *masked[height, width] what is ignored
   (regression/compare.h): masks, and edges if the tolerance says so. *masked is malloc'ed, or NULL if nothing can be
   ignored. */
bool regression_ignore(const Regression *regression, const RegressionFrame *frame, Image *expected, Image *actual,
                       uint8_t **masked, Error *error);

/* Whether the sizes of its pictures are equal, or differ as its limits allow. */
bool regression_accepts_size(const Regression *regression, const RegressionFrame *frame);

/* Compares the pictures of regression_ignore(): sets the frame's difference, which is not equal for other sizes. */
void regression_compare(const Regression *regression, RegressionFrame *frame, const Image *expected,
                        const Image *actual, const uint8_t *masked);

/* Sets the frame's verdict on pixels from its difference. Where there is a limit of FLIP, measures FLIP of the overlap,
   and for this copies what is ignored into the actual picture. */
bool regression_decide(const Regression *regression, RegressionFrame *frame, const Image *expected, Image *actual,
                       const uint8_t *masked, Error *error);

/* Regions, and if the frame fails, names of what changed in it: sets `changes` and `other_view` of a frame whose pixels
   differ. data: the two PNG files, whose texts are read. Thread-safe. False with error set if out of memory. */
bool regression_find_changes(Regression *regression, RegressionFrame *frame, uint8_t *const data[SIDES],
                             const Image *const images[SIDES], const uint8_t *masked, Error *error);

/* Groups failed frames by cause: fills `causes`. A frame may have several. False with error set if out of memory. */
bool regression_find_causes(Regression *regression, Error *error);

/* How many pixels of a picture of this size the mask hides at most, or all if it may not fit to it. An upper bound that
   costs no pass over pixels. */
double mask_most_hidden(const Mask *mask, int width, int height);

/* Finds pixels that differ only because an edge was rasterised otherwise: with other samples, or moved by a part of a
   pixel.

   Start: V. Vysniauskas, "Anti-aliased Pixel and Intensity Slope Detector", Elektronika ir Elektrotechnika 7(95), 2009,
   pp. 107-110, in the form of pixelmatch and odiff: a pixel is anti-aliased if it lies between its darkest and its
   brightest neighbour, and one of these has three equal neighbours in both pictures. This fails in two ways. The middle
   of a thin line or ring is darker than all its neighbours, so it counts as different as soon as the line moves. And
   nothing bounds the colour in the other picture: a wrong pixel at an edge passes.

   Here the change itself is bounded. In windows of 3 x 3 pixels, for each channel (premultiplied by alpha), with the
   contrast c of both windows together:

   1. The pixel changes by at most 0.6 c: its coverage by the shape changes by at most 0.6. Half a pixel is what
      separates a sampled from an exact edge; an edge that moves by a whole pixel is a difference. In one channel c is
      at least 16 of 255: gradients of areas are no edges.
   2. Either each value lies within the range of the other window: an edge between two colours that both pictures show.
      Or the sums of both windows differ by at most 3 * 0.15 c: a thin line has moved, and has kept its strength. Where
      it crosses another, the same holds of a window of 5 x 5 pixels around the pixel or one of its neighbours; and
      where it lies between two flat colours, the outline of a shape, after what it takes to move them by half a pixel
      at most.
   3. Within two pixels there is a flat colour (three neighbours are equal to it) that both pictures share: one side of
      the edge. In textures, such as photos, nothing is an edge.

   4. If the colours of each window are mixtures of two, so are those of both together: a line of another colour has not
      moved.

   Values within 2 + c / 16 of each other count as equal, in 4 within 2. Exchanging the pictures changes nothing.

   Fails: a line of less than two pixels that fades by less than 15% towards the colour around it looks like a line that
   became narrower, and passes; so does a faint mark along an edge of higher contrast. Where lines cross at less than 20
   degrees, some pixels may count. Rings less than two pixels apart have no flat side and count. */

/* Sets masked[height, width] (regression/compare.h) to IGNORED_EDGE where pixels differ in this way and are not ignored
   yet. Both pictures must have the same size. Compares 8 bits per channel. False with error set if out of memory. */
bool antialias_mark(const Image *expected, const Image *actual, uint8_t *masked, Error *error);

/* Finds content that moved by at most `reach` pixels, each way. The box around a differing pixel grows until it lies in
   a band, `reach` pixels wide, that has one colour in both pictures: an island on plain ground. It has moved if one
   offset makes all of the expected box the actual one, with the ground around both. So nothing of it may appear,
   vanish, change its colour or cross the edge of the picture, and content that lies on other content, or touches what
   stayed, counts as different. Pixels that differ by at most `tolerance` are equal; 16 bits count where pictures have
   them. The work is bounded: in pictures made of very many large islands, the last ones count as different.

   Sets masked[height, width] to IGNORED_RULE where pixels differ in this way and are not ignored yet. Both pictures
   must have the same size. */
void shift_mark(const Image *expected, const Image *actual, int reach, int tolerance, uint8_t *masked);

/* The same where pixels differ by at most `tolerance`. */
void level_mark(const Image *expected, const Image *actual, int tolerance, uint8_t *masked);

/* Both kinds of marks, as far as the limits allow them: antialias_mark(), shift_mark(). */
bool tolerance_mark(const Tolerance *tolerance, const Image *expected, const Image *actual, uint8_t *masked,
                    Error *error);

/* The expected picture, pale and grey, with differing pixels coloured: yellow for 1, over red, to violet for 255. What
   `masked` ignores (regression/compare.h) is hatched if it is masked, and blue if it differs as limits allow. Both
   pictures must have the same size. The difference picture has [height, width] and at least this size; what lies beyond
   both pictures is striped. A PNG file, malloc'ed; NULL with error set if out of memory. */
uint8_t *difference_picture(const Image *expected, const Image *actual, const uint8_t *masked, int width, int height,
                            size_t *size, Error *error);

/* A picture of values 0 to 1, black over violet and orange to pale yellow, whose rows come through the sink. NULL with
   error set if out of memory. */
IndexedPng *heat_picture(int width, int height, Error *error);
FlipSink heat_picture_sink(IndexedPng *picture);

/* A box as twinbox draws it. Pixels, y down. */

typedef struct BoxModel {
    double x, y;         /* centre */
    double cosine, sine; /* of the angle, counter-clockwise on the screen */
    double half_width, half_height;
} BoxModel;

/* Signed distance of a point from the edge, negative inside. */
double box_distance(const BoxModel *box, double x, double y);

/* The bounds of the box and a margin, as left, top, right, bottom. */
void box_bounds(const BoxModel *box, double margin, double bounds[4]);

/* Names what differs between two of twinbox's own pictures: bodies, captions, axes. */

enum { NAMING_PIXELS_MAX = 20000000 }; /* larger pictures get no names of bodies */

/* What both pictures show. */
typedef struct NamingScene {
    const FrameView *view;                      /* of both pictures */
    const Trajectory *runs[VIEW_PANELS_MAX][2]; /* per panel: expected, actual; NULL: unknown; may be the same */
    const Trajectory
        *outlines[VIEW_PANELS_MAX][VIEW_PANELS_MAX]; /* per panel: expected runs drawn as outlines, or NULL */
    int frame;                                       /* of the runs */
} NamingScene;

/* Fills the changes, and the names of the regions, which must be set. masked as in image_compare_masked(). Both
   pictures have the view's size. False with error set if out of memory. */
bool naming_find(const NamingScene *scene, const Image *expected, const Image *actual, const uint8_t *masked,
                 FrameChanges *changes, Error *error);

/* The part of naming that knows bodies. */

/* Owners of differing pixels: CHANGE i is OWNER_FIRST + i. */
enum { OWNER_NONE, OWNER_UNKNOWN, OWNER_FIRST };

typedef struct Naming {
    const NamingScene *scene;
    const Image *pictures[2];
    uint8_t *owners; /* [height, width] */
    int32_t *tops;   /* [height, width] what is drawn on top in the expected picture: a body in the order of
                        drawing, or (their number) an outline; -1: nothing */
    FrameChanges *changes;
} Naming;

/* One panel for naming: its bodies as drawn. */

/* A body as drawn in a panel. */
typedef struct Drawn {
    int index;
    bool exists[2];
    BoxModel box[2]; /* expected, actual */
    double moved;    /* pixels, of the corner that the states move farthest; infinite if it exists on one side only */
    int64_t pixels;  /* unknown ones on it */
} Drawn;

typedef struct Panel {
    Naming *naming;
    int number; /* from 0 */
    const ViewPanel *view;
    const Trajectory *runs[2];
    int count;
    Drawn *bodies; /* [count], in the order of drawing */
} Panel;

/* The order of drawing. */
typedef enum BodyLayer { LAYER_STATIC, LAYER_DYNAMIC, LAYER_BOMB, LAYERS } BodyLayer;
BodyLayer panel_layer(const Trajectory *run, int body);

/* Fills the bodies, and `tops` in the panel. *usable: false if bodies so large and many are no picture of a scene. The
   runs must be known. panel_close() frees the panel, also after an error. */
bool panel_open(Panel *panel, Naming *naming, int number, bool *usable, Error *error);
void panel_close(Panel *panel);

size_t panel_pixel(const Panel *panel, int x, int y);

/* The fixed parts of report.html (src/regression/page), embedded in the binary by base/tools/embed.cmake. */

extern const char report_page_css[], report_page_html[], report_help_html[];
extern const char report_script[];
extern const unsigned char report_script_sha256[];

/* The parts of a comparison's report. */

enum { REPORT_KINDS = 4 }; /* expected, actual, difference, FLIP */
extern const char report_kind_letters[REPORT_KINDS + 1];

typedef struct ReportPicture {
    uint8_t *data; /* a PNG file, or NULL */
    size_t size;
} ReportPicture;

typedef struct ReportPictures {
    int count;                             /* frames of the comparison */
    ReportPicture (*frames)[REPORT_KINDS]; /* [count], by frame */
    int left_out;                          /* frames whose pictures did not fit */
} ReportPictures;

/* The pages of runs that differ. */
typedef struct ReportRuns {
    ReportLink *links; /* [runs of the comparison]; empty: no page */
    int left_out;      /* runs whose page did not fit */
} ReportRuns;

typedef struct Report {
    const Regression *regression;
    const ReportPictures *pictures;
    const ReportRuns *runs;
    const char *folder; /* of the report, as given */
} Report;

/* The parts of ReportResults; `report` is a Report. */
ReportCase report_case(const void *report, int i);
void report_write_page(FILE *file, const void *report);
void report_write_json(FILE *file, const void *report);

/* Folders and the files below them, held by descriptors of their directories, so that no link leads out of a folder,
   even if one is made meanwhile. */

typedef struct Root {
    int folder;       /* an open directory */
    const char *path; /* of the caller, for messages */
} Root;

typedef struct ApprovePlace {
    int folder;          /* an open directory; -1 if there is no such folder */
    const char *name;    /* in it; points into the relative name */
    char path[PATH_MAX]; /* for messages */
} ApprovePlace;

/* What follows the current directory in the path, or the path itself if it is relative; NULL if it leads elsewhere.
   Links are not looked at. */
const char *path_below_current(const char *path);

/* Reads the failures from results.json. */

typedef struct ApprovalFile {
    char *name; /* relative to the folder; NULL: there was no file */
    uint64_t hash;
} ApprovalFile;

typedef struct ApprovalItem {
    bool failed, shown;
    ApprovalFile expected, actual;
} ApprovalItem;

typedef struct ApprovalList {
    char expected[PATH_MAX], actual[PATH_MAX]; /* folders */
    ApprovalItem *items;                       /* failures only */
    size_t count, capacity;
} ApprovalList;

/* ERROR_INPUT, with path:line:column, for anything that compare does not write, above all names that leave the folder,
   hidden names, names that do not end with .png or .npz, and, with the path alone, a file that is named twice. On
   failure nothing needs to be freed. Memory: at most four times the size of the file and 2 MiB. */
bool approval_read(ApprovalList *list, const char *path, Error *error);
void approval_free(ApprovalList *list);
