/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The engine: plane vectors, boxes, manifolds, broad phase, bodies, the contact problem and the step of a world. It
   knows no file and no method; of the bomb, only which body it is. */
#pragma once
#include "base/base.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Plane vectors and rotations in float32. The order of every operation here is part of the engine's result:
   the trajectories are compared bit by bit. */

typedef struct Vec2 {
    float x, y;
} Vec2;

/* Column-major 2 x 2 matrix: a rotation has columns (c, s) and (-s, c). */
typedef struct Mat22 {
    Vec2 column1, column2;
} Mat22;

static inline Vec2 vec2(float x, float y) { return (Vec2){x, y}; }
static inline Vec2 vec2_add(Vec2 a, Vec2 b) { return vec2(a.x + b.x, a.y + b.y); }
static inline Vec2 vec2_sub(Vec2 a, Vec2 b) { return vec2(a.x - b.x, a.y - b.y); }
static inline Vec2 vec2_scale(float s, Vec2 v) { return vec2(s * v.x, s * v.y); }
static inline Vec2 vec2_negate(Vec2 v) { return vec2(-v.x, -v.y); }
static inline Vec2 vec2_abs(Vec2 v) { return vec2(fabsf(v.x), fabsf(v.y)); }
static inline float vec2_dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }

/* z component of a x b. */
static inline float vec2_cross(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }

/* v x (s out of the plane): for a unit normal and s = 1 the tangent, a quarter turn clockwise. */
static inline Vec2 vec2_cross_scalar(Vec2 v, float s) { return vec2(s * v.y, -s * v.x); }

/* Not hypot: square roots are the same on every machine, and squares of floats do not overflow a double. */
static inline double vec2_distance(Vec2 a, Vec2 b) {
    const double x = (double)a.x - (double)b.x, y = (double)a.y - (double)b.y;
    return sqrt(x * x + y * y);
}

/* (s out of the plane) x v: the velocity that spin s gives to a point at lever arm v. */
static inline Vec2 scalar_cross_vec2(float s, Vec2 v) { return vec2(-s * v.y, s * v.x); }

static inline Vec2 mat22_multiply(Mat22 m, Vec2 v) {
    return vec2(m.column1.x * v.x + m.column2.x * v.y, m.column1.y * v.x + m.column2.y * v.y);
}

static inline Mat22 mat22_transpose(Mat22 m) {
    return (Mat22){vec2(m.column1.x, m.column2.x), vec2(m.column1.y, m.column2.y)};
}

/* a * b */
static inline Mat22 mat22_product(Mat22 a, Mat22 b) {
    return (Mat22){mat22_multiply(a, b.column1), mat22_multiply(a, b.column2)};
}

static inline Mat22 mat22_abs(Mat22 m) { return (Mat22){vec2_abs(m.column1), vec2_abs(m.column2)}; }

/* The double function rounded to float, so that the result does not depend on a maths library's sinf. */
static inline Mat22 mat22_rotation(float angle) {
    float c = (float)cos((double)angle), s = (float)sin((double)angle);
    return (Mat22){vec2(c, s), vec2(-s, c)};
}

/* Narrow phase: two boxes -> the points where they touch. Separating axes, then clipping of the incident edge
   (Catto, "Fast and Simple Physics using Sequential Impulses", GDC 2006). */

/* A box for collision detection; its rotation is computed once per step, not once per pair. */
typedef struct Box {
    Vec2 position;  /* m */
    Vec2 half;      /* half width and height, m */
    Mat22 rotation; /* box to world */
} Box;

Box box_make(Vec2 position, Vec2 size, float angle);

/* Edges of a box, counter-clockwise from the top. */
typedef enum Edge { NO_EDGE, EDGE_TOP, EDGE_LEFT, EDGE_BOTTOM, EDGE_RIGHT } Edge;

typedef struct ManifoldPoint {
    Vec2 position;    /* m, world, on the reference face */
    float separation; /* m, <= 0 */
    uint32_t feature; /* bytes from the lowest: incoming and outgoing edge of a, then of b */
} ManifoldPoint;

typedef struct Manifold {
    int count;   /* 0..2 */
    Vec2 normal; /* unit, from a to b */
    ManifoldPoint points[2];
} Manifold;

/* Fills the manifold of a and b; count is 0 if they do not touch. */
void manifold_compute(Manifold *manifold, const Box *a, const Box *b);

/* The same for boxes that are apart by no more than `gap` m, too; so are points. */
void manifold_compute_within(Manifold *manifold, const Box *a, const Box *b, float gap);

/* The same, by the faces alone that are at 45 degrees and more to `normal`. Returns the separation of the face that it
   takes, m, also if no point lies on both boxes; it is positive for boxes that do not touch. */
float manifold_compute_across(Manifold *manifold, const Box *a, const Box *b, Vec2 normal);

/* Broad phase: which pairs of boxes may touch. */

/* Axis-aligned bounds, m. */
typedef struct Bounds {
    Vec2 low, high;
} Bounds;

/* The bounds of a box, widened by the float32 rounding error: boxes whose bounds are disjoint do not touch in the
   narrow phase either. */
Bounds bounds_of_box(const Box *box);

static inline bool bounds_overlap(const Bounds *a, const Bounds *b) {
    return a->low.x <= b->high.x && b->low.x <= a->high.x && a->low.y <= b->high.y && b->low.y <= a->high.y;
}

typedef struct BodyPair {
    int a, b; /* a < b */
} BodyPair;

/* Pairs that persist in memory from step to step. Zero-initialise; free pairs with free(). */
typedef struct PairList {
    BodyPair *pairs;
    size_t count, capacity;
} PairList;

/* Fills the list with all pairs of overlapping bounds, not both fixed, sorted by (a, b): the order in which sequential
   impulses visits them. Tests every pair: the reference implementation, and the fastest for few bodies. False when
   memory is short. */
bool broad_phase_find(PairList *list, const Bounds *bounds, const bool *fixed, int count);

/* A hundred for each of 10,000 boxes. Boxes that lie on one another have a pair for every two: 10,000 would need 16
   GB. */
enum { BROAD_PHASE_MAX_PAIRS = 1 << 20 };

typedef struct SweptBounds SweptBounds;

/* The same pairs in the same order by sort and sweep (Baraff 1992): bounds are sorted by their lower end along an axis,
   and each is tested only against those that begin before it ends. The order persists and changes little from step to
   step. Across the axis the plane is cut into strips that are swept separately, so that the cost per body does not grow
   with the width of the world. Zero-initialise. sort_and_sweep_find() is also false for more than
   BROAD_PHASE_MAX_PAIRS, and then sets too_many. */
typedef struct SortAndSweep {
    bool along_y, too_many;
    int count, strip_count;
    float strips_begin, strips_per_metre;
    SweptBounds *sorted;   /* [count] along the axis */
    SweptBounds *in_strip; /* strip by strip, in the same order; a body may be in several */
    int *starts;           /* scratch: first index of each strip in in_strip, then of each body in the list of pairs */
    PairList found;        /* strip by strip */
    size_t moved;          /* items, by the last sort */
    size_t sorted_capacity, in_strip_capacity, starts_capacity;
} SortAndSweep;

void sort_and_sweep_free(SortAndSweep *sweep);
bool sort_and_sweep_find(SortAndSweep *sweep, PairList *list, const Bounds *bounds, const bool *fixed, int count);

/* How deep boxes overlap, by separating axes in double. For what a scene places, not for contacts: the narrow phase
   prefers the face of the last step to the axis of the smallest overlap. */

/* The smallest overlap of two boxes along the axes of their faces, m; negative: they are apart by that much along one.
   */
double overlap_depth(const Box *a, const Box *b);

/* True if they overlap by more than `depth` m and the float32 rounding of their positions. */
bool overlap_exceeds(const Box *a, const Box *b, double depth);

typedef struct OverlapSpan {
    double from, to; /* m */
} OverlapSpan;

/* The x of b's centre at which it would overlap a by more than `depth`. Empty (from >= to) if it never would. With
   any_rotation, b may be turned: the span contains those of all its rotations. */
OverlapSpan overlap_span(const Box *a, const Box *b, double depth, bool any_rotation);

/* Finds two boxes, not both fixed, that overlap by more than `depth`; found->a is -1 if no two do. Stops at the
   first pair, so that memory is linear in `count` for any boxes. False when memory is short. */
bool overlap_find(const Box *boxes, const bool *fixed, int count, double depth, BodyPair *found);

/* The contact problem of one step, frozen: the whole input of a contact solver. Datasets are recorded from it and
   accuracy is measured on it. Source: Catto, "Iterative Dynamics with Temporal Coherence" (2005) and "Fast and Simple
   Physics using Sequential Impulses" (GDC 2006). */

/* m: penetration that position correction leaves. */
#define CONTACT_SLOP 0.01f

typedef struct ProblemBody {
    Vec2 position;               /* m */
    float angle;                 /* rad */
    Vec2 size;                   /* full width and height, m */
    float inv_mass, inv_inertia; /* 1/kg, 1/(kg m^2); 0 for a static body */
    Vec2 velocity;               /* m/s, after gravity, before the warm start */
    float angular_velocity;      /* rad/s */
} ProblemBody;

/* True for a body of finite mass. */
static inline bool problem_body_moves(const ProblemBody *body) {
    return body->inv_mass != 0.0f || body->inv_inertia != 0.0f;
}

typedef struct ContactPoint {
    int a, b;                        /* bodies, a < b; the points of one pair are adjacent, pairs rise by (a, b) */
    Vec2 position;                   /* m, world */
    Vec2 normal;                     /* unit, from a to b; the tangent is normal turned a quarter clockwise */
    Vec2 arm_a, arm_b;               /* m, from the centre of each body to the point */
    float separation;                /* m, negative for penetration, positive only for kept and mended contacts */
    float mass_normal, mass_tangent; /* kg, effective masses along normal and tangent */
    float friction;                  /* coefficient of the pair */
    float bias;                      /* m/s, target normal velocity of position correction; 0 without it */
    uint32_t feature;                /* feature id: the edges that make the point; identifies it in the next step */
    float warm_normal, warm_tangent; /* N s, impulses of the step before; 0 without warm starting or when new */
} ContactPoint;

typedef struct ContactProblem {
    int body_count, contact_count;
    int bomb;   /* index of the body; -1: none, or not known */
    float dt;   /* s */
    float fall; /* m/s, what gravity has added to each velocity: |g| dt; 0: nothing, or unknown */
    const ProblemBody *bodies;
    const ContactPoint *contacts;
} ContactProblem;

typedef struct BodyVelocity {
    Vec2 linear;   /* m/s */
    float angular; /* rad/s */
} BodyVelocity;

typedef struct ContactImpulse {
    float normal, tangent; /* N s, accumulated over the step; b gets +, a gets - */
} ContactImpulse;

/* What a method solved by simpler means than its own. The first two count network outputs that were discarded or
   corrected, by contact or pair. */
typedef struct NetworkFallbacks {
    int not_finite;      /* NaN, infinite or out of bounds; discarded */
    int outside_cone;    /* impulses that were clamped to the friction cone */
    int beyond_training; /* steps unlike the training data: taken without the network, or with inputs or components that
                            were clamped to its range (the method's file says which) */
    int by_sweeps;       /* steps in which sweeps solved an island, because the residual of interior-point steps stayed
                            high or it is too large for them */
    int not_converged;   /* steps in which the reference stayed above its tolerance: no yardstick for other methods */
    double residual;     /* m/s: the largest of those */
} NetworkFallbacks;

static inline void network_fallbacks_add(NetworkFallbacks *sum, const NetworkFallbacks *step) {
    sum->not_finite += step->not_finite;
    sum->outside_cone += step->outside_cone;
    sum->beyond_training += step->beyond_training;
    sum->by_sweeps += step->by_sweeps;
    sum->not_converged += step->not_converged;
    if (step->not_converged > 0 && !(step->residual <= sum->residual)) sum->residual = step->residual;
}

/* What a solver fills in; the arrays are the caller's. */
typedef struct ContactSolution {
    BodyVelocity *velocities; /* [body_count] */
    ContactImpulse *impulses; /* [contact_count]; zeros from a method without impulses */
    /* N s: momentum that the method created: the sum over pairs of moving bodies of |ma dva + mb dvb|; 0 for a method
       that applies impulses; of avbd and sain the sum over bodies of the momentum that impulses do not account
       for; of gns that which bodies without a contact gained beyond gravity's */
    float momentum_error;
    NetworkFallbacks fallbacks; /* zeros for most methods */
} ContactSolution;

/* Velocities before any impulse, and no impulses. */
void contact_solution_begin(const ContactProblem *problem, ContactSolution *solution);

/* Solves a contact problem: fills the solution. False with error set only when memory is short or the problem cannot be
   solved at all. Allocates nothing once the state has met a problem of that size. */
typedef bool ContactSolve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error);

/* The contacts of one step, grouped by arbiter. An arbiter is a touching pair; it persists with its impulses as long as
   the pair touches. */

/* How a pair was when its points were found. */
typedef struct FoundPair {
    Vec2 between;        /* m, from the centre of a to that of b */
    Vec2 axis_a, axis_b; /* x axes of the boxes */
    float separation[2]; /* m, of its points */
} FoundPair;

typedef struct Arbiter {
    int a, b;         /* bodies, a < b */
    int first, count; /* its points in the contact set; count is 0 once forgotten */
    bool narrow;      /* of mended contacts: its points are nearer to each other than half of the smallest side */
    FoundPair found;
} Arbiter;

/* Zero-initialise; arrays grow and are reused. Arbiters are sorted by (a, b). */
typedef struct ContactSet {
    int arbiter_count, contact_count;
    Arbiter *arbiters;
    ContactPoint *contacts;   /* [contact_count] */
    ContactImpulse *impulses; /* [contact_count] of the solution */
    int *partners;            /* scratch: lists of the arbiters of each body */
    size_t arbiter_capacity, contact_capacity, impulse_capacity, partner_capacity;
} ContactSet;

/* How contacts are found. Zeros: as Box2D-Lite finds them, with its bits.

   keep > 0: a pair of two points in the last step is kept instead of being found again, while its boxes have shifted
   along its face, or apart, by less than `keep` of the smaller side since its points were found, and neither has turned
   by more than 0.2 rad. Its separations follow the boxes and may be positive; lever arms and normal stay as they were
   in world coordinates. So a column that leans a little has no tipping moment from contacts that give way under its own
   weight, which it would otherwise buckle by. The price: support up to `keep` beyond an edge. Sweeps that end early
   still let boxes sink. Source: Catto, Box2D's contact recycling (2026), whose tolerance is a length.

   mend: no ghosts at seams (contact_problem.c); and thin boxes (CONTACT_THIN) touch before they overlap. */
typedef struct ContactRules {
    float keep;
    bool mend;
} ContactRules;

/* m: the smallest side below which boxes are thin. As Box2D-Lite finds contacts, boxes that rounding or the end of
   sweeps sets apart fall until they overlap. In a stack of thin boxes this presses the centre of one past that of
   another; and contacts, which push centres apart, then push it out on the wrong side. */
#define CONTACT_THIN (5 * CONTACT_SLOP)

/* m: the distance from which on a thin box touches others, where contacts are mended; 0: not before it overlaps
   them. */
float contact_gap(const Box *box, ContactRules rules);

void contact_set_free(ContactSet *set);

/* Makes `to` equal to `from`. False when memory is short. */
bool contact_set_copy(ContactSet *to, const ContactSet *from);

/* Narrow phase over the candidate pairs; fills positions, normals, lever arms, separations and feature ids, not masses
   or impulses. `last`: the contacts of the last step, for those that are kept. False when memory is short. */
bool contact_set_collide(ContactSet *set, const PairList *pairs, const Box *boxes, const ContactSet *last,
                         ContactRules rules);

/* Sets warm-start impulses: those of the last step at the point with the same pair and feature id. */
void contact_set_match(ContactSet *set, const ContactSet *last);

/* Forgets the arbiters of a body. Contacts and impulses stay in memory, for readers of the last step. */
void contact_set_forget(ContactSet *set, int body);

/* The target velocity of position correction along the normal, m/s (Baumgarte 1972, as in Box2D-Lite); inverse_dt in
   1/s. */
float contact_bias(float separation, float inverse_dt);

/* Effective masses, friction and bias (the pre-step of Box2D-Lite). friction: coefficient of each body. Without
   position correction the bias of contacts that overlap is 0; where a gap is, it lets the gap close in this step, and
   no more. */
void contact_set_prepare(ContactSet *set, const ProblemBody *bodies, const float *friction, float dt,
                         bool position_correction);

/* A rigid box. */

/* The definition of a body. Zero-initialise, then set at least size and mass. */
typedef struct BodyDef {
    Vec2 size;              /* full width and height, m, > 0 */
    bool fixed;             /* static: infinite mass */
    float mass;             /* kg, > 0; ignored where fixed */
    float friction;         /* coefficient, >= 0; a pair has sqrt(f1 f2) */
    Vec2 position;          /* m */
    float angle;            /* rad */
    Vec2 velocity;          /* m/s */
    float angular_velocity; /* rad/s */
} BodyDef;

typedef struct Body {
    Vec2 position;
    float angle;
    Vec2 velocity;
    float angular_velocity;
    Vec2 size;
    float friction;
    float inv_mass, inv_inertia; /* 0 if static */
} Body;

/* The mutable state of a simulation: bodies, the contacts that persist between them, and the step.

   Collision detection, then gravity, then the contact problem with its warm start, then a contact solver, then
   integration (semi-implicit Euler): the loop of Box2D-Lite (Catto 2006), with the same bits
   (tests/runs/test_reference.c). */

typedef struct WorldDef {
    Vec2 gravity;             /* m/s^2 */
    bool warm_starting;       /* hand the last step's impulses to the solver */
    bool position_correction; /* push overlapping boxes apart (Baumgarte) */
} WorldDef;

typedef struct World World;

World *world_create(const WorldDef *def, Error *error);
void world_destroy(World *world);

/* Adds a body; its index is the number of bodies before it. Pairs are sorted by index, so the order of bodies
   matters. */
bool world_add_body(World *world, const BodyDef *def, Error *error);

/* Removes the body added last, and its contacts; the other contacts keep their impulses. The world must have a body. */
void world_remove_last_body(World *world);

/* From the next step on; zeros at first. */
void world_set_contacts(World *world, ContactRules rules);

/* Says which body is the bomb (-1: none), for those who read the contact problem. The step treats it as any other. */
void world_set_bomb(World *world, int body);

/* Copies the state of `from` to `to`. False with error set when memory is short. */
bool world_copy(World *to, const World *from, Error *error);

/* A step in parts, for steppers that need more than one solver call. The world does not change before the step ends, so
   a step need not be ended.

   Begins a step of dt seconds (dt > 0): collision detection, gravity, the contact problem. The world owns the problem's
   arrays and the solution, which the caller fills; they are valid until the next step. False with error set when memory
   is short, or for more than BROAD_PHASE_MAX_PAIRS. */
bool world_begin_step(World *world, float dt, ContactProblem *problem, ContactSolution **solution, Error *error);

/* Ends the step: moves the bodies by the velocities of the solution. On failure the world is unchanged and error names
   the first body whose state is NaN or infinite. */
bool world_end_step(World *world, Error *error);

/* Position and angle of a body. */
typedef struct BodyPose {
    Vec2 position; /* m */
    float angle;   /* rad */
} BodyPose;

/* The same, with the final poses [body_count] given, for steppers that integrate in substeps. */
bool world_end_step_at(World *world, const BodyPose *poses, Error *error);

/* Advances the world by dt seconds with a solver and its state. On failure the world is unchanged; error names the
   first body whose state is NaN or infinite, or is the solver's. */
bool world_step(World *world, ContactSolve *solve, void *state, float dt, Error *error);

int world_body_count(const World *world);
const Body *world_bodies(const World *world);

/* The contact problem of the last step and its solution; valid until the next step, even if bodies are added or removed
   meanwhile. Empty before the first step. */
const ContactProblem *world_problem(const World *world);
const ContactSolution *world_solution(const World *world);

/* Energy and penetration of a world. */

/* J: kinetic and potential energy, with potential 0 at the origin; 0 for static bodies. */
double body_energy(const Body *body, Vec2 gravity);

double bodies_energy(const Body *bodies, int count, Vec2 gravity);
double world_energy(const World *world, Vec2 gravity);

/* m: the deepest contact of the last step; 0 without contacts. */
double world_penetration(const World *world);
