/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Explains what differs at one drawn box: it moved, or its colours or its lines changed. */
#include "pixels/png.h"
#include "regression/internal.h"
#include "regression/naming.h"

#include <math.h>
#include <string.h>

/* Position from the centre along the local axes; `up` along the local top. */
static void to_local(const BoxModel *box, double x, double y, double *along, double *up) {
    *along = box->cosine * (x - box->x) - box->sine * (y - box->y);
    *up = -box->sine * (x - box->x) - box->cosine * (y - box->y);
}

/* Whether a pixel may show the target: a ring with a bar towards the local top. */
static bool box_hides(const BoxModel *box, double x, double y) {
    static const double RING = 0.32, BAR = 0.06; /* / side; a little more than pictures/parts.c draws */
    double along, up, side = 2 * fmin(box->half_width, box->half_height);
    if (!box->target) return false;
    to_local(box, x, y, &along, &up);
    double ring = RING * side + 1, bar = BAR * side + 1;
    return along * along + up * up < ring * ring || (fabs(along) < bar && up > 0);
}

static double edge_distance(const BoxModel *box, double along, double up) {
    double x = fabs(along) - box->half_width + box->radius, y = fabs(up) - box->half_height + box->radius;
    return (x > 0 && y > 0 ? sqrt(x * x + y * y) : fmax(x, y)) - box->radius;
}

double box_distance(const BoxModel *box, double x, double y) {
    double along, up;
    to_local(box, x, y, &along, &up);
    return edge_distance(box, along, up);
}

static double coverage(double distance) { return fmin(fmax(0.5 - distance, 0), 1); }

/* Shares of the parts in the pixel with this centre; they add up to 1. */
static void box_shares(const BoxModel *box, double x, double y, double shares[BOX_PARTS]) {
    double along, up;
    to_local(box, x, y, &along, &up);
    double distance = edge_distance(box, along, up), covered = coverage(distance);
    double inner = covered * coverage(distance + box->line);
    double band = box->band > 0 ? coverage(box->half_height - box->band - up) : 0;
    shares[BOX_OUTSIDE] = 1 - covered;
    shares[BOX_LINE] = covered - inner;
    shares[BOX_FILL] = inner * (1 - band);
    shares[BOX_BAND] = inner * band;
}

void box_bounds(const BoxModel *box, double margin, double bounds[4]) {
    double cosine = fabs(box->cosine), sine = fabs(box->sine);
    double x = cosine * box->half_width + sine * box->half_height + margin;
    double y = sine * box->half_width + cosine * box->half_height + margin;
    bounds[0] = box->x - x, bounds[1] = box->y - y, bounds[2] = box->x + x, bounds[3] = box->y + y;
}

typedef double Colours[BOX_PARTS][3]; /* BOX_OUTSIDE is unused: each pixel has its own */

static const double ACCEPTED = 0.35;     /* of the squared difference, at least, an explanation must remove */
static const double FINEST = 1.0 / 256;  /* pixels; the last step of a search */
static const double BAND_SHARE = 0.13;   /* first guess of a band's thickness / shorter side */
static const double SEEN_TURN = 0.3;     /* pixels at the corners; a smaller turn is not certain */
static const double CLEAR = 0.05;        /* what a clear explanation may leave of the squared difference */
static const double ROUNDING = 1;        /* squared difference of a pixel that rounding of colours explains */
static const double COLOUR_BETTER = 0.1; /* what colours may leave of a clear explanation's rest */
static const double STEP_GAIN = 0.995;   /* what a step of a search may leave: smaller gains are noise */
static const double MUCH_BETTER = 0.9;   /* what a longer movement may leave of a shorter one's rest */
static const double NOISE = 0.1;         /* squared difference of a pixel below which two looks are equal */
static const double CORNER_SHARE = 0.11,
                    USUAL_CORNER = 3; /* the same for the radius of a corner; its limit in pixels */
enum { SEARCH_ROUNDS = 60, SEARCHES = 3, STARTS_MAX = MOVEMENT_STARTS_MAX + 12 };

/* Solves the symmetric 3 x 3 system for three right-hand sides, by elimination. The diagonal is positive. */
static void solve(double m[3][3], double rhs[3][3]) {
    for (int i = 0; i < 3; i++)
        for (int row = i + 1; row < 3; row++) {
            double factor = m[row][i] / m[i][i];
            for (int k = i; k < 3; k++) m[row][k] -= factor * m[i][k];
            for (int c = 0; c < 3; c++) rhs[row][c] -= factor * rhs[i][c];
        }
    for (int i = 2; i >= 0; i--)
        for (int c = 0; c < 3; c++) {
            for (int k = i + 1; k < 3; k++) rhs[i][c] -= m[i][k] * rhs[k][c];
            rhs[i][c] /= m[i][i];
        }
}

/* Least squares: the colours of line, fill and band that explain `values` best. A part without pixels gets 0. */
static void fit_colours(const BoxModel *box, const FitPixels *pixels, bool differences, Colours colours) {
    static const double RIDGE = 1e-6;
    double m[3][3] = {{RIDGE, 0, 0}, {0, RIDGE, 0}, {0, 0, RIDGE}}, rhs[3][3] = {{0}};
    for (int i = 0; i < pixels->count; i++) {
        const FitPixel *p = &pixels->list[i];
        double shares[BOX_PARTS];
        if (box_hides(box, p->x, p->y)) continue;
        box_shares(box, p->x, p->y, shares);
        if (shares[BOX_OUTSIDE] >= 1) continue;
        for (int row = 0; row < 3; row++) {
            for (int k = 0; k < 3; k++) m[row][k] += shares[row + 1] * shares[k + 1];
            for (int c = 0; c < 3; c++)
                rhs[row][c] += shares[row + 1] *
                               (differences ? p->difference[c] : p->before[c] - shares[BOX_OUTSIDE] * p->behind[c]);
        }
    }
    solve(m, rhs);
    memcpy(colours[BOX_LINE], rhs, sizeof rhs);
}

/* The square of what colours in these shares leave of a value. */
static double rest(const double value[3], const double shares[BOX_PARTS], const Colours colours) {
    double sum = 0;
    for (int c = 0; c < 3; c++) {
        double left = value[c];
        for (int part = BOX_LINE; part < BOX_PARTS; part++) left -= shares[part] * colours[part][c];
        sum += left * left;
    }
    return sum;
}

/* What an explanation leaves of the differences: the box `from` with its colours becomes `to`. */
static double left_over(const BoxModel *from, const BoxModel *to, const Colours colours, const FitPixels *pixels) {
    double sum = 0;
    for (int i = 0; i < pixels->count; i++) {
        const FitPixel *p = &pixels->list[i];
        double before[BOX_PARTS], shares[BOX_PARTS], value[3];
        if (box_hides(from, p->x, p->y) || box_hides(to, p->x, p->y)) continue;
        box_shares(from, p->x, p->y, before);
        box_shares(to, p->x, p->y, shares);
        for (int part = 0; part < BOX_PARTS; part++) shares[part] -= before[part];
        for (int c = 0; c < 3; c++) value[c] = p->difference[c] - shares[BOX_OUTSIDE] * p->behind[c];
        sum += rest(value, shares, colours);
    }
    return sum;
}

/* What the box with its best colours leaves of the first picture inside its edge, or of the difference. */
static double colours_left_over(const BoxModel *box, const FitPixels *pixels, bool differences, Colours colours) {
    double sum = 0;
    fit_colours(box, pixels, differences, colours);
    for (int i = 0; i < pixels->count; i++) {
        const FitPixel *p = &pixels->list[i];
        double shares[BOX_PARTS], value[3];
        if (box_hides(box, p->x, p->y)) continue;
        box_shares(box, p->x, p->y, shares);
        if (!differences && shares[BOX_OUTSIDE] >= 1) continue;
        for (int c = 0; c < 3; c++)
            value[c] = differences ? p->difference[c] : p->before[c] - shares[BOX_OUTSIDE] * p->behind[c];
        sum += rest(value, shares, (const double(*)[3])colours);
    }
    return sum;
}

/* A search along one parameter after the other, with steps that halve when none helps. */
typedef struct Search {
    const BoxModel *from;
    const FitPixels *pixels;
    Colours colours;
    bool look; /* judged by the first picture, otherwise by left_over() */
    int count;
    double scale[3]; /* of a step in each parameter */
    double gain;     /* a step must remove more than this squared difference: of equal explanations, the first counts */
    void (*apply)(BoxModel *box, const double *parameters);
} Search;

static double search_error(Search *search, const double *parameters, BoxModel *box) {
    *box = *search->from;
    search->apply(box, parameters);
    return search->look ? colours_left_over(box, search->pixels, false, search->colours)
                        : left_over(search->from, box, search->colours, search->pixels);
}

static double search_best(Search *search, double *parameters, double step, BoxModel *box) {
    double best = search_error(search, parameters, box);
    for (int round = 0; round < SEARCH_ROUNDS && step >= FINEST && best > 0; round++) {
        bool better = false;
        for (int i = 0; i < 2 * search->count; i++) {
            double old = parameters[i / 2];
            parameters[i / 2] += (i % 2 == 0 ? step : -step) * search->scale[i / 2];
            double error = search_error(search, parameters, box);
            if (error < STEP_GAIN * best - search->gain)
                best = error, better = true;
            else
                parameters[i / 2] = old;
        }
        if (!better) step /= 2;
    }
    search_error(search, parameters, box);
    return best;
}

static void apply_look(BoxModel *box, const double *parameters) {
    box->line = fmax(box->line + parameters[0], 0);
    box->band = box->band > 0 ? fmax(box->band + parameters[1], box->line) : 0;
    box->radius = fmin(fmax(box->radius + parameters[2], 0), fmin(box->half_width, box->half_height));
}

/* Along the local axes: a thin box is easy to place across, and hard along. */
static void apply_movement(BoxModel *box, const double *parameters) {
    double cosine = cos(parameters[2]), sine = sin(parameters[2]), old = box->cosine;
    box->x += parameters[0] * box->cosine - parameters[1] * box->sine;
    box->y -= parameters[0] * box->sine + parameters[1] * box->cosine;
    box->cosine = old * cosine - box->sine * sine;
    box->sine = box->sine * cosine + old * sine;
}

/* Fits line width, band and colours to the first picture. */
static BoxModel fit_look(const BoxModel *box, const FitPixels *pixels, Colours colours) {
    static const double lines[] = {1, 1.5, 2.2, 3, 4.5, 7, 0};
    double side = 2 * fmin(box->half_width, box->half_height), least = INFINITY;
    BoxModel best = *box;
    for (int i = 0; i < 14; i++) {
        BoxModel tried = *box;
        tried.line = lines[i / 2];
        tried.band = i % 2 == 0 ? 0 : tried.line + BAND_SHARE * side;
        tried.radius = fmin(CORNER_SHARE * side, USUAL_CORNER);
        double error = colours_left_over(&tried, pixels, false, colours);
        if (error < least - NOISE * pixels->count) least = error, best = tried;
    }
    Search search = {
        .from = &best, .pixels = pixels, .look = true, .count = 3, .scale = {1, 1, 1}, .apply = apply_look};
    search.gain = NOISE * pixels->count;
    BoxModel fitted;
    search_best(&search, (double[3]){0, 0, 0}, 0.5, &fitted);
    memcpy(colours, search.colours, sizeof search.colours);
    colours_left_over(&fitted, pixels, false, colours);
    return fitted;
}

/* Returns what the best movement leaves; `search` has the box and its colours. Searches from the best starts. */
static double fit_movement(Search *search, const double (*starts)[3], int start_count, double parameters[3]) {
    BoxModel box;
    bool used[STARTS_MAX] = {false};
    parameters[0] = parameters[1] = parameters[2] = 0;
    double least = search_best(search, parameters, 1, &box);
    for (int tries = 0; tries < SEARCHES && least > 0; tries++) {
        double nearest = INFINITY, tried[3] = {0, 0, 0};
        int best = -1;
        for (int i = 0; i < start_count; i++) {
            double error = used[i] ? INFINITY : search_error(search, starts[i], &box);
            if (error < nearest) nearest = error, best = i;
        }
        if (best < 0) break;
        used[best] = true;
        memcpy(tried, starts[best], sizeof tried);
        double error = search_best(search, tried, 2, &box);
        if (error < MUCH_BETTER * least) least = error, memcpy(parameters, tried, sizeof tried);
    }
    return least;
}

/* The given starts along the local axes, and some steps along each. Returns their number. */
static int all_starts(const BoxModel *box, const double (*given)[2], int count, double starts[STARTS_MAX][3]) {
    static const double steps[] = {2.5, 6, 15};
    for (int i = 0; i < count; i++) {
        starts[i][0] = given[i][0] * box->cosine - given[i][1] * box->sine;
        starts[i][1] = -given[i][0] * box->sine - given[i][1] * box->cosine;
        starts[i][2] = 0;
    }
    for (int i = 0; i < STARTS_MAX - MOVEMENT_STARTS_MAX; i++) {
        double step = i % 2 == 0 ? steps[i / 4] : -steps[i / 4];
        bool along = i / 2 % 2 == 0;
        starts[count][0] = along ? step : 0, starts[count][1] = along ? 0 : step, starts[count++][2] = 0;
    }
    return count;
}

static double total_of(const BoxModel *box, const FitPixels *pixels) {
    double sum = 0;
    for (int i = 0; i < pixels->count; i++)
        for (int c = 0; c < 3 && !box_hides(box, pixels->list[i].x, pixels->list[i].y); c++)
            sum += pixels->list[i].difference[c] * pixels->list[i].difference[c];
    return sum;
}

static int count_differing(const FitPixels *pixels) {
    int count = 0;
    for (int i = 0; i < pixels->count; i++) {
        const double *d = pixels->list[i].difference;
        count += d[0] != 0 || d[1] != 0 || d[2] != 0;
    }
    return count;
}

/* Movement and line width have fewer parameters than colours: where one of them is clear, colours must explain far more.
   A line of one pixel that lies on the pixels becomes thinner exactly as it becomes paler: then it is the width. */
static int choose(const double left[3], double total, int differing) {
    int best = left[1] < left[0] ? 1 : 0;
    bool clear = left[best] < CLEAR * total, exact = clear && left[best] <= ROUNDING * differing;
    if (left[2] < (clear ? COLOUR_BETTER : 1) * left[best] && !exact) best = 2;
    return left[best] < (1 - ACCEPTED) * total ? best : 3;
}

/* `starts`: movements (pixels right, down) from which the search begins besides (0, 0); at most
   MOVEMENT_STARTS_MAX. */
static BodyFit body_fit(const BoxModel *box, const FitPixels *pixels, const double (*starts)[2], int start_count) {
    static const ChangeKind kinds[4] = {CHANGE_MOVED, CHANGE_LINE_WIDTH, CHANGE_COLOUR, CHANGE_OTHER};
    BodyFit fit = {.kind = CHANGE_OTHER, .total = total_of(box, pixels)};
    if (pixels->count == 0 || fit.total <= 0) return fit;
    double movement[3], line[3] = {0, 0, 0}, all[STARTS_MAX][3];
    Search search = {.pixels = pixels};
    Colours changed;
    BoxModel from = fit_look(box, pixels, search.colours), to;
    int count = all_starts(box, starts, start_count, all);
    search.from = &from;
    search.count = 3, search.apply = apply_movement;
    search.scale[0] = search.scale[1] = 1;
    search.scale[2] = 1 / fmax(sqrt(box->half_width * box->half_width + box->half_height * box->half_height), 1);
    double left[3] = {fit_movement(&search, all, count, movement)};
    const double turn_scale = search.scale[2];
    search.count = 2, search.apply = apply_look;
    left[1] = search_best(&search, line, 0.5, &to);
    left[2] = colours_left_over(&from, pixels, true, changed);
    int best = choose(left, fit.total, count_differing(pixels));
    fit.kind = kinds[best];
    if (best < 3) fit.explained = fit.total - left[best];
    if (fit.kind != CHANGE_MOVED) return fit;
    to = from;
    apply_movement(&to, movement);
    fit.right = to.x - from.x, fit.up = from.y - to.y;
    if (fabs(movement[2]) > SEEN_TURN * turn_scale) fit.turn = movement[2];
    return fit;
}

/* How far a side moved that now is where the changes end; 0 for a side that the panel does not show. */
static double start_of(double side, double changed, int low, int high) {
    return side > low && side < high ? changed - side : 0;
}

/* A body that moved far changes the picture at its old and its new place: the bounds of all changes show how far. */
BodyFit panel_fit(Panel *panel, int self, ViewRect changed) {
    const BoxModel *box = &panel->bodies[self].box[0];
    const ViewRect *rect = &panel->view->rect;
    double bounds[4], starts[MOVEMENT_STARTS_MAX][2];
    int count = 0;
    box_bounds(box, 0, bounds);
    const double x[3] = {0, start_of(bounds[0], changed.left, rect->left, rect->right),
                         start_of(bounds[2], changed.right, rect->left, rect->right)};
    const double y[3] = {0, start_of(bounds[1], changed.top, rect->top, rect->bottom),
                         start_of(bounds[3], changed.bottom, rect->top, rect->bottom)};
    for (int i = 1; i < 9; i++)
        if (x[i % 3] != 0 || y[i / 3] != 0) starts[count][0] = x[i % 3], starts[count++][1] = y[i / 3];
    panel_collect(panel, self, changed);
    return body_fit(box, panel->pixels, (const double(*)[2])starts, count);
}
