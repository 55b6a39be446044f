/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A step's contacts by interior-point steps with a sparse direct solve over the bodies.

   Each contact has a normal impulse l >= 0 and a gap velocity z >= 0, a tangent impulse t inside |t| <= mu l, and
   sliding velocities p, q >= 0 in the two directions. With M the masses, v' the velocities before the contacts, J_n and
   J_t the rows of normal and tangent velocities, b the bias:

       M (v - v') = J_n^T l + J_t^T t
       z = J_n v - b,        l z = tau^2 m_n
       J_t v = q - p,        p (mu l - t) = q (mu l + t) = tau^2 m_t mu

   For tau = 0 these are the contact problem: normal complementarity and Coulomb friction (in two dimensions the cone is
   an interval). An iteration linearises them at the current point. Impulses are eliminated contact by contact,

       dl = r_n - D_n J_n dv,   dt = r_t + s dl - D_t J_t dv,   D_n = l / z,   s = mu (p / (mu l - t) - q / (mu l + t))
       D_t,

   which leaves (M + J_n^T D_n J_n + J_t^T (s D_n J_n + D_t J_t)) dv = r, with 3 x 3 blocks for the bodies in contact
   (block_lu.h). The matrix is not symmetric, as the friction bound follows the normal impulse. The direct solve carries
   a shock through all bodies at once, and D is a soft active set: large where a contact closes, near zero where it
   opens. A second solve with the same factors corrects for the products dl dz, dp dt, dq dt (Mehrotra's corrector).
   Impulses and slips keep a share of their value in an iteration, each by itself. tau^2 falls by a fixed factor, but
   not far below the square of the residual: else iterations cycle between sets of closed contacts. The answer of an
   iteration is its full step, projected into the cones, with the velocities that these impulses make. The velocities of
   the linearised step are closer to the solution, but only impulses outside the cones would make them. They give an
   estimate of the answer's residual without computing its velocities: a little too large, and rarely too small.

   Sources: Mehrotra, "On the Implementation of a Primal-Dual Interior Point Method" (1992); for contacts Kleinert,
   Simeon, Dressler, "Nonsmooth Contact Dynamics for the Large-Scale Simulation of Granular Material" (2017), and Acary,
   Armand, Nguyen, Shpakovych, "Second-Order Cone Programming for Frictional Contact Mechanics Using Interior Point
   Algorithm" (2024), which solve conic programs with a symmetric matrix.

   Fails where the friction problem has no solution or where iterations cycle between sliding and sticking: the
   residual shows it, and the method `interior` then goes on with sweeps (methods/interior.c). Beyond some
   hundred bodies the time of the factorization grows faster than the number of contacts (block_lu.h). Same bits on
   every instruction set: double, a fixed order of operations, no fused multiply-add. */
#pragma once
#include "base/base.h"
#include "engine/engine.h"
#include "methods/block_lu.h"
#include "methods/sweeps.h"

/* Four contact slots. One without a contact has zero rows, so it has no effect. */
typedef struct InteriorGroup {
    BlockRows rows;                       /* J_n and J_t */
    Vec4 mass_normal, mass_tangent;       /* kg, effective; 1 without a contact */
    Vec4 inverse_normal, inverse_tangent; /* 1/kg; 0 without a contact */
    Vec4 friction, bias;
    Vec4 l, t, z, p, q;                 /* N s and m/s, see above */
    Vec4 normal, tangent;               /* J_n v and J_t v, m/s */
    Vec4 free_normal, free_tangent;     /* the same of v' */
    Vec4 answer_normal, answer_tangent; /* N s: impulses inside the cone, the result */
    Vec4 best_normal, best_tangent;     /* N s: the answer with the least residual so far */
    /* of an iteration */
    Vec4 aim_normal, aim_tangent; /* the targets of l z, and of p (mu l - t) and q (mu l + t) */
    Vec4 dn, dt, s;               /* D_n, D_t, s */
    Vec4 rn, rt;                  /* r_n, r_t */
    Vec4 upper, lower, over_z;    /* 1 / (mu l - t), 1 / (mu l + t), 1 / z */
    Vec4 second_p, second_q;      /* products of the corrector */
} InteriorGroup;

/* Zero-initialise; arrays grow and are reused. */
typedef struct Interior {
    BlockGraph graph;
    int group_count, contact_count; /* contact_count: that act on a moving body */
    InteriorGroup *groups;
    BlockPair *pairs; /* [2 group_count] */
    /* [graph.lu.count + 1] by position; the last is zero, for bodies that do not move. x, y, spin, unused. changes: of
       the first solve of an iteration; corrected: of the second */
    Vec4 *velocities, *start, *changes, *corrected;
    double residual;       /* m/s, of the answer */
    double heaviest;       /* kg, body that moves */
    double iteration_work; /* of an iteration, in sweeps over the same contacts */
    int iterations;        /* of the last solve */
    ArrayBlock memory;
} Interior;

/* The parts that are compiled for several instruction sets. */
typedef struct InteriorKernels {
    const char *name;
    void (*factor)(BlockLu *lu);
    void (*solve)(const BlockLu *lu, Vec4 *x);
    /* One iteration towards tau^2 = target, (m/s)^2. Returns an estimate of the answer's residual: that of the
       linearised velocities, and what the projection into the cones changes. */
    double (*iterate)(Interior *interior, double target);
    /* Computes the velocities of the answer. Returns its residual. */
    double (*answer)(Interior *interior);
} InteriorKernels;

extern const InteriorKernels interior_scalar, interior_avx2;

/* The fastest that the processor supports. */
const InteriorKernels *interior_best(void);

void interior_free(Interior *interior);

/* Loads the impulses and velocities of sweeps over the problem, and sets `residual` to theirs. The residual is the root
   mean square over contacts of what one more visit would change: normal and tangent velocity, |change of impulse| /
   effective mass. False when memory is short. */
bool interior_load(Interior *interior, const InteriorKernels *kernels, const Sweeps *sweeps,
                   const ContactProblem *problem);

/* The work of an iteration, in sweeps over as many pairs. products: of blocks in the factorization. */
double interior_work(double products, int pair_count);

/* After interior_load(): iterates until the residual is at most `near` (m/s), at most `most` times, and sets `residual`
   and `iterations`. If it ends above, its answer is the best so far, the start included. speed: m/s, of the problem, so
   that no limit depends on its units. */
void interior_iterate(Interior *interior, const InteriorKernels *kernels, double speed, double near, int most);

/* Stores the solution: impulses inside the friction cones, and the velocities that they make. False if a velocity is
   NaN or infinite. */
bool interior_end(const Interior *interior, const Sweeps *sweeps, const ContactProblem *problem,
                  ContactSolution *solution);

/* The bound of the work that a step of interior takes, in coloured sweeps over an island's contacts: 30 times the
   engine's ten, as one of the engine's own sweeps takes as long as 4.9 to 6.8 of these. */
enum { INTERIOR_MOST_WORK = 1470 };

/* The most that the last step took for an island, by a count of what was done; never above the bound. */
double interior_work_done(const void *state);
