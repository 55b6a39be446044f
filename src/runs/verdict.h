/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The verdict on a run: whether its physics is sound, what fell, whether it rests. A run is watched while it is made,
   or frame by frame from a file:

       SimulateVerdict verdict;
       simulate_verdict_begin(&verdict, scene, &method, error);
       ... StepObserver observer = {verdict_watch_observe, &verdict.watch}; simulate_watched(...) ...
       simulate_verdict_end(&verdict, error);
       simulate_verdict_words(&verdict, words);    "falls; 4 of 10 fell, first at 1.2 s; at rest since 3.4 s"

   The verdict needs poses, sizes, masses and gravity. It is the same in other units of length, time and mass. Up is
   against gravity. The size of a body is the root of its area, its side the smaller one. The unit of time is that in
   which a body falls five mean sizes; without gravity, that in which the fastest corner so far goes as far: it never
   depends on dt. Bodies are the dynamic ones but the bomb. Two touch if the gap between them is no more than 3% of a
   side, beside what they have moved past each other in the step.

   Sound, unless a body's state is not finite, or the run
   - explodes: the energy of all dynamic bodies exceeds what they brought by 1% of what is available to be lost, or the
     least that it stayed below for a unit by 5%; or a body has five times the energy per kg of the liveliest one at the
     start. The bomb brings what it has in the step before it first touches a body.
   - sinks: two bodies are deeper in each other than a quarter of the smaller side for half a unit.
   - tunnels: a body is on the other side of another, past which it went by more than half a side deep: between two
     frames, or while they were deeper in each other than a quarter of a side.
   - hangs: a body has kept its place for half a unit, and no chain of touching bodies joins it to a static one.

   Rest. A body has a place: the pose from which its corners have since moved by no more than 2% of its size; when it
   moves farther, it takes a new place there. It rests if it took its last place half a unit ago and more than twice the
   shorter of its last two stays, so that constant gliding never rests. A run rests since its last body does; the bomb
   need not.

   Carrier. A body's carrier is what it touches first if it moves down from its start by up to half its side or, if it
   starts at rest, as far as it would fall in a unit. For a body that nothing carries then, the strike of the bomb is
   the start. What has none is judged by rest and leaving only.

   Fell, at the end: a body is lower than at the start by more than half its side and the gaps below it, and so relative
   to its carrier, beside how deep it is in that; or its carrier fell, too: neither sag nor pressing in is a fall. Or it
   has turned by 30 degrees; or it left: it is below all static bodies. Moved: has not fallen, and is a tenth of its
   size beside its start, or above it. */
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
    int bodies, fell, left, moved; /* what left has fallen, too */
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
    uint64_t state;                   /* set by verdict_run() only: FNV-1a of the bodies after the last step */
    int steps;                        /* set by verdict_run() only */
    /* After ten units; NaN in a shorter run. m: the largest distance moved by a body since; J: energy gained since. */
    double drift, gained;
    double deepest;      /* m: penetration of the deepest contact of all steps */
    double excess;       /* J: most energy above what bodies brought; >= 0; NaN if not judged */
    Fallbacks fallbacks; /* of all steps that were observed */
} VerdictReading;

/* The energy of a converged run per frame, beside which studies judge other runs of the same scene. Zero-initialise;
   free with energy_log_free(); may be made again. */
typedef struct EnergyLog {
    int frames;
    double *energy;  /* [frames + 1] J: of all dynamic bodies */
    int unconverged; /* the first step whose solution did not converge, from which on the log bounds nothing; 0: none */
    double liveliest;    /* J/kg: the most energy of a body in any frame, above the lowest at the start */
    Fallbacks fallbacks; /* of all steps */
    Vec2 gravity;
    double lowest; /* m: height of a body at the start */
    size_t capacity;
} EnergyLog;

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
    /* Energy is no gain that the converged run has within a unit before or after. At least as many frames; outlives the
       watch. NULL: none. */
    const EnergyLog *converged;
} VerdictRun;

/* The scene has a bomb that can strike a dynamic body, or some of its bodies start with a speed, but not all. */
bool verdict_is_struck(const Scene *scene);

/* Of a scene that the method runs. */
VerdictRun verdict_run_of(const Scene *scene, const Method *method);

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
    double smallest, thinnest; /* m: smallest side of a dynamic body; of any */
    double floor;              /* m: the lowest point of all static bodies */
    double unit;               /* s */
    double energy;             /* J: in the last frame: of all dynamic bodies */
    double speed, fastest;     /* m/s: of the fastest body in the last frame; of the fastest corner so far */
    double brought, available; /* J: what bodies brought; of that, and of their height, what they can lose */
    double lowest, liveliest;  /* m, J/kg: of dynamic bodies at the start, and of added ones */
    double weight, lift, largest, farthest; /* N, J, m, m: floor of what counts as gained energy */
    double peak, kept, excess, least; /* J, above `brought`: this unit's most, the least of whole units, most, least */
    int unit_began;
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

/* The verdict on one run in words, found while its steps are made. Begin with simulate_verdict_begin(); free with
   simulate_verdict_free(). */
typedef struct SimulateVerdict {
    const Scene *scene;
    const char *method;
    VerdictWatch watch;
    VerdictReading reading; /* after simulate_verdict_end() */
} SimulateVerdict;

/* The scene and the method outlive the verdict. */
bool simulate_verdict_begin(SimulateVerdict *verdict, const Scene *scene, const Method *method, Error *error);

/* After the run; failure: why it failed, if it did. False if there is no verdict: it was not the method that failed. */
bool simulate_verdict_end(SimulateVerdict *verdict, const Error *failure);
void simulate_verdict_free(SimulateVerdict *verdict);

/* After simulate_verdict_end(): "collapses; 8 of 10 fell, first at 1.2 s; still moving at the end". The words go with a
   stored run, so they also say what makes it no yardstick: "; 175 steps did not converge". */
void simulate_verdict_words(const SimulateVerdict *verdict, char words[TRAJECTORY_VERDICT_SIZE]);

/* The verdict on a stored run. Contacts are found again, so that it is the one of simulate(); velocities, if the run
   does not state them, are differences of poses. */

/* Assumed of a run that states no masses and is judged without its scene. */
#define VERDICT_GRAVITY 10.0f /* m/s^2, down */
#define VERDICT_DENSITY 1.0f  /* kg/m^2 */

/* What a run says of its scene: bodies with their masses, or of VERDICT_DENSITY, and a bomb. To be destroyed with
   scene_destroy(). NULL with error set. */
Scene *trajectory_scene(const Trajectory *run, Error *error);

/* By what a stored run is judged. */
typedef struct RunScene {
    Scene *scene; /* masses, gravity and bomb; gets the run's time step and frames */
    bool assumed; /* it is that of trajectory_scene() */
    float skin;   /* m, as in VerdictRun */
} RunScene;

/* The scene and the run outlive the verdict. A run whose own verdict is non-finite has ended so, and that is the
   verdict. ERROR_INPUT: the scene has other bodies, or a body is missing before another one; free the verdict in any
   case. */
bool simulate_verdict_of_run(SimulateVerdict *verdict, const RunScene *by, const Trajectory *run, Error *error);
