/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The verdict on a run: the energy of its bodies, what is watched while it is made, how it ended. */
#pragma once
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "runs/runs.h"
#include "scenes/scenes.h"

#include <stddef.h>
#include <stdint.h>

/* The energy that the bodies of a run have, and how much of it is available to be lost. */

/* Begin with energy_balance_begin(). */
typedef struct EnergyBalance {
    Vec2 gravity;
    double energy; /* J: mechanical energy of all dynamic bodies in the last frame */
    /* J: energy available to be lost, the larger of two.
       (a) The energy lost so far: the largest drop below the highest level before. Energy that an added body brings, or
       that pushing overlapping bodies apart adds, raises the level; energy of a removed body lowers it.
       (b) The potential energy of all dynamic bodies at the start, and of added ones: m |g| times the height above the
       lowest dynamic body at the start. So a standing stack has all its height to lose. */
    double available;
    double potential; /* J: (b) */
    double weight;    /* N: of all dynamic bodies at the start, and of added ones */
    double kinetic;   /* J: of all bodies at the start, and of added ones */
    double brought;   /* J: energy at the start and of added bodies; a removed body takes its share along */
    double lowest;    /* m: lowest height of a dynamic body at the start; INFINITY: no dynamic body so far */
    double level;     /* J: energy if none had been lost */
    int body_count;   /* in the last frame */
} EnergyBalance;

/* Begins with the bodies at the start. */
void energy_balance_begin(EnergyBalance *balance, Vec2 gravity, const Body *bodies, int count);

/* The energy of a run per frame: the reference for judging other runs of the same scene. */

/* Zero-initialise; free with energy_log_free(); may be begun again. */
typedef struct EnergyLog {
    int frames;            /* of the run */
    double *energy;        /* [frames + 1] J: as in EnergyBalance */
    EnergyBalance balance; /* after the last frame */
    size_t capacity;
} EnergyLog;

void energy_log_free(EnergyLog *log);

/* Begins the log of a run of `frames` steps with the bodies at the start. */
bool energy_log_begin(EnergyLog *log, Vec2 gravity, int frames, const Body *bodies, int count, Error *error);

/* Adds frame 1, 2, ... frames. Bodies may be appended, or the last ones removed, but not both in one step. */
void energy_log_step(EnergyLog *log, int frame, const Body *bodies, int count);

/* Runs a scene with a method and logs it. ERROR_INPUT also if the state becomes NaN or infinite. */
bool energy_log_run(EnergyLog *log, const Scene *scene, const Method *method, Error *error);

/* The verdict on one run: whether it holds, and if not how, where and when it fails.

   A watch observes a run step by step and stores only what the verdict needs: the last and some earlier positions of
   each body, and sums. All methods are judged by the limits below. Of several verdicts the worst counts, with the first
   frame at which it applied. SI units. */

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
    VERDICT_ADAPTER_FAILED, /* the program of the method `exec`; nothing is known of the physics */
    VERDICTS
} Verdict;

/* Settles: over the last VERDICT_CALM_FRAMES frames, the mean kinetic energy per dynamic body is below
   VERDICT_CALM_ENERGY (J): a box of 1 kg at 14 mm/s. Sways: otherwise. */
enum { VERDICT_CALM_FRAMES = 60 };
#define VERDICT_CALM_ENERGY 1e-4

/* Creeps: a body has moved more than VERDICT_CREEP_DISTANCE (m) in VERDICT_CREEP_SECONDS. Checked every second, counted
   back from the last frame (a second is rounded to whole steps), and only after VERDICT_CREEP_FROM seconds, when bodies
   have come to rest. */
#define VERDICT_CREEP_DISTANCE 0.05
enum { VERDICT_CREEP_SECONDS = 10, VERDICT_CREEP_FROM = 10 };

/* Falls: a body is lower than where it stood by more than VERDICT_FALL_SHARE of its smaller side, or has rotated by
   more than VERDICT_FALL_ANGLE (degrees), even if it comes to rest there. Sag does not count: a tall pile
   whose contacts give way by some millimetres each is lower at its top, and stands. */
#define VERDICT_FALL_SHARE 0.5
#define VERDICT_FALL_ANGLE 30.0

/* Sinks: for VERDICT_SINK_TIME (s), every step has a contact deeper than VERDICT_SINK_SHARE of the smallest side of its
   bodies and deeper than VERDICT_SINK_LEAST (m). The penetration of an impact is corrected faster. The second limit is
   twice the slop of 0.01 m that the engine permits; it matters for thin bodies. */
#define VERDICT_SINK_SHARE 0.05
#define VERDICT_SINK_LEAST 0.02
#define VERDICT_SINK_TIME 1.0

/* Explodes: the energy exceeds its bounds (verdict_watch_step) by more than VERDICT_ENERGY_SHARE of the energy
   available in the converged run or, without one, in this run, taken as at least
   VERDICT_LEAST_AVAILABLE (J): otherwise rounding would make a scene at rest explode. The bounds use intervals of VERDICT_ENERGY_TIME (s): an impact stores energy in
   penetration and releases it in far less time. */
#define VERDICT_ENERGY_SHARE 0.01
#define VERDICT_ENERGY_TIME 1.0
#define VERDICT_LEAST_AVAILABLE 1.0

/* Without a converged run: a run that has lost energy may regain VERDICT_REGAIN_SHARE of the available energy, as a stack
   that sank under its weight does when it is pushed up again; the available energy is at least what lifts all bodies by
   VERDICT_LEAST_LIFT (m); and the energy of the first second is not judged if bodies
   overlap by more than VERDICT_START_OVERLAP (m) at the start. */
#define VERDICT_REGAIN_SHARE 0.05
#define VERDICT_LEAST_LIFT 0.1
#define VERDICT_START_OVERLAP 0.0105

/* "settles", ... "non-finite", "adapter failed"; then "not applicable", for cells and borders without a verdict; then NULL. */
extern const char *const verdict_words[VERDICTS + 2];
const char *verdict_name(Verdict verdict);

/* Settles, sways or creeps. */
bool verdict_holds(Verdict verdict);

enum { VERDICT_REASON_SIZE = 200 };

typedef struct VerdictReading {
    Verdict verdict;
    int frame; /* the first at which it applied; settles: first calm frame; sways: last frame that was not calm */
    int body;  /* or -1 */
    /* The deciding quantity at that frame. Settles, sways: mean kinetic energy of a dynamic body. Creeps: distance in
       10 s. Falls: m lower, or degrees rotated. Sinks: penetration. Tunnels: speed. Explodes: excess energy (`body` has
       the most kinetic energy). Non-finite, adapter failed: the highest speed before. */
    double value;
    const char *unit;                 /* "J", "m", "deg", "m/s" */
    char reason[VERDICT_REASON_SIZE]; /* adapter failed: how; else empty */
    uint64_t state;                   /* set by verdict_run() only: FNV-1a of the bodies after the last step */
    /* Since VERDICT_CREEP_FROM seconds; NaN if the run is not longer. m: largest distance moved by a body that existed
       then. J: energy gained. */
    double drift, gained;
    double deepest; /* m: penetration of the deepest contact of all steps */
    double excess;  /* J: most energy above what the start and added bodies brought; >= 0; NaN if not judged */
    int steps;      /* set by verdict_run() only, as are fallbacks */
    NetworkFallbacks fallbacks;
} VerdictReading;

/* The run to be judged. */
typedef struct VerdictRun {
    Vec2 gravity; /* m/s^2 */
    float dt;     /* s */
    int frames;   /* steps */
    /* All bodies are meant to stay in place. If false, falling is not judged, and creeping only at the end of the run
       and not for the bomb, which may roll. */
    bool stands;
    bool until_bomb; /* falling is judged until the bomb first touches something */
    /* m: what the run's engine adds to each side of a box, so that boxes rest apart by twice that (Box2D before version
       3: 0.0075). Boxes touch within it, and may rise by it. 0: none. */
    float skin;
    bool other_engine;   /* another program makes the run */
    bool no_energy;      /* is not judged: masses are not known */
    bool finds_contacts; /* between the bodies before a step: those that steps state do not count */
    /* The same scene run by "reference", with at least as many frames; outlives the watch. NULL: the run is judged by
       its own energy alone. */
    const EnergyLog *converged;
} VerdictRun;

/* Sets skin and other_engine, for the method exec. */
void verdict_run_set_engine(VerdictRun *run, const Method *method);

/* The run of a scene without a converged run. It is meant to stand if all bodies start at rest: to the end without a
   bomb, or else until the bomb touches something. */
VerdictRun verdict_run_of(const Scene *scene);

/* A step, as given to the watch. */
typedef struct VerdictStep {
    int frame; /* 1, 2, ... frames */
    int body_count, contact_count;
    int bomb;                     /* index, or -1 */
    const Body *bodies;           /* [body_count] after the step */
    const ContactPoint *contacts; /* [contact_count] of the step */
} VerdictStep;

typedef struct WatchedBody {
    Vec2 outside;     /* m: last position of the centre outside all static boxes; initially the start */
    Vec2 last, stood; /* m: in the last frame; before the step of its first contact */
    float last_angle, stood_angle;
    bool touched;      /* has had a contact */
    double lower, sag; /* m: than where it stood; of that, what contacts below it account for */
    bool fallen;       /* as by VERDICT_FALL_SHARE and VERDICT_FALL_ANGLE, in the last frame; static bodies never */
    Vec2 rested;       /* m: after VERDICT_CREEP_FROM seconds */
    int samples;
    Vec2 sample[VERDICT_CREEP_SECONDS]; /* ring buffer, one position per second */
} WatchedBody;

/* Static bodies never move. */
typedef struct WatchedStatic {
    int body;
    double cosine, sine; /* of its angle */
} WatchedStatic;

/* Zero-initialise; free with verdict_watch_free(); may be begun again. Internal to the checks
   (runs/internal.h). */
typedef struct VerdictWatch {
    VerdictRun run;
    VerdictReading worst; /* so far, from creeps on */
    int frame;            /* the last */
    int body_count, touched_count;
    WatchedBody *bodies;
    size_t capacity;
    WatchedStatic *statics; /* [static_count] ascending */
    int static_count;
    size_t static_capacity;
    double brought;          /* J: energy at the start and of added bodies; without a converged run, the bound (c) */
    double kept;             /* J: lowest of the energy peaks of all whole seconds, plus the energy of added bodies */
    double peak;             /* J: highest energy in the current second */
    EnergyBalance own;       /* without a converged run */
    double energy;           /* J: in the last frame */
    double smallest;         /* m: side of a dynamic body */
    double rested;           /* J: energy after VERDICT_CREEP_FROM seconds */
    double kinetic;          /* J: mean of the dynamic bodies */
    double kinetic_not_calm; /* J: the same in the last frame that was not calm */
    double speed;            /* m/s: of the fastest body */
    int calm, deep;          /* consecutive calm frames; consecutive frames with a deep contact */
    int peak_steps;          /* of the current second */
    int rested_count;        /* bodies after VERDICT_CREEP_FROM seconds; 0 before */
    double deepest, excess;  /* as in VerdictReading */
    ContactFinder finder;    /* of a run that finds its contacts */
} VerdictWatch;

void verdict_watch_free(VerdictWatch *watch);

/* Begins with the bodies before the first step. ERROR_INPUT if the converged run is shorter. */
bool verdict_watch_begin(VerdictWatch *watch, const VerdictRun *run, const Body *bodies, int count, Error *error);

/* Checks one step. Bodies may be appended, or the last ones removed, but not both in one step. Allocates only if bodies
   are appended. False with error set if out of memory.

   Non-finite: a body's state is NaN or infinite.

   Explodes: the energy exceeds both bounds by more than VERDICT_ENERGY_SHARE of the available energy. (a) The run's
   own: the lowest of the energy peaks of all whole seconds, initially the energy at the start. An added body's energy
   is added; when a body is removed, it restarts with the remaining energy. (b) The converged run's highest energy
   within VERDICT_ENERGY_TIME before or after the frame: events may be shifted in time. (b) alone does not suffice: a
   box that still stands where the converged one has fallen has more energy, but has not gained any. Nor does (a):
   pushing apart boxes that overlap at the start adds energy in the converged run too. (a) uses peaks, since in an
   impact of any unconverged method boxes penetrate and are pushed out again, like a bounce.

   Explodes, without a converged run: energy can only come from added bodies, so (c) is the energy at the start plus that
   of all added bodies. It exceeds (c) by more than VERDICT_ENERGY_SHARE, or (a) by more than VERDICT_REGAIN_SHARE, of the
   available energy, which includes the kinetic energy of the start and of added bodies. If bodies overlap at the start,
   (a) and (c) begin with the peak of the first second. Compared with the verdicts beside converged runs: `verdict_alone`
   in tests/stability.

   Of another engine every bound is higher by what gravity does in a step, m (g dt)^2 / 2: Chipmunk moves bodies before it
   changes velocities, and so states both half a step apart.

   With a skin, boxes that a scene places side by side are pushed apart: each bound is higher by what lifts every body
   by two skins for each body that may be below it, its height over the smallest side.

   Tunnels: the centre of a dynamic body passed through a static box: the straight line from its last position outside
   all static boxes intersects one. Not if the centre is inside a box for a step and is pushed out again; if it stays
   inside, it sinks. Also finds bodies that leave the world through the ground, but not past its edge.

   Falls: a body stood where it was at its first contact, so that gaps that a scene starts with may close. Its sag is
   subtracted: the mean depth of the contact from below, and the sag of the body there, the most if there are several. A
   contact is from below if its normal is nearer to gravity than to the horizontal. A column that leans gets no
   sag, and falls. A pile that gives way without end sinks. */
bool verdict_watch_step(VerdictWatch *watch, const VerdictStep *step, Error *error);

/* The same for a world; a StepObserver callback. */
bool verdict_watch_observe(void *watch, int frame, const World *world, Error *error);

/* True if a run failed because a body's state became NaN or infinite, or because the program of the method `exec` failed: that
   is a verdict, and other failures are not. */
bool verdict_is_failure(const Error *failure);

/* The step to `frame` failed in such a way. Later steps are ignored. */
void verdict_watch_failed(VerdictWatch *watch, int frame, const Error *failure);

/* True if the run can be stopped: it explodes, is non-finite, or its adapter failed. */
bool verdict_watch_is_final(const VerdictWatch *watch);

/* The verdict on the run up to the last step. A run shorter than VERDICT_CALM_FRAMES cannot settle. */
VerdictReading verdict_watch_end(const VerdictWatch *watch);

/* Runs the scene with the method, whose skin counts, until the verdict is final. A NaN or infinite state is a verdict,
   not an error. False with error set if the method cannot be created or memory is short. */
bool verdict_run(VerdictReading *reading, const Scene *scene, const Method *method, const VerdictRun *run,
                 Error *error);

/* The verdict on one run in words, found while its steps are made. */

/* Begin with simulate_verdict_begin(); free with simulate_verdict_free(). */
typedef struct SimulateVerdict {
    const Scene *scene;
    const char *method;
    VerdictWatch watch;
    VerdictReading reading; /* after simulate_verdict_end() */
} SimulateVerdict;

/* The scene and the method outlive the verdict. */
bool simulate_verdict_begin(SimulateVerdict *verdict, const Scene *scene, const Method *method, Error *error);

/* To be called after every step; outlived by the verdict. */
StepObserver simulate_verdict_observer(SimulateVerdict *verdict);

/* After the run; failure: why it failed, if it did. False if there is no verdict: the run failed for another reason than
   a NaN or infinite state. */
bool simulate_verdict_end(SimulateVerdict *verdict, const Error *failure);
void simulate_verdict_free(SimulateVerdict *verdict);

/* After simulate_verdict_end(): "falls at 4.22 s (body 7, 0.53 m lower)". */
void simulate_verdict_words(const SimulateVerdict *verdict, char words[TRAJECTORY_VERDICT_SIZE]);

/* The number of dynamic bodies but the bomb, and how many of them have fallen. */
int simulate_verdict_bodies(const SimulateVerdict *verdict, int *fallen);

/* The verdict on a stored run. Contacts are found again, so that it is the one of simulate(); velocities, if the run
   does not state them, are differences of poses. */

/* Assumed of a run without its scene. */
#define VERDICT_GRAVITY 10.0f /* m/s^2, down */
#define VERDICT_DENSITY 1.0f  /* kg/m^2 */

/* What a run says of its scene: bodies of VERDICT_DENSITY, which start with a speed if they do not rest, and a bomb. To
   be destroyed with scene_destroy(). NULL with error set. */
Scene *trajectory_scene(const Trajectory *run, Error *error);

/* By what a stored run is judged. */
typedef struct RunScene {
    Scene *scene; /* masses, gravity and bomb; gets the run's time step and frames */
    bool assumed; /* it is that of trajectory_scene() */
    float skin;   /* m, as in VerdictRun */
} RunScene;

/* The scene and the run outlive the verdict. In an assumed scene that has a bomb, or bodies that start with a speed,
   energy is not judged: light bodies get much of it from heavy ones. A run whose own verdict is non-finite has ended
   so, and that is the verdict. ERROR_INPUT: the scene has other bodies, or a body is missing before another one; free
   the verdict in any case. */
bool simulate_verdict_of_run(SimulateVerdict *verdict, const RunScene *by, const Trajectory *run, Error *error);
