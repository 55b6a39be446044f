/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/body_fit.h"

#include <math.h>
#include <string.h>

typedef double Colours[BOX_PARTS][3]; /* BOX_OUTSIDE is unused: each pixel has its own */

static const double ACCEPTED = 0.5;   /* of the squared difference, at least, an explanation must remove */
static const double FINEST = 1.0 / 256; /* pixels; the last step of a search */
static const double BAND_SHARE = 0.13; /* first guess of a band's thickness / shorter side */
enum { SEARCH_ROUNDS = 60 };

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

/* What an explanation leaves of the differences: the box `from` with its colours becomes `to`. */
static double left_over(const BoxModel *from, const BoxModel *to, const Colours colours, const FitPixels *pixels) {
    double sum = 0;
    for (int i = 0; i < pixels->count; i++) {
        const FitPixel *p = &pixels->list[i];
        double a[BOX_PARTS], b[BOX_PARTS];
        box_shares(from, p->x, p->y, a);
        box_shares(to, p->x, p->y, b);
        for (int c = 0; c < 3; c++) {
            double left = p->difference[c] - (b[BOX_OUTSIDE] - a[BOX_OUTSIDE]) * p->behind[c];
            for (int part = BOX_LINE; part < BOX_PARTS; part++) left -= (b[part] - a[part]) * colours[part][c];
            sum += left * left;
        }
    }
    return sum;
}

/* What the box with its best colours leaves of the first picture, inside its edge. */
static double look_error(const BoxModel *box, const FitPixels *pixels, Colours colours) {
    double sum = 0;
    fit_colours(box, pixels, false, colours);
    for (int i = 0; i < pixels->count; i++) {
        const FitPixel *p = &pixels->list[i];
        double shares[BOX_PARTS];
        box_shares(box, p->x, p->y, shares);
        if (shares[BOX_OUTSIDE] >= 1) continue;
        for (int c = 0; c < 3; c++) {
            double left = p->before[c] - shares[BOX_OUTSIDE] * p->behind[c];
            for (int part = BOX_LINE; part < BOX_PARTS; part++) left -= shares[part] * colours[part][c];
            sum += left * left;
        }
    }
    return sum;
}

static double colour_left_over(const BoxModel *box, const FitPixels *pixels) {
    Colours change;
    double sum = 0;
    fit_colours(box, pixels, true, change);
    for (int i = 0; i < pixels->count; i++) {
        const FitPixel *p = &pixels->list[i];
        double shares[BOX_PARTS];
        box_shares(box, p->x, p->y, shares);
        for (int c = 0; c < 3; c++) {
            double left = p->difference[c];
            for (int part = BOX_LINE; part < BOX_PARTS; part++) left -= shares[part] * change[part][c];
            sum += left * left;
        }
    }
    return sum;
}

/* A search along one parameter after the other, with steps that halve when none helps. */
typedef struct Search {
    const BoxModel *from;
    const FitPixels *pixels;
    Colours colours;
    bool look; /* judged by look_error() of the first picture, otherwise by left_over() */
    int count;
    double scale[3]; /* of a step in each parameter */
    void (*apply)(BoxModel *box, const double *parameters);
} Search;

static double search_error(Search *search, const double *parameters, BoxModel *box) {
    *box = *search->from;
    search->apply(box, parameters);
    return search->look ? look_error(box, search->pixels, search->colours)
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
            if (error < best)
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
}

static void apply_movement(BoxModel *box, const double *parameters) {
    double cosine = cos(parameters[2]), sine = sin(parameters[2]), old = box->cosine;
    box->x += parameters[0];
    box->y += parameters[1];
    box->cosine = old * cosine - box->sine * sine;
    box->sine = box->sine * cosine + old * sine;
}

/* Fits line width, band and colours to the first picture. */
static BoxModel fit_look(const BoxModel *box, const FitPixels *pixels, Colours colours) {
    static const double lines[] = {0, 1, 1.5, 2.2, 3, 4.5, 7};
    double side = 2 * fmin(box->half_width, box->half_height), least = INFINITY;
    BoxModel best = *box;
    for (int i = 0; i < 14; i++) {
        BoxModel tried = *box;
        tried.line = lines[i / 2];
        tried.band = i % 2 == 0 ? 0 : tried.line + BAND_SHARE * side;
        double error = look_error(&tried, pixels, colours);
        if (error < least) least = error, best = tried;
    }
    Search search = {.from = &best, .pixels = pixels, .look = true, .count = 2, .scale = {1, 1}, .apply = apply_look};
    BoxModel fitted;
    search_best(&search, (double[2]){0, 0}, 0.5, &fitted);
    memcpy(colours, search.colours, sizeof search.colours);
    look_error(&fitted, pixels, colours);
    return fitted;
}

/* Returns what the best movement leaves; `search` has the box and its colours. */
static double fit_movement(Search *search, const double (*starts)[2], int start_count, double parameters[3]) {
    BoxModel box;
    parameters[0] = parameters[1] = parameters[2] = 0;
    double least = search_error(search, parameters, &box);
    for (int i = 0; i < start_count; i++) {
        double tried[3] = {starts[i][0], starts[i][1], 0}, error = search_error(search, tried, &box);
        if (error < least) least = error, memcpy(parameters, tried, sizeof tried);
    }
    return search_best(search, parameters, 1, &box);
}

static double total_of(const FitPixels *pixels) {
    double sum = 0;
    for (int i = 0; i < pixels->count; i++)
        for (int c = 0; c < 3; c++) sum += pixels->list[i].difference[c] * pixels->list[i].difference[c];
    return sum;
}

BodyFit body_fit(const BoxModel *box, const FitPixels *pixels, const double (*starts)[2], int start_count) {
    BodyFit fit = {.kind = CHANGE_OTHER, .total = total_of(pixels)};
    if (pixels->count == 0 || fit.total <= 0) return fit;
    double movement[3], line[2] = {0, 0};
    Search search = {.pixels = pixels};
    BoxModel from = fit_look(box, pixels, search.colours), to;
    search.from = &from;
    search.count = 3, search.apply = apply_movement;
    search.scale[0] = search.scale[1] = 1;
    search.scale[2] = 1 / fmax(sqrt(box->half_width * box->half_width + box->half_height * box->half_height), 1);
    double left[3] = {fit_movement(&search, starts, start_count, movement)};
    search.count = 2, search.apply = apply_look;
    left[1] = search_best(&search, line, 0.5, &to);
    left[2] = colour_left_over(&from, pixels);
    static const ChangeKind kinds[3] = {CHANGE_MOVED, CHANGE_LINE_WIDTH, CHANGE_COLOUR};
    int best = left[1] < left[0] ? 1 : 0;
    if (left[2] < left[best]) best = 2;
    fit.explained = fit.total - left[best];
    if (left[best] < (1 - ACCEPTED) * fit.total) fit.kind = kinds[best];
    if (fit.kind == CHANGE_MOVED) fit.right = movement[0], fit.up = -movement[1], fit.turn = movement[2];
    return fit;
}
