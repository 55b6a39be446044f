/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a watch keeps of a body, and the checks of soundness. */
#pragma once
#include "engine/engine.h"
#include "runs/verdict.h"

#include <math.h>

typedef struct Pose {
    double x, y, angle; /* m, rad */
} Pose;

enum { HANG_CHECKS = 4 };

struct WatchedBody {
    double side; /* m: the smaller one */
    int held;    /* the last step in which contacts, one by one, handed it down from a static body */
    bool is_static, is_bomb;
    bool starts;               /* with a speed */
    bool counted;              /* its energy is part of the run's */
    double size, corner, mass; /* m: root of the area, half the diagonal; kg */
    double energy;             /* J: in the last frame */
    Vec2 box;                  /* m: width and height */
    Pose last, before, prior;  /* in the last frame, the one before it, and that before it */
    Pose place;                /* since frame `since`; the two stays before took so many frames */
    int since, stays[2];
    Pose reference, rested;      /* what a fall is judged by; after VERDICT_DRIFT_UNITS */
    int carrier;                 /* -1: none, it drops */
    double carrier_up;           /* m: height of the carrier at the reference */
    double gap, gaps;            /* m: below the body; and below all that carries it, too */
    int fell;                    /* since this frame; 0: not */
    bool left, gone;             /* it is beside or below all static bodies; it is below them */
    int root;                    /* scratch: of its chain of contacts */
    double heights[HANG_CHECKS]; /* m: at the last checks */
};

/* Two bodies that are too deep in each other: since when, with the poses before, and their least and most angles. */
struct DeepPair {
    int a, b, since, seen;
    Pose entry_a, entry_b;
    double turn_a[2], turn_b[2];
    double deepest; /* m */
};

static const double touch_share = 0.03; /* of the smaller side: bodies with a smaller gap touch */
static const double pass_share = 0.5;   /* of the smaller side: how deep bodies are that pass through each other */
static const double hang_units = 0.5;

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

/* Stores the verdict if it is worse than the worst so far. */
void verdict_note(VerdictWatch *watch, Verdict verdict, int body, double value, const char *unit);

/* A body is added; its energy begins to count, for the bomb when it strikes. */
void energy_add_body(VerdictWatch *watch, const Body *from, WatchedBody *body);
void energy_count(VerdictWatch *watch, WatchedBody *body);

/* The checks of a step, whose poses the watch has. check_finite() is false for NaN and infinities, the others if memory
   is short. check_hanging() comes HANG_CHECKS times in hang_units. */
bool check_finite(VerdictWatch *watch, const VerdictStep *step);
void check_energy(VerdictWatch *watch, const VerdictStep *step);
bool check_depth(VerdictWatch *watch, const VerdictStep *step, Error *error);
bool check_passes(VerdictWatch *watch, Error *error);
bool check_hanging(VerdictWatch *watch, const Body *bodies, Error *error);
