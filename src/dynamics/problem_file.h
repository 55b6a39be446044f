/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One contact problem as a file, to study a single frame. .npz with the members of ContactProblem as arrays: kind,
   version, scene, frame, dt, bomb; per body position[N,2], angle[N], size[N,2], inv_mass[N], inv_inertia[N],
   velocity[N,2], angular_velocity[N]; per contact contact_bodies[C,2], contact_feature[C], contact_position[C,2],
   contact_normal[C,2], contact_arm_a[C,2], contact_arm_b[C,2], contact_separation[C], contact_mass[C,2],
   contact_friction[C], contact_bias[C], contact_warm[C,2]. Pairs of numbers are x, y or normal, tangent. */
#pragma once
#include "common/error.h"
#include "dynamics/contact_problem.h"

#include <stdbool.h>

enum { PROBLEM_VERSION = 1, PROBLEM_NAME_SIZE = 128, PROBLEM_MAX_BODIES = 100000, PROBLEM_MAX_CONTACTS = 1000000 };

typedef struct StoredProblem {
    char scene[PROBLEM_NAME_SIZE]; /* whose run it is from */
    int frame;                     /* number of the step, from 1 */
    ContactProblem problem;        /* its arrays are the two below */
    ProblemBody *bodies;
    ContactPoint *contacts;
} StoredProblem;

bool problem_write(const ContactProblem *problem, const char *scene, int frame, const char *path, Error *error);

/* Refuses (ERROR_INPUT, naming the file) what is damaged, of another version, or no contact problem: shapes that do not
   fit each other, numbers that are not finite, sizes, masses or dt not positive, pairs that are out of range, out of
   order, or of two static bodies, normals that are not of unit length. NULL with error set. */
StoredProblem *problem_read(const char *path, Error *error);
void problem_destroy(StoredProblem *stored);
