/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The states and helpers of contact solvers that others share or train. */
#pragma once
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "methods/pair.h"
#include "methods/relation_view.h"
#include "methods/sweeps.h"
#include "methods/tabulation.h"
#include "nets/kinds.h"
#include "nets/nets.h"

#include <stdbool.h>
#include <stddef.h>

/* The networks of sain (methods/sain.c). A relation network answers each row of a view with effects; the effects of a
   receiver's rows are added; an object network answers its own state and the sum with its outputs. Here the first has
   two hidden layers of 32 units and 16 effects, the second one of 32. The interaction network of Battaglia et al.
   (2016) has four of 150 and 50 effects, and one of 100; a reimplementation of Ajay et al. (2019) has 128, 64, 32 and
   16. */

enum {
    RELATION_VERSION = 1,
    RELATION_EFFECTS = 16,
    RELATION_HIDDEN = 32,
    RELATION_OBJECT_INPUTS = RELATION_BODY_INPUTS + RELATION_EFFECTS,
    RELATION_COMMAND_SIZE = 512,
    RELATION_ANSWER_MAX = 100 /* times the scale: larger corrections are not trained */
};

/* The networks of one form. */
typedef struct RelationNetwork {
    Network *relation; /* RELATION_PAIR_INPUTS to RELATION_EFFECTS */
    Network *object;   /* body inputs, then the sum of effects, to RELATION_OUTPUTS */
    /* Ranges of the training data; outputs beyond +-limit are discarded. */
    float pair_low[RELATION_PAIR_INPUTS], pair_high[RELATION_PAIR_INPUTS];
    float body_low[RELATION_BODY_INPUTS], body_high[RELATION_BODY_INPUTS];
    float limit[RELATION_OUTPUTS];
} RelationNetwork;

/* A file holds the networks of all forms. */
typedef struct RelationNetworks {
    RelationNetwork forms[RELATION_FORMS];
    char command[RELATION_COMMAND_SIZE]; /* that trained them */
} RelationNetworks;

/* Weights and ranges 0. False with error set when memory is short; destroy it in any case. */
bool relation_network_create(RelationNetwork *network, Error *error);
void relation_network_destroy(RelationNetwork *network);

bool relation_networks_write(const RelationNetworks *networks, const char *path, Error *error);

/* False with error set, and nothing to be destroyed: not such a file, of other widths, or a number that is NaN,
   infinite or out of range. */
bool relation_networks_read(RelationNetworks *networks, const char *path, Error *error);
void relation_networks_destroy(RelationNetworks *networks);

/* Answers to a view. Zero-initialise, free with relation_answers_free. */
typedef struct RelationAnswers {
    float *outputs; /* [body_count, RELATION_OUTPUTS] */
    bool *known;    /* [body_count] all inputs of the body and its rows are within the ranges of the training data */
    float *effects, *inputs, *columns, *scratch;
    ArrayBlock arrays;
} RelationAnswers;

void relation_answers_free(RelationAnswers *answers);

/* clamp: inputs beyond the ranges are moved to their ends. False when memory is short. */
bool relation_answer(RelationAnswers *answers, const RelationNetwork *network, RelationView *view, bool clamp);

/* The method sain with a network in memory, for training. */

/* The networks remain the caller's and must outlive the solver. False with error set when memory is short. */
bool sain_make(ContactSolver *solver, const RelationNetwork *network, RelationForm form, Error *error);

/* The stopping rule of the iterative methods: after the first k sweeps, blocks of 8 follow while the residual is at least
   `near`, up to `more` sweeps. Most steps need few sweeps and an impact needs many, so the rule spends them where they
   are needed. Fails where the residual is small and the error is not: an error that is spread over a whole stack leaves
   each contact close to its target. */

enum {
    STOPPING_BLOCK = 8, /* sweeps; the residual is read before each block */
    STOPPING_MORE = 48  /* the default of `more` */
};

/* `more` 0: none follow the first k. */
typedef struct StoppingRule {
    int k;      /* sweeps */
    float near; /* m/s, RMS over the contacts */
    int more;   /* a multiple of STOPPING_BLOCK */
} StoppingRule;

/* The rule's settings, for the table of a method whose state begins with its rule. sweeps: what it counts, "sweeps". */
#define SWEEPS_SETTING                                                            \
    {                                                                             \
        "k", "sweeps over all contacts per step (default: the scene's, else 10)", \
            SETTING_INT(StoppingRule, k, 1, SWEEPS_MAX)                           \
    }
#define STOPPING_SETTINGS(sweeps)                                                                                      \
    {"near", sweeps " go on while contacts miss their velocity by this, m/s (after k, in blocks of 8; default: none)", \
     SETTING_OWN},                                                                                                     \
    {                                                                                                                  \
        "more", sweeps " that near may add (rounded up to whole blocks; default: 48)", SETTING_OWN                     \
    }

/* Overwrites the rule, which has the method's defaults, with `near` and `more`. ERROR_INPUT for a value out of range, and
   for `more` where no rule is. */
bool stopping_read(StoppingRule *rule, const Settings *chosen, Error *error);

/* settings_make() and stopping_read() for a state that begins with its rule. */
void *stopping_make(const Settings *chosen, const SettingSpec *known, const void *standard, size_t size,
                    const char *what, Error *error);

/* True if another block must follow the first k sweeps and `done` more. */
bool stopping_needs_more(const StoppingRule *rule, int done, const Sweeps *sweeps, const ContactProblem *problem);

/* The same for a scalar reference implementation. */
bool stopping_needs_more_scalar(const StoppingRule *rule, int done, const ContactProblem *problem,
                                const ContactSolution *solution);

/* Sweeps with momentum (momentum.c): a scalar reference implementation, and the fast one of the solvers, which visits
   contacts in the order of colours (methods/sweeps.h). The solvers choose the factors. */

/* Scalar reference implementation: `count` sweeps over the contacts visits[contact_count]; before each sweep s > 0 the
   extrapolation by factors[s] >= 0. `before`: work space, a solution of the same size. sweeps_run_momentum gives the
   same bits. */
void momentum_solve_scalar(const ContactProblem *problem, const int32_t *visits, const float *factors, int count,
                           ContactSolution *before, ContactSolution *solution);

/* The hand-tuned factor before sweep s of `count`, counted from 0: s / (s + 1.4), at most 1 - 7 / (15 + count). The
   limit is lower for few sweeps, as they have no time to correct the overshoot of a large factor. Tuned on launches of
   the stack and the pyramids together. */
float momentum_factor_tuned(int sweep, int count);

/* The hand-tuned factors of `count` sweeps; the caller frees them. NULL when memory is short. */
float *momentum_factors_make(int count);

typedef struct MomentumIsland MomentumIsland;

/* Zero-initialise; arrays grow and are reused. */
typedef struct Momentum {
    Sweeps sweeps;
    StoppingRule rule;   /* its k does not count */
    float *more_factors; /* [rule.more] */
    const ContactProblem *problem;
    bool watched;            /* its islands have courses */
    bool refreshes;          /* the run computes velocities anew after each block: long ones */
    MomentumIsland *courses; /* [sweeps.groups] */
    bool *chosen;            /* [sweeps.groups] */
    float *of_pairs;         /* [sweeps.pair_count] what was last measured */
    float *factors;          /* [sweeps of a block, sweeps.groups] */
    ArrayBlock arrays;
} Momentum;

void momentum_free(Momentum *momentum);

/* momentum->sweeps have begun with this problem, which must stay until the end. False when memory is short. */
bool momentum_begin(Momentum *momentum, const ContactProblem *problem);

/* `count` sweeps with factors[count]. Of 32 or more, each island's residual is not above the least of those that 16, 32, ... of
   them left; where contacts slide so that visits overshoot, of 16 or more, that 8, 16, ... of them left. False when memory is
   short. */
bool momentum_run(Momentum *momentum, const float *factors, int count);

/* Sweeps by the rule after those before; factors[rule->more]. The remaining error has long waves, such as a heavy bomb
   on a whole stack, which need momentum with large factors: so this is one run of sweeps with momentum, not many short
   ones. Where it ends by rule->more, no island's residual is above the least, before or on the way. False when memory is
   short. */
bool momentum_run_more(Momentum *momentum, const StoppingRule *rule, const float *factors);

/* Stores the solution; that of the warm start if it is NaN or infinite. False when memory is short. */
bool momentum_end(Momentum *momentum, ContactSolution *solution);

/* All of these, from the warm start, with the momentum's rule. */
bool momentum_solve(Momentum *momentum, const ContactProblem *problem, const float *factors, int count,
                    ContactSolution *solution, Error *error);

/* The method hybrid with a memory that its caller fills, for learning. */

/* A step that asked the memory. */
typedef struct HybridStep {
    const ContactProblem *problem;
    const ContactSolution *solution;
    TabulationQuery query; /* key NULL if there is no memory */
    const float *bomb;     /* [6] its numbers */
    const float *others;   /* [6 (body_count - 1)] the numbers of the bodies but the bomb */
    int entry;             /* that answered, or -1: solved to convergence */
} HybridStep;

/* Called after each such step; false with error set stops the step. */
typedef struct HybridWatch {
    bool (*see)(void *context, const HybridStep *step, Error *error);
    void *context;
} HybridWatch;

/* m/s: the gate, RMS residual of the warm start, where no memory sets it. As in scene-net: below it at rest, above during a
   shock. */
extern const float hybrid_gate;

/* memory: the caller's, or NULL: no step is answered. It must outlive the solver, and may grow between launches. watch: or
   NULL. */
bool hybrid_make(ContactSolver *solver, const Tabulation *memory, const HybridWatch *watch, Error *error);

/* The answer of an entry: impulses clamped to their friction cones, and the velocities that follow; adds to
   fallbacks.outside_cone. The problem has the entry's contacts. */
void hybrid_answer(const Tabulation *memory, int entry, const float *key, const ContactProblem *problem,
                   ContactSolution *solution);

/* A network trained on pairs (learning/pair_training.h), ready to predict: its inputs, its outputs and what they mean. */

/* Zero-initialise. */
typedef struct PairNetwork {
    Network *network;
    PairView view;
    PairTarget target;
    bool constant; /* predict the mean of the training data, whatever the inputs */
    /* Work space; grows and is reused: */
    float *scratch; /* of a prediction */
    float *numbers; /* inputs[inputs, pairs], then outputs[outputs, pairs], of the step's pairs */
    size_t capacity;
    PairMoment moment; /* needed by views by contact */
} PairNetwork;

/* Number of outputs per pair. */
static inline int pair_network_outputs(const PairNetwork *pair) { return pair->network->widths[pair->network->layers]; }

/* ERROR_INPUT, with the file, if it is not a network or its inputs, outputs and target do not fit each other; the
   message states what it has and what is needed. */
bool pair_network_read(PairNetwork *pair, const char *path, Error *error);
void pair_network_free(PairNetwork *pair);

/* outputs[outputs, pairs] for all pairs of the step, in their order, from the velocities before the warm start or, for
   views by contact, after it. Not for TARGET_IMPULSE. Valid until the next call. NULL: no memory. */
const float *pair_network_predict(PairNetwork *pair, const ContactProblem *problem, int *pairs);

/* outputs[outputs] for the pair whose contacts begin at `first`, at any moment of the step (pair_inputs). */
void pair_network_predict_one(PairNetwork *pair, const ContactProblem *problem, const PairMoment *now, int first,
                              float *outputs);

/* The common part of pair-net and contact-net, which accept different networks. */

typedef struct PairSolver {
    PairNetwork network;
    int sweep_count;  /* for TARGET_IMPULSE */
    bool predicts;    /* false: the mean of its training data */
    int *pair_counts; /* [body_count] number of pairs of each body */
    size_t count_capacity;
} PairSolver;

#define PAIR_SOLVER_SWEEPS                                                                             \
    {                                                                                                  \
        "k", "sweeps over all pairs per step, for the target impulse (default: the scene's, else 10)", \
            SETTING_INT(PairSolver, sweep_count, 1, SWEEPS_MAX)                                        \
    }
#define PAIR_SOLVER_NET                                                                           \
    {                                                                                             \
        "net", "on|off: off predicts the mean of the training data for every pair (default: on)", \
            SETTING_BOOL(PairSolver, predicts)                                                    \
    }

/* Reads the network and the settings of the table. NULL with error set if one is refused. name: of the method. */
PairSolver *pair_solver_create(const char *name, const SettingSpec *known, const Settings *chosen, Error *error);
void pair_solver_destroy(void *state);

/* Solves the step with the network, as its target requires. */
bool pair_solver_solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error);

/* The residual of the impulses in a set of sweeps: how far contacts are from their target velocities. After the warm
   start it is near zero while boxes rest, and metres per second while a shock travels through them; so it tells whether
   a step is worth a network. After sweeps it tells whether they have converged. */

/* True if the root mean square over the contacts of (bias - normal velocity) is at least `limit` (m/s). Separating
   contacts without an impulse do not count as error. */
bool residual_reaches(const Sweeps *sweeps, int contact_count, float limit);

/* The same of a solution. Where the sweeps visit contacts in the problem's order, with the same answer. */
bool residual_reaches_scalar(const ContactProblem *problem, const ContactSolution *solution, float limit);

/* True if the root mean square over the contacts of what one more visit would change, normal and tangent velocity, is at
   least `limit` (m/s), or NaN. This is the residual of methods/interior_point_internal.h. */
bool residual_of_visits_reaches(const Sweeps *sweeps, int contact_count, float limit);

/* (m/s)^2, summed over the contacts of a pair of the sweeps: what one more visit would change (see
   residual_of_visits_reaches()), and the normal velocity that the impulses hold. */
typedef struct PairResidual {
    float visit, held;
} PairResidual;

PairResidual residual_of_pair(const Sweeps *sweeps, int pair);

/* squared[pair_count]: `visit` of each pair; NaN if a velocity of its bodies is NaN or infinite. By the sweeps' kernel. */
void residual_of_pairs(const Sweeps *sweeps, float *squared);

/* overshoot[pair_count]: the share of a contact's error by which a visit carries its normal velocity past the aim, because it
   slides, or is new and will slide: mu |knt| / knn, where the friction acts against the normal velocity; the larger of the
   pair's points, else 0. knn: what a normal impulse changes the normal velocity by, 1 / mass_normal; knt: what an impulse
   along the tangent does. For boxes |knt| / knn is at most sqrt(3) / 2, as no point is further from the centre than a corner. */
void overshoot_of_pairs(const Sweeps *sweeps, float *overshoot);

/* (m/s)^2: how the bodies of a contact move relative to each other there without any impulse, in any direction; or NaN. A
   step of gravity makes 0.17 m/s at rest, whatever the masses. */
float residual_of_motion(const ContactProblem *problem, int contact);

/* A contact problem as the inputs of a slot network (nets/kinds.h). A bomb rotated by a quarter turn is the
   same box with its edges renamed. So the view rotates it back to within an eighth of a turn (a quarter if it is
   oblong), and renames the features of its contacts. Otherwise the network would have to learn each quarter turn
   separately. */

/* Zero-initialise; arrays grow and are reused. */
typedef struct SceneView {
    SlotView slots;
    int32_t *contacts;    /* [slots.slot_count] the contact of each slot */
    ContactImpulse *base; /* [contact_count] impulses without the network: the warm start, for contacts with a slot
                             up to its cap and inside the cone */
    /* The arrays that `slots` points to: */
    float bomb[SLOT_BODY_NUMBERS], *state, *ones, *warm;
    int32_t *present, *impulses;
    ArrayBlock arrays;
} SceneView;

void scene_view_free(SceneView *view);

/* The feature of one of the problem's contacts, with the bomb rotated back. */
uint32_t scene_view_feature(const ContactProblem *problem, const ContactPoint *contact);

/* rad: the angle of a body, turned back by quarter turns (half turns if it is oblong) to the smallest. */
float scene_view_angle(const ProblemBody *body);

/* The problem must have the network's bodies. False when memory is short. */
bool scene_view_take(SceneView *view, const SlotNetwork *network, const ContactProblem *problem);

/* The method interior: the most work that the last step took for an island, in sweeps over its contacts, by a count of what was
   done. At most INTERIOR_MOST_WORK, 100 times the engine's ten sweeps; or that OF_MANY, 20 times, where more than 128 bodies move.
   With 200 for all, half of the impacts on walls and pyramids of a hundred boxes end worse than momentum in the same time. */
enum { INTERIOR_MOST_WORK = 1000, INTERIOR_MOST_WORK_OF_MANY = 200 };
double interior_work_done(const void *state);

/* The method scene-net with a network in memory, for training. */

/* The network remains the caller's and must outlive the solver. near: the setting, m/s. */
bool scene_net_make(ContactSolver *solver, const SlotNetwork *network, float near, Error *error);
