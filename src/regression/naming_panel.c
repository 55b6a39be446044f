/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/base.h"
#include "regression/compare.h"
#include "regression/internal.h"
#include "regression/naming.h"
#include "runs/trajectory.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double SMALL = 0.005;     /* pixels; smaller movements round to 0.00 */
static const double ALONG = 0.25;      /* a movement's smaller part is left out below this share of the larger */
static const double SEEN_TURN = 0.001; /* rad */
static const double DEGREES = 57.29577951308232;

static void add_subject(ChangeText *text, const Change *change) {
    static const char *const names[] = {
        [SUBJECT_HEADER] = "header",         [SUBJECT_CAPTION] = "caption",   [SUBJECT_AXIS] = "axis",
        [SUBJECT_LEGEND] = "legend",         [SUBJECT_TIMELINE] = "timeline", [SUBJECT_MARKS] = "marks",
        [SUBJECT_BACKGROUND] = "background", [SUBJECT_PAGE] = "page"};
    switch (change->subject) {
    case SUBJECT_BODY: text_add(text->text, sizeof text->text, "body %d", change->body); break;
    case SUBJECT_BOMB: text_add(text->text, sizeof text->text, "bomb (body %d)", change->body); break;
    case SUBJECT_FIXED: text_add(text->text, sizeof text->text, "static body %d", change->body); break;
    case SUBJECT_GROUND: text_add(text->text, sizeof text->text, "ground (body %d)", change->body); break;
    case SUBJECT_BODIES:
        text_add(text->text, sizeof text->text, "%d more %s", change->body, change->body == 1 ? "body" : "bodies");
        break;
    case SUBJECT_HEADER:
    case SUBJECT_CAPTION:
    case SUBJECT_AXIS:
    case SUBJECT_LEGEND:
    case SUBJECT_TIMELINE:
    case SUBJECT_MARKS:
    case SUBJECT_BACKGROUND:
    case SUBJECT_PAGE: text_add(text->text, sizeof text->text, "%s", names[change->subject]); break;
    }
    if (change->panel > 0) text_add(text->text, sizeof text->text, " of panel %d", change->panel);
}

static void add_pixels(ChangeText *text, double pixels, const char *positive, const char *negative) {
    double size = fabs(pixels);
    text_add(text->text, sizeof text->text, " %.*f px %s",
             size < 0.1    ? 2
             : size < 9.95 ? 1
                           : 0,
             size, pixels > 0 ? positive : negative);
}

/* " 0.4 px right", " 3 px right and 2 px up"; a movement along one axis has one part. */
static void add_amount(ChangeText *text, const Change *change) {
    double right = fabs(change->right), up = fabs(change->up);
    bool has_right = right >= SMALL && right >= ALONG * up, has_up = up >= SMALL && up >= ALONG * right;
    bool turns = fabs(change->turn) >= SEEN_TURN;
    if (has_right || has_up) text_add(text->text, sizeof text->text, " moved");
    if (has_right) add_pixels(text, change->right, "right", "left");
    if (has_right && has_up) text_add(text->text, sizeof text->text, " and");
    if (has_up) add_pixels(text, change->up, "up", "down");
    if (turns)
        text_add(text->text, sizeof text->text, "%s %.2g degrees", has_right || has_up ? ", turned" : " turned",
                 DEGREES * fabs(change->turn));
    if (!has_right && !has_up && !turns) text_add(text->text, sizeof text->text, " moved less than 0.01 px");
}

ChangeText change_words(const Change *change) {
    ChangeText text = {""};
    add_subject(&text, change);
    switch (change->kind) {
    case CHANGE_OTHER:
        if (change->subject <= SUBJECT_BODIES) text_add(text.text, sizeof text.text, " changed");
        break;
    case CHANGE_MOVED:
        if (change->subject == SUBJECT_BODIES)
            text_add(text.text, sizeof text.text, " moved");
        else
            add_amount(&text, change);
        break;
    case CHANGE_COLOUR: text_add(text.text, sizeof text.text, ": colour"); break;
    case CHANGE_LINE_WIDTH: text_add(text.text, sizeof text.text, ": line width"); break;
    case CHANGE_APPEARED: text_add(text.text, sizeof text.text, " only in the actual run"); break;
    case CHANGE_DISAPPEARED: text_add(text.text, sizeof text.text, " only in the expected run"); break;
    }
    return text;
}

ChangeText change_cause(const Change *change) {
    bool several = change->subject == SUBJECT_BODIES;
    if (change->kind != CHANGE_MOVED && !several) return change_words(change);
    ChangeText text = {""};
    if (several)
        text_add(text.text, sizeof text.text, "other bodies");
    else
        add_subject(&text, change);
    text_add(text.text, sizeof text.text, change->kind == CHANGE_MOVED ? " moved" : " changed");
    return text;
}

ChangeText region_name(const FrameChanges *changes, int region) {
    ChangeText text = {""};
    int change = changes->region_change[region], others = changes->region_others[region];
    if (change < 0) return text;
    text = change_words(&changes->list[change]);
    if (others > 0)
        text_add(text.text, sizeof text.text, ", and %d more %s", others, others == 1 ? "change" : "changes");
    return text;
}

ChangeText region_words(const FrameChanges *changes, int region) {
    ChangeText text = {""};
    const ImageRegion *r = &changes->regions.list[region];
    ChangeText name = region_name(changes, region);
    text_add(text.text, sizeof text.text, "%d x %d pixels at (%d, %d), %" PRId64 " of them %s", r->right - r->left,
             r->bottom - r->top, r->left, r->top, r->pixels, r->pixels == 1 ? "differs" : "differ");
    if (name.text[0] != '\0') text_add(text.text, sizeof text.text, ": %s", name.text);
    return text;
}

enum { PAINTED_MAX = 64 /* times the panel, by all bodies */ };

static bool place(const Panel *panel, const Trajectory *run, int body, BoxModel *box) {
    int frame = panel->naming->scene->frame < run->frames ? panel->naming->scene->frame : run->frames - 1;
    if (body >= run->bodies || !trajectory_has(run, frame, body)) return false;
    size_t i = (size_t)frame * (size_t)run->bodies + (size_t)body;
    const ViewPanel *view = panel->view;
    double angle = (double)run->angle[i], scale = view->scale;
    *box = (BoxModel){.x = view->rect.left + view->left + scale * (double)run->position[i].x,
                      .y = view->rect.top + view->top - scale * (double)run->position[i].y,
                      .cosine = cos(angle),
                      .sine = sin(angle),
                      .half_width = scale * (double)run->size[body].x / 2,
                      .half_height = scale * (double)run->size[body].y / 2,
                      .target = body == run->bomb};
    return true;
}

/* The largest movement of a corner. */
static double movement(const BoxModel *a, const BoxModel *b) {
    double reach = sqrt(a->half_width * a->half_width + a->half_height * a->half_height);
    double x = b->x - a->x, y = b->y - a->y, cosine = b->cosine - a->cosine, sine = b->sine - a->sine;
    return sqrt(x * x + y * y) + reach * sqrt(cosine * cosine + sine * sine);
}

BodyLayer panel_layer(const Trajectory *run, int body) {
    return body == run->bomb ? LAYER_BOMB : run->fixed[body] ? LAYER_STATIC : LAYER_DYNAMIC;
}

static void add_layer(Panel *panel, BodyLayer wanted) {
    const Trajectory *expected = panel->runs[0], *actual = panel->runs[1];
    for (int body = 0; body < expected->bodies; body++) {
        if (panel_layer(expected, body) != wanted) continue;
        Drawn drawn = {.index = body};
        drawn.exists[0] = place(panel, expected, body, &drawn.box[0]);
        drawn.exists[1] = place(panel, actual, body, &drawn.box[1]);
        if (drawn.exists[0] != drawn.exists[1]) drawn.moved = INFINITY;
        if (drawn.exists[0] && drawn.exists[1]) drawn.moved = movement(&drawn.box[0], &drawn.box[1]);
        if (drawn.exists[0] || drawn.exists[1]) panel->bodies[panel->count++] = drawn;
    }
}

ViewRect panel_bounds(const Panel *panel, const BoxModel *box, double margin) {
    double bounds[4];
    ViewRect rect = panel->view->rect;
    box_bounds(box, margin, bounds);
    if (bounds[0] > rect.left) rect.left = (int)fmin(floor(bounds[0]), rect.right);
    if (bounds[1] > rect.top) rect.top = (int)fmin(floor(bounds[1]), rect.bottom);
    if (bounds[2] < rect.right) rect.right = (int)fmax(ceil(bounds[2]), rect.left);
    if (bounds[3] < rect.bottom) rect.bottom = (int)fmax(ceil(bounds[3]), rect.top);
    return rect;
}

size_t panel_pixel(const Panel *panel, int x, int y) {
    return (size_t)y * (size_t)panel->naming->scene->view->width + (size_t)x;
}

/* The width of an outline, at most (pictures/parts.c). */
static double outline_reach(const Panel *panel) {
    const ViewRect *rect = &panel->view->rect;
    return 3 + 0.008 * fmin(rect->right - rect->left, rect->bottom - rect->top);
}

/* Outlines of other runs are above all bodies. */
static void paint_outlines(const Panel *panel, const Trajectory *run) {
    const double reach = outline_reach(panel);
    for (int body = 0; body < run->bodies; body++) {
        BoxModel box;
        if (run->fixed[body] || !place(panel, run, body, &box)) continue;
        ViewRect rect = panel_bounds(panel, &box, 1);
        for (int y = rect.top; y < rect.bottom; y++)
            for (int x = rect.left; x < rect.right; x++) {
                double distance = box_distance(&box, x + 0.5, y + 0.5);
                if (distance < 0.5 && distance > -reach) panel->naming->tops[panel_pixel(panel, x, y)] = panel->count;
            }
    }
}

/* Paints the expected bodies into `tops`, half a pixel larger: with their smoothed edges. False if bodies so large and
   many are no picture of a scene. */
static bool paint_tops(const Panel *panel) {
    const ViewRect whole = panel->view->rect;
    int64_t painted = 0, most = PAINTED_MAX * (int64_t)(whole.right - whole.left) * (whole.bottom - whole.top);
    for (int y = whole.top; y < whole.bottom; y++)
        for (int x = whole.left; x < whole.right; x++) panel->naming->tops[panel_pixel(panel, x, y)] = -1;
    for (int i = 0; i < panel->count && painted <= most; i++) {
        const BoxModel *box = &panel->bodies[i].box[0];
        if (!panel->bodies[i].exists[0]) continue;
        ViewRect rect = panel_bounds(panel, box, 1);
        painted += (int64_t)(rect.right - rect.left) * (rect.bottom - rect.top);
        for (int y = rect.top; y < rect.bottom; y++)
            for (int x = rect.left; x < rect.right; x++)
                if (box_distance(box, x + 0.5, y + 0.5) < 0.5) panel->naming->tops[panel_pixel(panel, x, y)] = i;
    }
    for (int i = 0; painted <= most && i < panel->view->outline_count; i++)
        if (panel->naming->scene->outlines[panel->number][i] != NULL)
            paint_outlines(panel, panel->naming->scene->outlines[panel->number][i]);
    return painted <= most;
}

bool panel_open(Panel *panel, Naming *naming, int number, bool *usable, Error *error) {
    *panel = (Panel){naming, number, &naming->scene->view->panels[number],
                     .runs = {naming->scene->runs[number][0], naming->scene->runs[number][1]}};
    panel->bodies = calloc((size_t)panel->runs[0]->bodies + 1, sizeof *panel->bodies);
    panel->pixels = malloc(sizeof *panel->pixels);
    if (panel->bodies == NULL || panel->pixels == NULL) return error_memory(error, "regions");
    for (BodyLayer layer = LAYER_STATIC; layer < LAYERS; layer++) add_layer(panel, layer);
    *usable = paint_tops(panel);
    return true;
}

void panel_close(Panel *panel) {
    free(panel->bodies);
    free(panel->pixels);
}
