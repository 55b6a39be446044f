/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a watch keeps of a body, what touches, and the checks of soundness. */
#pragma once
#include "engine/engine.h"
#include "runs/verdict.h"

#include <math.h>

typedef struct Pose {
    Vec2 at;     /* m */
    float angle; /* rad */
} Pose;

typedef struct Place {
    Pose pose;
    int frame; /* since which a body has it */
} Place;

struct WatchedBody {
    double size, side, corner; /* m: root of the area, the smaller side, half the diagonal */
    double mass, inertia;      /* kg, kg m^2 */
    Vec2 box;                  /* m: width and height */
    bool is_static, is_bomb;
    bool starts;       /* with a speed */
    double energy;     /* J: in the last frame */
    Pose last, before; /* in the last frame, and in the one before it */
    Place place;
    Place lately[2];    /* poses that are up to half a unit old, and up to a unit, but no older than the place */
    int stays[2];       /* frames: in the two places before; 0: none, or that of the start */
    Pose start, rested; /* when it came; after VERDICT_DRIFT_UNITS */
    int carrier;        /* -1: none */
    double gap, gaps;   /* m: below the body; and below all that carries it, too: INFINITY if that drops */
    int fell;           /* since this frame; 0: not */
    bool left;          /* it is below all static bodies */
    bool held;          /* scratch: something static carries it */
};

/* Two bodies that are too deep in each other: in the steps from `since` to `seen`, and their poses before. */
struct DeepPair {
    BodyPair pair;
    int since, seen;
    Pose of_a, of_b;
};

static const double long_units = 0.5; /* what lasts so long lasts: a hop of a size up and down takes as long */
static const double pass_share = 0.5; /* of the smaller side: how deep bodies are that pass through each other */

/* Not fmax(), which is a call. */
static inline double larger(double a, double b) { return a < b ? b : a; }

static inline Pose pose_of(const Body *body) { return (Pose){body->position, body->angle}; }

/* m */
static inline double height_of(const VerdictWatch *watch, const Pose *pose) {
    return (double)vec2_dot(pose->at, watch->up);
}

static inline double turn_between(const Pose *a, const Pose *b) {
    const double turn = (double)a->angle - (double)b->angle;
    return fabs(fabs(turn) <= M_PI ? turn : remainder(turn, 2 * M_PI));
}

/* m: how far a corner of the body is from where it was, at most. */
static inline double way_of(const WatchedBody *body, const Pose *from) {
    return vec2_distance(body->last.at, from->at) + turn_between(&body->last, from) * body->corner;
}

static inline Box box_of(const WatchedBody *body, const Pose *pose) {
    return box_make(pose->at, body->box, pose->angle);
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

/* m: how far two bodies have moved past each other in the last step, at most. */
double way_past(const WatchedBody *a, const WatchedBody *b);

/* Whether two bodies touch after the last step. */
bool bodies_touch(const VerdictWatch *watch, const WatchedBody *a, const WatchedBody *b);

/* Finds the pairs of bodies, finder.pairs, that may touch in the last step, or if they move down by half a side, or by
   `way`, m. */
bool find_near(VerdictWatch *watch, double way, Error *error);

/* The checks of a step; false if memory is short. Contacts, which are of the poses before the step, are checked before
   bodies get their new ones. The bomb's energy counts when it strikes. */
bool check_contacts(VerdictWatch *watch, const VerdictStep *step, Error *error);
bool check_passes(VerdictWatch *watch, Error *error);
void count_energy(VerdictWatch *watch, const WatchedBody *body);
void check_energy(VerdictWatch *watch, const VerdictStep *step);
bool check_hanging(VerdictWatch *watch, const VerdictStep *step, Error *error);

/* Stores the verdict if it is worse than the worst so far. */
void verdict_note(VerdictWatch *watch, Verdict verdict, int body, double value, const char *unit);
