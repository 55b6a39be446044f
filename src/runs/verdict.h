/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The verdict on a run: the energy of its bodies, what is watched while it is made, how it ended. */
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
    double lift;      /* J: what lifts each of them by its size (verdict_size) */
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
    EnergyBalance balance; /* after the last frame, or before the first that is unconverged */
    int unconverged; /* the first step whose solution did not converge, from which on the log bounds nothing; 0: none */
    Fallbacks fallbacks; /* of all steps: how many did not converge, and their largest residual */
    double liveliest;    /* J/kg: the most energy of a body in any frame; potential: above the lowest at the start */
    size_t capacity;
} EnergyLog;

void energy_log_free(EnergyLog *log);

/* Begins the log of a run of `frames` steps with the bodies at the start. */
bool energy_log_begin(EnergyLog *log, Vec2 gravity, int frames, const Body *bodies, int count, Error *error);

/* Adds frame 1, 2, ... frames. Bodies may be appended, or the last ones removed, but not both in one step. */
void energy_log_step(EnergyLog *log, int frame, const Body *bodies, int count);

/* Runs a scene with a method and logs it. ERROR_INPUT also if the method fails (MethodFailure). */
bool energy_log_run(EnergyLog *log, const Scene *scene, const Method *method, Error *error);

/* The verdict on one run: whether it is sound, and what stands at its end.

   A watch observes a run step by step and stores only what the verdict needs: the last and some earlier positions of
   each body, and sums. All methods are judged by the limits below. Of several verdicts the worst counts, with the first
   frame at which it applied. SI units.

   Limits scale with the run, so that it has the same verdict in other units of mass, and as a copy whose lengths are s
   times as long and whose times are the root of s: lengths are shares of the bodies' sizes, energies those that lift
   bodies by their sizes, times are counted in falls. For boxes of 1 m and 1 kg, and a gravity of 10 m/s^2, the comments
   say what that is in SI units. */

/* From the best to the worst. */
typedef enum Verdict {
    VERDICT_SETTLES,
    VERDICT_AGREES, /* as are undecided, too few, too many: only in studies of struck scenes (studies/stability.h) */
    VERDICT_STANDS,
    VERDICT_MOVES,
    VERDICT_CREEPS,
    VERDICT_UNDECIDED,
    VERDICT_FALLS,
    VERDICT_COLLAPSES,
    VERDICT_TOO_FEW,
    VERDICT_TOO_MANY,
    VERDICT_SINKS,
    VERDICT_TUNNELS,
    VERDICT_EXPLODES,
    VERDICT_NON_FINITE,
    VERDICT_ADAPTER_FAILED, /* the program of the method `exec`; nothing is known of the physics */
    VERDICTS
} Verdict;

/* The size of a body: a square of this side has its area. m */
double verdict_size(const Body *body);

/* The unit of time, a fall (1 s): in it a body falls by five times the mean size of the dynamic bodies at the start.
   Rounded to whole steps. Without gravity, VERDICT_CALM_FRAMES steps, and gravity is what would lead to that. */
#define VERDICT_FALL_SIZES 5.0

/* Settles: over the last VERDICT_CALM_FALLS falls, each body rests: its kinetic energy is below that of a fall by
   VERDICT_CALM_SHARE of its size (45 mm/s), and contacts have carried it in the last VERDICT_AIR_TIME falls, from a
   static body on, directly or through other bodies; without gravity nothing needs to be carried. Moves: otherwise. */
enum { VERDICT_CALM_FRAMES = 60 };
#define VERDICT_CALM_FALLS 0.5
#define VERDICT_CALM_SHARE 1e-4
#define VERDICT_AIR_TIME 0.1

/* Creeps: a body has moved more than VERDICT_CREEP_SHARE of its size (50 mm) in VERDICT_CREEP_FALLS, but not more than
   VERDICT_CREEP_MOST of its size: what slides or falls freely does not creep. Checked every fall, counted back from the
   last frame, and only after VERDICT_CREEP_FROM falls, when bodies have come to rest. */
#define VERDICT_CREEP_SHARE 0.05
#define VERDICT_CREEP_MOST 2.0
enum { VERDICT_CREEP_FALLS = 10, VERDICT_CREEP_FROM = 10 };

/* Falls: a body is lower than where it stood by more than VERDICT_FALL_SHARE of its smaller side, or has rotated by
   more than VERDICT_FALL_ANGLE (degrees), even if it comes to rest there; or it is below all static bodies. Sag does
   not count: a tall pile whose contacts give way by some millimetres each is lower at its top, and stands. */
#define VERDICT_FALL_SHARE 0.5
#define VERDICT_FALL_ANGLE 30.0

/* A struck scene, which has a bomb or bodies that move at the start, is judged by what stands at its end of the bodies
   that started at rest. Stands: none has fallen. Falls: some have. Collapses: half of them or more. Of those that
   stand, the ones that are VERDICT_MOVED_SHARE of their size beside where they stood have moved. A body that is below
   all static ones has left the scene. */
#define VERDICT_MOVED_SHARE 0.1

/* Sinks: for VERDICT_SINK_TIME falls, every step has a contact deeper than VERDICT_SINK_SHARE of the smaller size of
   its bodies (0.15 m) or than half of their smallest side. The penetration of an impact is corrected faster. */
#define VERDICT_SINK_SHARE 0.15
#define VERDICT_SINK_HALF 0.5
#define VERDICT_SINK_TIME 1.0

/* Explodes: the energy exceeds its bounds (verdict_watch_step) by more than VERDICT_ENERGY_SHARE of the energy
   available in the converged run or, without one, in this run, taken as at least what lifts all bodies by
   VERDICT_LEAST_LIFT of their sizes (1 J): otherwise rounding would make a scene at rest explode. The bounds use
   intervals of VERDICT_ENERGY_TIME falls: an impact stores energy in penetration and releases it in far less time. */
#define VERDICT_ENERGY_SHARE 0.01
#define VERDICT_ENERGY_TIME 1.0
#define VERDICT_LEAST_LIFT 0.1

/* Without a converged run: a run that has lost energy may regain VERDICT_REGAIN_SHARE of the available energy, as a
   stack that sank under its weight does when it is pushed up again; and the energy of the first fall is not judged if
   bodies overlap by more than VERDICT_START_OVERLAP of their smaller size (10 mm) at the start. */
#define VERDICT_REGAIN_SHARE 0.05
#define VERDICT_START_OVERLAP 0.0105

/* Explodes, too: a body has VERDICT_BURST times the energy per kg, kinetic and potential, that the fastest body and the
   highest one have at the start, or when added: light boxes that a heavy one shoots away have no more than it had to
   lose. Where overlaps at the start shoot bodies away in the converged run, too, the most that one has there. */
#define VERDICT_BURST 5.0

/* "settles", ... "adapter failed"; then "not applicable", for cells and borders without a verdict; then NULL. */
extern const char *const verdict_words[VERDICTS + 2];
const char *verdict_name(Verdict verdict);

/* Settles, agrees, stands, moves or creeps. */
bool verdict_holds(Verdict verdict);

/* The physics is sound: nothing sinks, tunnels or explodes, or is NaN. What falls may be sound. */
bool verdict_sound(Verdict verdict);

/* Of the bodies that started at rest, how many there are and what became of them; the others are static, the bomb, or
   moved. */
typedef struct VerdictCount {
    int stood, fell, left, moved; /* those that left have fallen, too */
    int first, body;              /* frame and body of the first fall that lasts; 0, -1: none */
    double farthest;              /* m: of those that moved */
} VerdictCount;

enum { VERDICT_REASON_SIZE = 200 };

typedef struct VerdictReading {
    Verdict verdict;
    int frame; /* the first at which it applied; settles, stands: first calm frame; moves: last that was not calm */
    int body;  /* or -1 */
    /* The deciding quantity at that frame. Settles, moves: speed of the body that is farthest from rest, which includes
       its rotation; or the time that nothing has carried it. Creeps: distance in 10 falls. Falls: m lower, or degrees
       rotated; in a struck scene, falls, collapses: bodies; stands: the farthest that one has moved. Sinks:
       penetration. Tunnels: speed. Explodes: excess energy (`body` has the most kinetic energy). Non-finite, adapter
       failed: the highest speed before. */
    double value;
    const char *unit; /* "J", "m", "deg", "m/s", "s", "boxes" */
    int other;        /* tunnels: the body that was passed through; else -1 */
    VerdictCount count;
    bool struck;                      /* the verdict is what stands of a struck scene */
    bool moving;                      /* a body that started at rest, and has not left, is not at rest at the end */
    char reason[VERDICT_REASON_SIZE]; /* adapter failed: how; else empty */
    uint64_t state;                   /* set by verdict_run() only: FNV-1a of the bodies after the last step */
    /* Since VERDICT_CREEP_FROM falls; NaN if the run is not longer. m: largest distance moved by a body that existed
       then. J: energy gained. */
    double drift, gained;
    double deepest;      /* m: penetration of the deepest contact of all steps */
    double excess;       /* J: most energy above what the start and added bodies brought; >= 0; NaN if not judged */
    int steps;           /* set by verdict_run() only */
    Fallbacks fallbacks; /* of all steps that were observed */
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
    /* A struck scene: its bodies tell which started at rest; outlives the watch. NULL: all did, and the run is judged
       by the members above alone. */
    const Scene *struck;
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
   bomb, or else until the bomb touches something. With a bomb, or bodies that move, the scene is struck if there are
   others. It outlives the run. */
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
    double size;      /* m */
    Vec2 outside;     /* m: last position of the centre outside all static boxes; initially the start */
    Vec2 last, stood; /* m: in the last frame; before the step in which it landed, initially the start */
    float last_angle, stood_angle;
    bool stands;           /* dynamic, and started at rest; not the bomb, nor what it struck in the air */
    bool dropped, arrived; /* landed from far above; has come to rest since */
    int still;             /* consecutive frames at rest, and carried */
    bool touched,
        landed; /* has had a contact; and one that carries it, by bodies that have landed, from a static one on */
    bool held, carried; /* in this frame: by a contact from below; by contacts, from a static body on */
    int below;          /* the body that carried it last; -1: none so far */
    int air;            /* consecutive frames in which nothing carried it */
    double lower, sag;  /* m: than where it stood; of that, what contacts below it account for */
    int fell;           /* since this frame fallen, as by VERDICT_FALL_SHARE and VERDICT_FALL_ANGLE; 0: not */
    bool left;          /* has fallen below all static bodies */
    Vec2 rested;        /* m: after VERDICT_CREEP_FROM falls */
    int samples;
    Vec2 sample[VERDICT_CREEP_FALLS]; /* ring buffer, one position per fall */
} WatchedBody;

/* Static bodies never move. */
typedef struct WatchedStatic {
    int body;
    double cosine, sine; /* of its angle */
} WatchedStatic;

/* A pair of bodies that is deep in each other: the sides on which they were apart before (verdict_passes.c). */
typedef struct DeepPair {
    BodyPair pair;
    unsigned sides;
} DeepPair;

/* Which moving bodies pass through each other; the pairs that come near each other in a step. */
typedef struct PassFinder {
    SortAndSweep broad_phase;
    PairList near;
    Bounds *bounds; /* [bodies] */
    bool *fixed;    /* [bodies] */
    DeepPair *deep; /* [deep_count] by pair, then those of this frame */
    int deep_count;
    size_t bound_capacity, fixed_capacity, deep_capacity;
} PassFinder;

/* Zero-initialise; free with verdict_watch_free(); may be begun again. Internal to the checks
   (runs/runs_internal.h). */
typedef struct VerdictWatch {
    VerdictRun run;
    VerdictReading worst; /* so far, from creeps on */
    int frame;            /* the last */
    int body_count;
    WatchedBody *bodies;
    size_t capacity;
    WatchedStatic *statics; /* [static_count] ascending */
    int static_count;
    size_t static_capacity;
    double brought;    /* J: energy at the start and of added bodies; without a converged run, the bound (c) */
    double kept;       /* J: lowest of the energy peaks of all whole falls, plus the energy of added bodies */
    double peak;       /* J: highest energy in the current fall */
    EnergyBalance own; /* without a converged run */
    double energy;     /* J: in the last frame */
    double rounding;   /* J: most that the rounding of positions and velocities can have added */
    double smallest;   /* m: side of a dynamic body */
    double floor;      /* m: lowest height of a static body */
    double pull;       /* m/s^2: gravity, or what stands for it */
    double liveliest, highest, largest; /* of a dynamic body at the start, or when added: J/kg, m, m */
    int fall;                           /* steps of a fall; 0: no dynamic body so far */
    double rested;                      /* J: energy after VERDICT_CREEP_FROM falls */
    double kinetic;                     /* J: mean of the dynamic bodies */
    double speed;                       /* m/s: of the fastest body */
    int restless[2];  /* the body that is farthest from rest, in the last frame and in the last one that was not calm */
    double unrest[2]; /* its speed, m/s; 0: it hangs in the air */
    int calm, deep;   /* consecutive calm frames; consecutive frames with a deep contact */
    int peak_steps;   /* of the current fall */
    int rested_count; /* bodies after VERDICT_CREEP_FROM falls; 0 before */
    double deepest, excess; /* as in VerdictReading */
    Fallbacks fallbacks;
    ContactFinder finder; /* of a run that finds its contacts */
    PassFinder passes;
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

   Explodes, without a converged run: energy can only come from added bodies, so (c) is the energy at the start plus
   that of all added bodies. It exceeds (c) by more than VERDICT_ENERGY_SHARE, or (a) by more than VERDICT_REGAIN_SHARE,
   of the available energy, which includes the kinetic energy of the start and of added bodies. If bodies overlap at the
   start, (a) and (c) begin with the peak of the first second. Compared with the verdicts beside converged runs:
   tests/studies/test_verdict_alone.c.

   What gravity does in a step, m (g dt)^2 / 2, is no explosion, however little energy is available. Of another engine
   every bound is higher by it: Chipmunk moves bodies before it changes velocities, and so states both half a step
   apart.

   With a skin, boxes that a scene places side by side are pushed apart: each bound is higher by what lifts every body
   by two skins for each body that may be below it, its height over the smallest side.

   Tunnels: the centre of a dynamic body passed through a static box: the straight line from its last position outside
   all static boxes intersects one. Not if the centre is inside a box for a step and is pushed out again; if it stays
   inside, it sinks. Also finds bodies that leave the world through the ground, but not past its edge.

   Falls: a body stood where it was when it landed, so that gaps that a scene starts with may close; if it dropped from
   above, where it came to rest, or was when the bomb struck. What has not landed has not stood. Its sag is subtracted:
   the mean depth of the contact from below, and the sag of the body there, the most if there are several. A contact is
   from below if its normal is nearer to gravity than to the horizontal. A column that leans gets no sag, and falls. A
   pile that gives way without end sinks. */
bool verdict_watch_step(VerdictWatch *watch, const VerdictStep *step, Error *error);

/* The same for a world; a StepObserver callback. */
bool verdict_watch_observe(void *watch, int frame, const World *world, Error *error);

/* The method failed (MethodFailure) in the step to `frame`. Later steps are ignored. */
void verdict_watch_failed(VerdictWatch *watch, int frame, const Error *failure);

/* True if the run can be stopped: it explodes, is non-finite, or its adapter failed. */
bool verdict_watch_is_final(const VerdictWatch *watch);

/* The verdict on the run up to the last step. A run shorter than VERDICT_CALM_FALLS cannot settle. */
VerdictReading verdict_watch_end(const VerdictWatch *watch);

/* Runs the scene with the method, whose skin counts, until the verdict is final. A method that fails is a verdict, not
   an error. False with error set if the method cannot be created, the launch is refused, too many bodies are near each
   other, or memory is short. */
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

/* After the run; failure: why it failed, if it did. False if there is no verdict: it was not the method that failed. */
bool simulate_verdict_end(SimulateVerdict *verdict, const Error *failure);
void simulate_verdict_free(SimulateVerdict *verdict);

/* After simulate_verdict_end(): "falls at 4.22 s (body 7, 0.53 m lower)"; of a struck scene, what stands: "collapses: 8
   of 10 boxes fell, first at 1.2 s", "stands; 1 of 10 moved by 0.3 m". They go with a stored run, so they also say what
   makes it no yardstick: "; 175 steps did not converge". */
void simulate_verdict_words(const SimulateVerdict *verdict, char words[TRAJECTORY_VERDICT_SIZE]);

/* s: so many falls of the run, VERDICT_CREEP_FROM for instance. */
double simulate_verdict_falls(const SimulateVerdict *verdict, double falls);

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
