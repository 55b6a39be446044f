/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Methods: what describes one, the interface of contact solvers and of steppers, the list of all, and how a scene is
   stepped. */
#pragma once
#include "base/base.h"
#include "engine/engine.h"
#include "scenes/scenes.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What lists, charts, studies and captions know of a method. A field left zero has a sensible default: a name and a
   summary are enough to begin with; pictures/colours also wants a caption, and a colour in pictures/colours.c. */

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
    bool needs_network; /* runs only if the setting `network` or the scene names a file */
    const char *twin;   /* of a learned method: its ablation, as on the command line ("sain:net=off"); it takes the same
                            settings otherwise. NULL: nothing is learned */
    const char *own_settings; /* those that hold where none are given, "k=10"; NULL: k is the scene's iterations */
    const char *shipped;      /* the setting in common use, which charts mark; NULL: none */
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

/* The list of methods. To add a contact solver, write one file in this folder that defines solver_NAME, and add one
   line SOLVER(NAME) here. */

/* In the order of lists and charts. SOLVER(x) is solver_x; STEPPING(x) is stepping_x, for methods that need more than
   one solver call in a step. New methods go to the end. */
#define METHODS(SOLVER, STEPPING) \
    SOLVER(engine)                \
    SOLVER(momentum)              \
    SOLVER(nncg)                  \
    STEPPING(substepping)         \
    SOLVER(pair_net)              \
    SOLVER(contact_net)           \
    SOLVER(scene_net)             \
    STEPPING(playback)            \
    SOLVER(reference)             \
    STEPPING(soft_step)           \
    STEPPING(avbd)                \
    SOLVER(interior)              \
    SOLVER(sain)                  \
    SOLVER(hybrid)                \
    STEPPING(gns)                 \
    STEPPING(subspace)            \
    STEPPING(exec)                \
    SOLVER(closed_form)           \
    SOLVER(admm)                  \
    SOLVER(exec_solver)

#define METHOD_OMITTED(name)
#define SOLVER_DECLARED(name) extern const ContactSolverKind solver_##name;
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
    bool engine_step;   /* of the engine's run: with its contacts, so that all methods solve the same problem */
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

typedef struct SteppingKind {
    MethodDescription description;
    /* Returns the state for a scene with any launch; NULL with error set if the scene or a setting is refused. */
    void *(*create)(const Settings *settings, const Scene *scene, Error *error);
    /* Solves the step; this is what a meter measures. Allocates nothing once it has seen a problem of that size. */
    bool (*solve)(void *state, BegunStep *begun, Error *error);
    void (*measure)(void *state, const BegunStep *begun); /* momentum_error of the solution; NULL: it is 0 */
    void (*keep)(void *state, const World *world);        /* what the next step begins with; NULL: nothing */
    void (*destroy)(void *state);
} SteppingKind;

/* Advances the world by one step of the scene; on failure the world is unchanged. */
bool stepping_step(const SteppingKind *kind, void *state, World *world, const Step *step, Error *error);

#define STEPPING_DECLARED(name) extern const SteppingKind stepping_##name;
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
#define METHOD_KIND_SOLVER(name) {&solver_##name.description, &solver_##name, NULL},
#define METHOD_KIND_STEPPING(name) {&stepping_##name.description, NULL, &stepping_##name},

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

/* Programs of the methods `exec` and `exec-solver`. Files may name methods, too: of runs that are to be repeated, of
   tables. So only a program is started that an option for methods names, "exec:PROGRAM", alone or in a list; the text
   must outlive the methods. Without a call, none is. */
void programs_allow(const char *methods);

enum { PROGRAM_NAME_SIZE = 48 };

/* What a program says that it is. */
typedef struct ProgramName {
    char name[PROGRAM_NAME_SIZE], version[PROGRAM_NAME_SIZE];
} ProgramName;

/* The first failure of a program in this process; NULL: none. For studies, in which it only ends a run. */
const char *programs_failure(void);

/* False for methods that are no program, or one that has not run yet. */
bool method_program(const Method *method, ProgramName *name);

/* For the table of a method in whose step contacts may be kept (ContactRules); stepper_create() reads it. `...`:
   SETTING_OWN, or a member of the method's own. */
#define KEEP_SETTING(...) \
    { "keep", "shift up to which a contact keeps its lever arms, of the smaller side (default: 0)", __VA_ARGS__ }

/* A method in use. It steps worlds of one scene, with any launch, one world after the other. */
typedef struct Stepper Stepper;

Stepper *stepper_create(const Method *method, const Scene *scene, Error *error);
void stepper_destroy(Stepper *stepper);

/* The description of its method. */
const MethodDescription *stepper_describe(const Stepper *stepper);

/* Advances the world by the scene's dt; on failure the world is unchanged. Its contacts are mended, unless the method
   has Box2D-Lite's (lite_contacts) or the step is the engine's. Afterwards world_problem() and world_solution() are
   those of the step. */
bool stepper_step(Stepper *stepper, World *world, const Step *step, Error *error);

/* How methods are named in all pictures: captions, legends, charts and figures. Their colours: pictures/colours.h.

   The name is the method's text as on the command line ("momentum:k=20"), without the folders of its files. */

/* Copies a method's text without the folders of its files, which differ between machines. Returns its length. */
size_t method_name(char *name, size_t size, const char *text);

/* The name of run `index` of a picture whose runs have these methods: without the file of its network, unless another
   of them has the same settings but for this file. */
size_t method_name_among(char *name, size_t size, const char *const *methods, int count, int index);

/* Length of the part of a name before its settings. */
size_t method_name_head(const char *name);
