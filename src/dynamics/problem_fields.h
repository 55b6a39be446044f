/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The arrays that a problem file holds for bodies and contacts. Only problem_read.c, problem_write.c and problem_bytes.c include
   this. */
#pragma once
#include "dynamics/problem_file.h"

#include <stddef.h>

#define PROBLEM_KIND "contact problem"

/* An array of `count` floats per body or contact, and their offset in its struct. */
typedef struct ProblemField {
    const char *name;
    size_t offset;
    int count;
} ProblemField;

enum { BODY_FIELDS = 7, CONTACT_FIELDS = 9 };

static const ProblemField body_fields[BODY_FIELDS] = {
    {"position", offsetof(ProblemBody, position), 2},
    {"angle", offsetof(ProblemBody, angle), 1},
    {"size", offsetof(ProblemBody, size), 2},
    {"inv_mass", offsetof(ProblemBody, inv_mass), 1},
    {"inv_inertia", offsetof(ProblemBody, inv_inertia), 1},
    {"velocity", offsetof(ProblemBody, velocity), 2},
    {"angular_velocity", offsetof(ProblemBody, angular_velocity), 1},
};

static const ProblemField contact_fields[CONTACT_FIELDS] = {
    {"contact_position", offsetof(ContactPoint, position), 2},
    {"contact_normal", offsetof(ContactPoint, normal), 2},
    {"contact_arm_a", offsetof(ContactPoint, arm_a), 2},
    {"contact_arm_b", offsetof(ContactPoint, arm_b), 2},
    {"contact_separation", offsetof(ContactPoint, separation), 1},
    {"contact_mass", offsetof(ContactPoint, mass_normal), 2},
    {"contact_friction", offsetof(ContactPoint, friction), 1},
    {"contact_bias", offsetof(ContactPoint, bias), 1},
    {"contact_warm", offsetof(ContactPoint, warm_normal), 2},
};
