/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The verdict on one run: does it hold, and if not, how does it fail, where and when.

   A watch follows a run step by step and keeps of it only what a verdict needs: the last and some earlier places of each
   body, and sums. Every method is judged by the same limits, those below. Of several verdicts the worst one counts, with
   the first frame at which it was true. SI units. */
#pragma once
#include "stability/energy_log.h"

/* From the best to the worst. */
typedef enum Verdict {
    VERDICT_SETTLES,
    VERDICT_SWAYS,
    VERDICT_CREEPS,
    VERDICT_FALLS,
    VERDICT_SINKS,
    VERDICT_TUNNELS,
    VERDICT_EXPLODES,
    VERDICT_NON_FINITE,
    VERDICTS
} Verdict;

/* Settles: for so many frames on end, up to the last one, all that moves has less kinetic energy a body, in the mean, than
   this (J): a box of 1 kg at 14 mm/s. Sways: otherwise. */
enum { VERDICT_CALM_FRAMES = 60 };
#define VERDICT_CALM_ENERGY 1e-4

/* Creeps: a body is farther (m) from where it was so many seconds before. A second is the nearest whole number of steps,
   and they are counted back from the last frame. Looked at only from that many seconds on: things come to rest first. */
#define VERDICT_CREEP_DISTANCE 0.05
enum { VERDICT_CREEP_SECONDS = 10, VERDICT_CREEP_FROM = 10 };

/* Falls: a body is lower than where it stood by more than this share of its smaller side, or has turned from it by more
   than so much (degrees). A box that leans by 30 degrees and stands on is no part of what was built. */
#define VERDICT_FALL_SHARE 0.5
#define VERDICT_FALL_ANGLE 30.0

/* Sinks: in every step of a second there is a contact deeper than this share of the smallest side of its two bodies. The
   overlap of a blow is pushed out before. Thin bodies: what the engine leaves on purpose (slop 0.01 m) and as much again
   (m) is not sinking. */
#define VERDICT_SINK_SHARE 0.05
#define VERDICT_SINK_LEAST 0.02
#define VERDICT_SINK_TIME 1.0

/* Explodes: energy too high by more than this share of what the converged run had to lose, which counts as no less than so
   many J: else a scene at rest would explode by rounding. Too high is what is more than the run kept to for so many
   seconds: an overlap takes energy in a blow, and has given it back well within a second. */
#define VERDICT_ENERGY_SHARE 0.01
#define VERDICT_ENERGY_TIME 1.0
#define VERDICT_LEAST_TO_LOSE 1.0

/* "settles", ... "non-finite"; then "not applicable", for cells and borders without a verdict; then NULL. */
extern const char *const verdict_words[VERDICTS + 2];
const char *verdict_name(Verdict verdict);

/* Settles, sways or creeps. */
bool verdict_holds(Verdict verdict);

typedef struct VerdictReading {
    Verdict verdict;
    int frame; /* the first at which it was so; settles: calm from here on; sways: the last that was not calm */
    int body;  /* or -1 */
    /* What decided, at that frame. Settles, sways: J, mean kinetic energy of a body that moves. Creeps: m in 10 s. Falls: m
       lower, or deg turned. Sinks: m deep. Tunnels: m/s. Explodes: J too much, and the body that has the most kinetic
       energy. Non-finite: m/s, the greatest speed before. */
    double value;
    const char *unit; /* "J", "m", "deg", "m/s" */
    /* What has become of what had VERDICT_CREEP_FROM seconds to come to rest, since then; NAN where the run is not longer.
       m: the farthest that a body has gone, of those that were there then. J: by how much the energy has grown. */
    double drift, gained;
    int steps; /* taken, and what was not done of what a network said in them; both of verdict_run alone */
    NetworkFallbacks fallbacks;
} VerdictReading;

/* What is to be judged. */
typedef struct VerdictRun {
    Vec2 gravity; /* m/s^2 */
    float dt;     /* s */
    int frames;   /* steps */
    /* True where all that moves is meant to stay where it is. Falling is judged only then; and otherwise creeping only in
       the last seconds of the run, and not of the bomb: it may roll. */
    bool stands;
    const EnergyLog
        *converged; /* the same scene by the method "reference"; of at least as many frames; outlives the watch */
} VerdictRun;

/* A step as the watch sees it. */
typedef struct VerdictStep {
    int frame; /* 1 .. frames, each in turn */
    int body_count, contact_count;
    int bomb;                     /* index, or -1 */
    const Body *bodies;           /* [body_count] after the step */
    const ContactPoint *contacts; /* [contact_count] that it found */
} VerdictStep;

/* What is kept of a body. */
typedef struct WatchedBody {
    Vec2 outside;     /* m: the last place with the centre in no static box; at first that of the start */
    Vec2 last, stood; /* m: in the last frame; before the step that first found it touching */
    float last_angle, stood_angle;
    bool touched;
    Vec2 rested; /* m: after VERDICT_CREEP_FROM seconds */
    int samples;
    Vec2 sample[VERDICT_CREEP_SECONDS]; /* a ring, one a second */
} WatchedBody;

/* Zero-initialise; freed by verdict_watch_free, and may be begun again. Its insides are the
   checks' (stability/verdict_checks.h). */
typedef struct VerdictWatch {
    VerdictRun run;
    VerdictReading worst; /* of those that are found on the way: from creeps on */
    int frame;            /* the last */
    int body_count;
    WatchedBody *bodies;
    size_t capacity;
    double kept;    /* J: least over whole seconds of the greatest energy in one, and what has joined since */
    double peak;    /* J: the greatest energy of the second that is not over yet */
    double energy;  /* J: of the last frame */
    double rested;  /* J: of that after VERDICT_CREEP_FROM seconds */
    double kinetic; /* J: mean of the bodies that move */
    double loud;    /* J: the same in the last frame that was not calm */
    double speed;   /* m/s: of the fastest body */
    int calm, deep, peak_steps; /* frames on end */
    int rested_count;           /* bodies after VERDICT_CREEP_FROM seconds; 0 before */
} VerdictWatch;

void verdict_watch_free(VerdictWatch *watch);

/* Begins with the bodies before the first step. ERROR_INPUT where the converged run is shorter. */
bool verdict_watch_begin(VerdictWatch *watch, const VerdictRun *run, const Body *bodies, int count, Error *error);

/* Looks at a step. Bodies may have joined at the end, or the last ones have left, but not both at once. Allocates only
   where one has joined. False with error set when memory is short.

   Non-finite: a number of a body is none.

   Explodes: the energy is above both of these bounds, by more than VERDICT_ENERGY_SHARE of what there was to lose.
   (a) What the run itself has kept to: the least, over whole seconds, of the greatest energy in one; at first that of the
   start. What a body brings that joins is added; where one leaves, it begins anew with what is left.
   (b) The converged run's greatest energy within VERDICT_ENERGY_TIME of the same frame, before or after: a hop that comes
   a little later is none. Near a body's joining or leaving that is with the body.
   (b) alone is no bound: a box that still stands where the converged one has fallen has more energy, yet has made none. Nor
   is (a): pushing apart what overlaps at the start adds energy, in the converged run too. Nor would the least energy of a
   single frame do for (a): in a blow boxes go into each other and are pushed out again, in every method that has not
   converged, and that is no more than a bounce.

   Tunnels: the centre of a body that moves went through a static box: the straight way from the last place where it was
   outside them all has a part inside one. So a blow so fast that the centre dips into a box for a step and is pushed out
   again is none; what stays inside sinks. That finds what falls out of the world too: there is a way through the ground or
   past its edge, and past is no fault.

   Falls: where a body stood is where it was when it first touched something. So gaps that a scene is built with may
   close. */
bool verdict_watch_step(VerdictWatch *watch, const VerdictStep *step, Error *error);

/* The same of a world: what a StepObserver's observe is. */
bool verdict_watch_observe(void *watch, int frame, const World *world, Error *error);

/* The step to `frame` failed: a body left the finite numbers. Whatever comes after is not looked at. */
void verdict_watch_failed(VerdictWatch *watch, int frame);

/* True where the run need not go on: it explodes, or is no more finite. */
bool verdict_watch_is_final(const VerdictWatch *watch);

/* The verdict on the run up to the last step seen. One that is shorter than VERDICT_CALM_FRAMES cannot settle. */
VerdictReading verdict_watch_end(const VerdictWatch *watch);

/* Runs the scene by the method, until the verdict is final, and judges it. A run that leaves the finite numbers is a
   result. False with error set when the method cannot be created or memory is short. */
bool verdict_run(VerdictReading *reading, const Scene *scene, const Method *method, bool stands,
                 const EnergyLog *converged, Error *error);
