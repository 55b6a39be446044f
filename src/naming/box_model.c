/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "naming/box_model.h"

#include <math.h>

/* Position from the centre along the local axes; `up` along the local top. */
static void to_local(const BoxModel *box, double x, double y, double *along, double *up) {
    *along = box->cosine * (x - box->x) - box->sine * (y - box->y);
    *up = -box->sine * (x - box->x) - box->cosine * (y - box->y);
}

bool box_hides(const BoxModel *box, double x, double y) {
    static const double RING = 0.32, BAR = 0.06; /* / side; a little more than picture/body.c draws */
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

void box_shares(const BoxModel *box, double x, double y, double shares[BOX_PARTS]) {
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
