/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Proximal ADMM, the alternating direction method of multipliers: a factorization over all bodies, then many solutions
   with it. With G = J M^-1 J^T over the rows of all contacts, their velocities g before any impulse less the bias, the
   friction cones K, and s = mu |slip| on each normal (De Saxce), an iteration is

       x = (G + (r + e) I)^-1 (z + r y + e x - g - s),   y = the point of K nearest to x - z / r,   z = z - r (x - y)

   until x = y, the impulses, and z = G x + g + s. So friction is Coulomb's, not its convex relaxation. The proximal
   term is e = 1e-6; r starts at sqrt(L e) (L / e)^0.2 / 2, with L the largest eigenvalue of G, and is multiplied or
   divided by (L / e)^0.05, and the matrix factorized again, while one of |x - y| and |r dy + e dx| is ten times the
   other (the spectral rule). Source of the method and of all these numbers: Carpentier, Le Lidec, Montaut, "From
   Compliant to Rigid Contact Simulation: a Unified and Efficient Approach" (2024), and Pinocchio, their program. That
   keeps r and z from step to step; here each step begins with its own, so that a problem has one answer: r as above,
   which costs a sixth of the error at 10 to 50 iterations, and z from the velocities before any impulse, projected into
   the dual cone, which costs nothing. Its users also accelerate it (Nesterov, with restarts: Kamino), which takes the
   error at 20 to 100 iterations to two thirds or a half; that is left out. Rows are scaled by
   the roots of their effective masses, as a preconditioner may there: G has ones on its diagonal, and no unit of length
   or mass changes an iteration.

   With D = r + e and w = (M + J^T J / D)^-1 J^T q / D, the solution for q is (q - J w) / D: so what is factorized has
   a block for each pair of touching bodies (block_lu.h), however many contacts they have. Same bits on every
   instruction set, as interior points (interior_point_internal.h).

   Fails where it is stopped early: an iteration moves all boxes by little. Impacts take hundreds, each as long as one
   or two sweeps with momentum, which need fewer. Stacks at rest take some ten, whatever their mass ratios. */
#pragma once
#include "base/base.h"
#include "engine/engine.h"
#include "methods/interior_point_internal.h"
#include "methods/islands.h"
#include "methods/stopping.h"
#include "methods/sweeps.h"

/* Four contact slots, in scaled rows: impulses over and velocities times the root of the effective mass. */
typedef struct AdmmGroup {
    Vec4 root_normal, root_tangent; /* of the effective masses, sqrt(kg) */
    Vec4 friction;                  /* of the scaled cone */
    Vec4 g_normal, g_tangent, x_normal, x_tangent, y_normal, y_tangent, z_normal, z_tangent;
    Vec4 q_normal, q_tangent; /* right-hand side */
} AdmmGroup;

/* Zero-initialise. */
typedef struct Admm {
    StoppingRule rule;
    Sweeps sweeps;       /* they load the problem */
    Interior interior;   /* its rows and graph, and the answer: y with the velocities that it makes */
    AdmmGroup *groups;   /* [interior.group_count] */
    double largest_g;    /* the largest |g| */
    double penalty;      /* r, in units of scaled rows */
    double primal, dual; /* in the last iteration, the largest |x - y| and |r dy + e dx| */
    ArrayBlock memory;   /* of `groups` */
    Islands islands;     /* each is solved by itself */
} Admm;

/* e */
static const double admm_proximal = 1e-6;

/* The parts that are compiled for several instruction sets. */
typedef struct AdmmKernels {
    const char *name;
    void (*begin)(Admm *admm);     /* x, y and z, from the impulses and velocities that `interior` has loaded */
    double (*largest)(Admm *admm); /* an estimate of the largest eigenvalue of G */
    void (*factorize)(Admm *admm); /* with the penalty */
    void (*iterate)(Admm *admm);   /* sets `primal` and `dual`, too */
} AdmmKernels;

extern const AdmmKernels admm_scalar, admm_avx2;
