/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The file of one contact problem: .npz with the members of ContactProblem as arrays: kind, version, scene, frame, dt,
   fall (0 in a file without it), bomb; per body position[N,2], angle[N], size[N,2], inv_mass[N], inv_inertia[N],
   velocity[N,2], angular_velocity[N]; per contact contact_bodies[C,2], contact_feature[C], contact_position[C,2],
   contact_normal[C,2], contact_arm_a[C,2], contact_arm_b[C,2], contact_separation[C], contact_mass[C,2],
   contact_friction[C], contact_bias[C], contact_warm[C,2]. Arrays with two columns hold x, y or normal, tangent. */

#pragma once
#include "base/base.h"
#include "engine/engine.h"

enum { PROBLEM_VERSION = 1, PROBLEM_NAME_SIZE = 128, PROBLEM_MAX_BODIES = 100000, PROBLEM_MAX_CONTACTS = 1000000 };

typedef struct StoredProblem {
    char scene[PROBLEM_NAME_SIZE]; /* the scene that it was recorded from */
    int frame;                     /* number of the step; the first is 1 */
    ContactProblem problem;        /* its arrays are the two below */
    ProblemBody *bodies;
    ContactPoint *contacts;
} StoredProblem;

bool problem_write(const ContactProblem *problem, const char *scene, int frame, const char *path, Error *error);

/* NULL with error set (ERROR_INPUT, naming the file) for a file that is damaged, of another version or not a contact
   problem: inconsistent shapes, NaN or infinite numbers, sizes, masses or dt not positive, pairs that are out of range,
   not sorted or of two static bodies, normals that are not of unit length. */
StoredProblem *problem_read(const char *path, Error *error);
void problem_destroy(StoredProblem *stored);
