/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Methods: the list of all, what describes one, the interfaces of contact solvers and steppers, and how a scene is
   stepped:

       Method method;
       Stepper *stepper = method_parse(&method, "engine:k=20", error) ? stepper_create(&method, scene, error) : NULL;
       stepper_step(stepper, world, &(Step){.scene = scene, .frame = 1}, error);
*/
#pragma once
#include "base/base.h"
#include "base/settings.h"
#include "engine/engine.h"
#include "scenes/scenes.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What lists, charts, studies and captions know of a method. A field left zero has a sensible default: a name and a
   summary are enough. */

/* What a method's results are compared for. */
typedef enum MethodRole {
    METHOD_COMPETES, /* for speed and accuracy */
    METHOD_BASELINE, /* solves nothing; other methods must be more accurate */
    METHOD_REFERENCE /* the converged solution: errors of other methods are measured against it */
} MethodRole;

/* Settings that a study runs a method with, each as on the command line ("k=10,warm=off"; "": none given), ended by
   NULL. */
typedef const char *const *MethodRuns;

#define METHOD_RUNS(...) ((const char *const[]){__VA_ARGS__, NULL})
#define METHOD_NO_RUNS ((const char *const[]){NULL})

typedef struct MethodDescription {
    const char *name, *summary;  /* as on the command line; one line for `twinbox methods` */
    const SettingSpec *settings; /* ended by a NULL key; NULL: the method has none */
    const char *caption;         /* in frames, after the method's text: "sequential impulses"; NULL: nothing */
    MethodRole role;
    bool no_push_out;   /* it moves overlapping bodies apart without giving them a velocity; so the converged velocities
                            that it is scored against have none of position correction either */
    bool no_contacts;   /* it moves bodies without contacts: collision detection in its step serves measurement and
                            pictures only, so that its time is that of solve(), not the whole step's */
    bool lite_contacts; /* without `keep` its contacts are Box2D-Lite's, bit for bit; so are those of needs_network,
                            which learned from them; other methods mend them (ContactRules) */
    bool falls_back;    /* sweeps may solve a step instead; results report how often, as for networks */
    bool external;      /* a program of others, which the text names behind ':'; its time is what it reports */
    bool whole_scenes;  /* it runs scenes from their start, with contacts of its own: no single steps, no impulses */
    bool needs_network; /* learned: the setting `network` or the scene names its file; hybrid also runs without */
    const char *twin;   /* of a learned method: its ablation, as on the command line ("sain:net=off"); it takes the same
                            settings otherwise. NULL: nothing is learned */
    const char *own_settings; /* those that hold where none are given, "k=10"; NULL: k is the scene's iterations */
    bool baseline;            /* charts mark its run with the scene's own settings, and compare the others with it */
    const char *converges;    /* settings with which it finds the converged solution, as a test checks; NULL: none do */
    /* What `twinbox chart`, `twinbox chart --quick` and `twinbox stability` run by default. NULL: one run, no settings
       given. METHOD_NO_RUNS: left out unless named, and reported as left out. */
    MethodRuns chart, chart_quick, stability;
    int stability_place; /* 1, 2, ...: place in the stability study; 0: behind those that have one, in registry order */
} MethodDescription;

/* The interface that every contact solver implements: a constant struct of functions, listed once below. */

typedef struct ContactSolverKind {
    MethodDescription description;
    /* Returns the solver's own state, NULL with error set if a setting is refused. */
    void *(*create)(const Settings *settings, Error *error);
    ContactSolve *solve;
    void (*destroy)(void *state);
    /* Of an external method: ns that the last solve took, as it says, 0 if unknown; else NULL. */
    int64_t (*reported)(const void *state);
} ContactSolverKind;

/* A solver in use. */
typedef struct ContactSolver {
    const ContactSolverKind *kind;
    void *state;
} ContactSolver;

/* The list of methods, in the order of lists and charts. To add one, write one file in this folder that defines
   solver_NAME, and add one line here, at the end. SOLVER(x, where) is solver_x; STEPPING(x, where) is stepping_x, for
   methods that need more than one solver call in a step. where:

       LIVE          pages can run it (live/live.h), too
       LIVE_NETWORK  so can pages that have networks
       NOT_LIVE      pages cannot: it needs programs or files */
#define METHODS(SOLVER, STEPPING)     \
    SOLVER(engine, LIVE)              \
    SOLVER(momentum, LIVE)            \
    SOLVER(nncg, LIVE)                \
    SOLVER(pair_net, LIVE_NETWORK)    \
    SOLVER(contact_net, LIVE_NETWORK) \
    SOLVER(scene_net, LIVE_NETWORK)   \
    STEPPING(playback, NOT_LIVE)      \
    SOLVER(reference, LIVE)           \
    STEPPING(soft_step, LIVE)         \
    STEPPING(avbd, LIVE)              \
    SOLVER(interior, LIVE)            \
    SOLVER(sain, LIVE_NETWORK)        \
    SOLVER(hybrid, LIVE_NETWORK)      \
    STEPPING(gns, LIVE_NETWORK)       \
    STEPPING(subspace, LIVE_NETWORK)  \
    STEPPING(exec, NOT_LIVE)          \
    SOLVER(closed_form, LIVE)         \
    SOLVER(admm, LIVE)                \
    SOLVER(exec_solver, NOT_LIVE)

#define METHOD_OMITTED(name, where)
#define SOLVER_DECLARED(name, where) extern const ContactSolverKind solver_##name;
METHODS(SOLVER_DECLARED, METHOD_OMITTED)
#undef SOLVER_DECLARED

/* Steppers: methods that need more than one solver call per step, or none. */

/* Measures the cost of the solver in a step. */
typedef struct StepMeter {
    int64_t (*now)(void); /* current count: time, instructions, ... */
    int64_t solving;      /* out: the count between contact problem and solution */
    int64_t reported;     /* out, of an external method: ns that its engine says it took; 0: unknown */
} StepMeter;

/* The step that a method takes. */
typedef struct Step {
    const Scene *scene; /* with the launch of the run */
    int frame;          /* number of the step, 1 .. frames */
    bool engine_step;   /* with the engine's contacts, so that all methods solve the same problem */
    StepMeter *meter;   /* or NULL */
} Step;

static inline void step_solving_begins(const Step *step) {
    if (step->meter != NULL) step->meter->solving = -step->meter->now();
}

static inline void step_solving_ends(const Step *step) {
    if (step->meter != NULL) step->meter->solving += step->meter->now();
}

/* A step after collision detection and before motion. */
typedef struct BegunStep {
    const World *world;
    const Step *step;
    const ContactProblem *problem;
    ContactSolution *solution; /* to be filled */
    const BodyPose *poses;     /* out: [body_count] where the bodies end; NULL: where their velocities lead */
} BegunStep;

/* What a stepper carries from a step to the next one, besides the world (methods/steppers.h). */
typedef struct StepMemory StepMemory;

typedef struct SteppingKind {
    MethodDescription description;
    /* Returns the state for a scene with any launch; NULL with error set if the scene or a setting is refused. */
    void *(*create)(const Settings *settings, const Scene *scene, Error *error);
    /* Solves the step; this is what a meter measures. Allocates nothing once it has seen a problem of that size. */
    bool (*solve)(void *state, BegunStep *begun, Error *error);
    void (*measure)(void *state, const BegunStep *begun); /* momentum_error of the solution; NULL: it is 0 */
    void (*keep)(void *state, const World *world);        /* notes what the next step begins with; NULL: nothing */
    StepMemory *(*memory)(void *state);                   /* kept here, and copied by stepper_remember(); NULL: none */
    void (*destroy)(void *state);
} SteppingKind;

/* Advances the world by one step of the scene; on failure the world is unchanged. */
bool stepping_step(const SteppingKind *kind, void *state, World *world, const Step *step, Error *error);

#define STEPPING_DECLARED(name, where) extern const SteppingKind stepping_##name;
METHODS(METHOD_OMITTED, STEPPING_DECLARED)
#undef STEPPING_DECLARED

/* A method: how a scene is advanced by one step. Most methods are a contact solver in the standard step; the others are
   steppers. */

enum { METHOD_TEXT_SIZE = 128 };

/* An entry of the registry. */
typedef struct MethodKind {
    const MethodDescription *description;
    const ContactSolverKind *solver; /* used in the standard step; or NULL */
    const SteppingKind *stepping;    /* if solver is NULL */
} MethodKind;

/* The registry, in the order of lists and charts; ended by a NULL description. */
extern const MethodKind method_kinds[];

/* An entry for each line of the list METHODS. */
#define METHOD_KIND_SOLVER(name, where) {&solver_##name.description, &solver_##name, NULL},
#define METHOD_KIND_STEPPING(name, where) {&stepping_##name.description, NULL, &stepping_##name},

/* The description of the method in `name` or `name:key=value,...`; NULL if there is no method of that name. */
const MethodDescription *method_describe(const char *text);

/* The settings of `name:key=value,...`, and what holds where it gives none: k of the scene, whose iterations are 0 if
   they are unknown, or the method's own. False for a text that is no method. */
bool method_all_settings(Settings *settings, const char *text, int iterations);

typedef struct Method {
    char text[METHOD_TEXT_SIZE]; /* as given: "engine:k=20" */
    const MethodKind *kind;
    Settings settings;
} Method;

/* Parses `name` or `name:key=value,...`. ERROR_INPUT: an unknown name or key, with the known ones. */
bool method_parse(Method *method, const char *text, Error *error);

/* The method of that name with a network; the path may contain any character. ERROR_INPUT: unknown method, or the path
   is too long. */
bool method_with_network(Method *method, const char *name, const char *path, Error *error);

/* Creates the contact solver of a method for a scene. The scene sets what the settings leave open: sweeps, accumulated
   impulses, the network. ERROR_INPUT if the method has no contact solver. */
bool method_create_solver(const Method *method, const Scene *scene, ContactSolver *solver, Error *error);

/* True if the method needs a network and neither its settings nor the scene name one. */
bool method_lacks_network(const Method *method, const Scene *scene);

/* The file in the setting `network`, else the scene's for the method of that name (scene: may be NULL); NULL with error
   set. */
const char *method_network(const Settings *settings, const Scene *scene, const char *name, Error *error);

/* For the table of a method in whose step contacts may be kept (ContactRules); stepper_create() reads it. `...`:
   SETTING_OWN, or a member of the method's own. */
#define KEEP_SETTING(...) \
    { "keep", "shift up to which a contact keeps its lever arms, of the smaller side (default: 0)", __VA_ARGS__ }

/* A method in use. It steps worlds of one scene, with any launch, one world after the other. */
typedef struct Stepper Stepper;

Stepper *stepper_create(const Method *method, const Scene *scene, Error *error);

/* Of a solver in memory, which is destroyed with it, or at once where memory is short. */
Stepper *stepper_of_solver(const ContactSolver *solver, Error *error);
void stepper_destroy(Stepper *stepper);

/* What the stepper carries besides the world, copied from it and back, so that several runs go on from one step before
   the bomb. *memory: zero-initialise; free with step_memory_free(). Not of external methods, whose runs begin at the
   start. */
bool stepper_remember(const Stepper *stepper, StepMemory *memory, Error *error);
bool stepper_recall(Stepper *stepper, const StepMemory *memory, Error *error);

/* The description of its method. */
const MethodDescription *stepper_describe(const Stepper *stepper);

/* False if the contacts in its steps are Box2D-Lite's (lite_contacts). */
bool stepper_mends(const Stepper *stepper);

/* Advances the world by the scene's dt; on failure the world is unchanged. Its contacts are mended if stepper_mends(),
   unless the step is the engine's. Afterwards world_problem() and world_solution() are those of the step. */
bool stepper_step(Stepper *stepper, World *world, const Step *step, Error *error);
