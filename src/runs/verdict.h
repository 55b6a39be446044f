/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The verdict on a run: whether its physics is sound, what fell, whether it rests. A run is watched while it is made,
   or frame by frame from a file:

       SimulateVerdict verdict;
       simulate_verdict_begin(&verdict, scene, &method, error);
       ... StepObserver observer = {verdict_watch_observe, &verdict.watch}; simulate_watched(...) ...
       simulate_verdict_end(&verdict, error);
       simulate_verdict_words(&verdict, words);    "falls; 4 of 10 fell, first at 1.2 s; at rest since 3.4 s"

   The definitions (unit, size, sound, rest, carrier, fell, moved) are in src/studies/README.md, "The verdict on one
   run". They need poses, sizes, masses and gravity, and are the same in other units of length, time and mass. */
#pragma once
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "runs/contact_finder.h"
#include "runs/runs.h"
#include "runs/trajectory.h"
#include "scenes/scenes.h"

#include <stddef.h>
#include <stdint.h>

/* From the best to the worst. */
typedef enum Verdict {
    VERDICT_SETTLES,
    VERDICT_STANDS,
    VERDICT_MOVES,
    VERDICT_TOO_SHORT, /* nothing moved, and the run is shorter than half a unit */
    VERDICT_UNDECIDED, /* only in studies of struck scenes (studies/stability.h) */
    VERDICT_FALLS,
    VERDICT_COLLAPSES, /* at least half of the bodies that could fall */
    VERDICT_HANGS,
    VERDICT_SINKS,
    VERDICT_TUNNELS,
    VERDICT_EXPLODES,
    VERDICT_NON_FINITE,
    VERDICT_ADAPTER_FAILED, /* the program of the method `exec`; nothing is known of the physics */
    VERDICTS
} Verdict;

/* "settles", ... "adapter failed"; then "not applicable", for cells and borders without a verdict; then NULL. */
extern const char *const verdict_words[VERDICTS + 2];
const char *verdict_name(Verdict verdict);

/* Settles, stands or moves. */
bool verdict_holds(Verdict verdict);

/* Nothing hangs, sinks, tunnels or explodes, or is NaN. What falls may be sound. */
bool verdict_sound(Verdict verdict);

typedef struct VerdictCount {
    int bodies, fell, left, moved; /* dynamic ones but the bomb; what left has fallen, too */
    int first, body;               /* frame and body of the first fall that lasts; 0, -1: none */
    double farthest;               /* m: of those that moved */
} VerdictCount;

/* Drift is measured after so many units, when bodies have come to rest. */
enum { VERDICT_REASON_SIZE = 200, VERDICT_DRIFT_UNITS = 10 };

typedef struct VerdictReading {
    Verdict verdict;
    int frame; /* where it was decided: the first at which it applied; moves: the last; stands: since when it rests */
    int body;  /* or -1 */
    /* The deciding quantity. Settles, stands, moves: the highest speed at the end. Falls, collapses: bodies. Hangs:
       seconds. Sinks: penetration. Tunnels: speed. Explodes: energy gained, or the speed of a body that bursts away.
       Non-finite, adapter failed: the highest speed before. */
    double value;
    const char *unit; /* "J", "m", "m/s", "s", "boxes" */
    int other;        /* tunnels: the body that was passed through; else -1 */
    VerdictCount count;
    bool struck;    /* as verdict_is_struck() */
    bool by_itself; /* the first body fell before the bomb touched anything */
    bool moving;    /* at the end, a body is not at rest; also if the run is too short to tell */
    bool too_short;
    int since;                        /* the frame since which the run rests, if it does */
    char reason[VERDICT_REASON_SIZE]; /* adapter failed: how; else empty */
    int steps;
    double energy; /* J: of all dynamic bodies at the end */
    /* After ten units; NaN in a shorter run. m: the largest distance moved by a body since; J: energy gained since. */
    double drift, gained;
    double deepest;      /* m: penetration of the deepest contact of all steps */
    double excess;       /* J: most energy above what bodies brought; >= 0; NaN if not judged */
    Fallbacks fallbacks; /* of all steps that were observed */
} VerdictReading;

/* The run to be judged. */
typedef struct VerdictRun {
    Vec2 gravity; /* m/s^2 */
    float dt;     /* s */
    int bomb;     /* the index that the bomb has once it is there; -1: none */
    /* m: what the run's engine adds to each side of a box, so that boxes rest apart by twice that (Box2D before version
       3: 0.0075). 0: none. */
    float skin;
    bool masses_unknown; /* the energy of a struck run is not judged */
    bool finds_contacts; /* between the bodies before a step: those that steps state do not count */
    double allowed;      /* J: may be gained, as by bodies that overlap at the start and are pushed apart */
} VerdictRun;

/* The scene has a bomb that can strike a dynamic body, or some of its bodies start with a speed, but not all. */
bool verdict_is_struck(const Scene *scene);

/* A step, as given to the watch. */
typedef struct VerdictStep {
    int frame; /* 1, 2, ... */
    int body_count, contact_count;
    const Body *bodies;           /* [body_count] after the step */
    const ContactPoint *contacts; /* [contact_count] of the step: of the poses before it */
} VerdictStep;

typedef struct WatchedBody WatchedBody;
typedef struct DeepPair DeepPair;

/* Zero-initialise; free with verdict_watch_free(). */
typedef struct VerdictWatch {
    VerdictRun run;
    VerdictReading worst; /* so far, from hangs on */
    int frame, body_count;
    Vec2 up;                   /* unit vector */
    double pull;               /* m/s^2 */
    double mean;               /* m: mean size of the bodies at the start */
    double smallest;           /* m: the smallest side of a body */
    double floor;              /* m: the lowest point of all static bodies */
    double unit;               /* s */
    double energy;             /* J: in the last frame: of all dynamic bodies */
    double speed, fastest;     /* m/s: of the fastest body in the last frame; of the fastest corner so far */
    double brought, available; /* J: what bodies brought; of that, and of their height, what they can lose */
    double lowest, liveliest;  /* m, J/kg: of dynamic bodies at the start, and of added ones */
    double weight, farthest;   /* N, m: of all; from the origin so far: what rounding makes of them is no gain */
    double excess, least;      /* J, above `brought`: most and least so far */
    bool struck;
    int met;                /* the frame before the bomb first touched a dynamic body; -1: not so far */
    double deepest, rested; /* m; J: energy after ten units */
    int rested_frame;       /* 0: before ten units */
    Fallbacks fallbacks;
    WatchedBody *bodies;
    int deep_count;
    DeepPair *deep; /* pairs that are too deep now */
    ContactFinder finder;
    size_t capacity, deep_capacity;
} VerdictWatch;

void verdict_watch_free(VerdictWatch *watch);

/* Begins with the bodies before the first step. */
bool verdict_watch_begin(VerdictWatch *watch, const VerdictRun *run, const Body *bodies, int count, Error *error);

/* Follows one step. Bodies may be appended, or the last ones removed, but not both in one step. False with error set if
   memory is short, or too many bodies are near each other. */
bool verdict_watch_step(VerdictWatch *watch, const VerdictStep *step, Error *error);

/* The same for a world; a StepObserver callback. */
bool verdict_watch_observe(void *watch, int frame, const World *world, Error *error);

/* The method failed (MethodFailure) in the step to `frame`. Later steps are ignored. */
void verdict_watch_failed(VerdictWatch *watch, int frame, const Error *failure);

/* True if the run can be stopped: it explodes, is non-finite, or its adapter failed. */
bool verdict_watch_is_final(const VerdictWatch *watch);

/* The verdict on the run up to the last step. */
VerdictReading verdict_watch_end(const VerdictWatch *watch);

/* True if the body has fallen at the end. */
bool verdict_watch_fell(const VerdictWatch *watch, int body);

/* The verdict on one run of a scene by a method, while it is made or stored. Free with simulate_verdict_free(). */
typedef struct SimulateVerdict {
    const char *scene, *method; /* their names */
    VerdictWatch watch;
    VerdictReading reading; /* after simulate_verdict_end() */
} SimulateVerdict;

/* Before the run. The scene and the method outlive the verdict. */
bool simulate_verdict_begin(SimulateVerdict *verdict, const Scene *scene, const Method *method, Error *error);

/* After the run; failure: why it failed, if it did. False if there is no verdict: it was not the method that failed. */
bool simulate_verdict_end(SimulateVerdict *verdict, const Error *failure);
void simulate_verdict_free(SimulateVerdict *verdict);

/* After simulate_verdict_end(): "collapses; 8 of 10 fell, first at 1.2 s; still moving at the end". The words go with a
   stored run, so they also say what makes it no yardstick: "; 175 steps did not converge". */
void simulate_verdict_words(const SimulateVerdict *verdict, char words[TRAJECTORY_VERDICT_SIZE]);

/* Assumed of a stored run without its scene; the density only if the run states no masses. */
#define VERDICT_GRAVITY 10.0f /* m/s^2, down */
#define VERDICT_DENSITY 1.0f  /* kg/m^2 */

/* The verdict on a stored run, which outlives it, from begin to end. Gravity and the bomb are those of the scene,
   unless it is NULL, and so are masses, if the run states none; skin: as in VerdictRun. Contacts are found again,
   so that it is the verdict of the run while it was made; velocities that the run does not state are differences of
   poses. A run whose own verdict is non-finite has ended so. ERROR_INPUT: the scene has other bodies, or a body is
   missing before another one; free the verdict in any case. */
bool simulate_verdict_of_run(SimulateVerdict *verdict, const Trajectory *run, const Scene *scene, float skin,
                             Error *error);
