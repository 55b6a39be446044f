/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a watch keeps of a body, what touches, and the checks of soundness. */
#pragma once
#include "engine/engine.h"
#include "runs/verdict.h"

#include <math.h>

typedef struct Pose {
    double x, y, angle; /* m, rad */
} Pose;

struct WatchedBody {
    double size, side, corner, mass; /* m: root of the area, the smaller side, half the diagonal; kg */
    Vec2 box;                        /* m: width and height */
    bool is_static, is_bomb;
    bool starts;       /* with a speed */
    double energy;     /* J: in the last frame */
    int held;          /* the last step in which contacts, one by one, handed it down from a static body */
    Pose last, before; /* in the last frame, and in the one before it */
    Pose place;        /* since frame `since`; the two stays before took so many frames */
    int since, stays[2];
    Pose reference, rested; /* what a fall is judged by; after VERDICT_DRIFT_UNITS */
    int carrier;            /* -1: none */
    double carrier_up;      /* m: height of the carrier at the reference */
    double gap, gaps;       /* m: below the body; and below all that carries it, too */
    int fell;               /* since this frame; 0: not */
    bool left;              /* it is beside or below all static bodies */
    double level;           /* m: its height since this frame, nearly */
    int level_since, link;  /* link: scratch, to a body that it may hang on */
};

/* Two bodies that are too deep in each other: since when, and the poses before and after. */
struct DeepPair {
    int a, b, since, seen;
    double deepest; /* m */
    Pose of_a[2], of_b[2];
};

/* Of the smaller side: how deep bodies are in each other that sink, and that pass through each other. An impact's
   penetration is less, or is corrected sooner. */
static const double deep_share = 0.25, pass_share = 0.5;

/* Not fmax(), which is a call. */
static inline double larger(double a, double b) { return a < b ? b : a; }

static inline double height_of(const VerdictWatch *watch, const Pose *pose) {
    return pose->x * watch->up_x + pose->y * watch->up_y;
}

static inline double across_of(const VerdictWatch *watch, const Pose *pose) {
    return pose->x * watch->up_y - pose->y * watch->up_x;
}

static inline double turn_between(double a, double b) {
    const double turn = a - b;
    return fabs(turn) <= M_PI ? turn : remainder(turn, 2 * M_PI);
}

static inline double way_between(const Pose *a, const Pose *b) {
    return sqrt((a->x - b->x) * (a->x - b->x) + (a->y - b->y) * (a->y - b->y));
}

static inline Box box_of(const WatchedBody *body, const Pose *pose) {
    return box_make(vec2((float)pose->x, (float)pose->y), body->box, (float)pose->angle);
}

/* Steps in so many units; at least one. */
static inline int steps_of(const VerdictWatch *watch, double units) {
    const double steps = fmin(units * watch->unit / (double)watch->run.dt, 1e9);
    return steps > 1 ? (int)lround(steps) : 1;
}

/* Whether energy tells anything: not without masses if light bodies get much of it from heavy ones. */
static inline bool energy_is_judged(const VerdictWatch *watch) { return !watch->run.masses_unknown || !watch->struck; }

/* A body's energy is part of the run's; the bomb's, when it has struck. */
static inline bool energy_counts(const VerdictWatch *watch, const WatchedBody *body) {
    return !body->is_bomb || watch->met >= 0;
}

/* m: how deep two bodies are in each other; negative: apart, -INFINITY: by more than `within`, m. */
double depth_of(const WatchedBody *a, const WatchedBody *b, double within);

/* m: how far the corners of two bodies have moved past each other in the last step, at most. */
double way_past(const WatchedBody *a, const WatchedBody *b);

/* Whether two bodies touch after the last step. */
bool bodies_touch(const VerdictWatch *watch, const WatchedBody *a, const WatchedBody *b);

/* Finds the pairs of bodies, finder.pairs, that may touch in the last step, or if what starts at rest moves down by so
   many m, and all others by half a side where that is not 0. */
bool find_near(VerdictWatch *watch, double down, Error *error);

/* The checks of a step. check_finite() is false for NaN and infinities, the others if memory is short. Contacts are
   checked before bodies get their new poses. The bomb's energy counts when it strikes. */
bool check_finite(VerdictWatch *watch, const VerdictStep *step);
bool check_contacts(VerdictWatch *watch, const VerdictStep *step, Error *error);
bool check_passes(VerdictWatch *watch, Error *error);
void count_energy(VerdictWatch *watch, const WatchedBody *body);
void check_energy(VerdictWatch *watch, const VerdictStep *step);
bool check_hanging(VerdictWatch *watch, Error *error);

/* Stores the verdict if it is worse than the worst so far. */
void verdict_note(VerdictWatch *watch, Verdict verdict, int body, double value, const char *unit);
