/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reference's way along the central path (methods/reference.h), as a last attempt of the method interior. At
   impacts on walls, piles and pyramids the path may turn back, and quick iterations, which do not stay near it, break
   down: in 1 to 10% of these impacts. Following it takes 10 to 30 factorizations, rarely more than 100. */
#pragma once
#include "methods/reference.h"

/* Zero-initialise; arrays grow and are reused. */
typedef struct InteriorPath {
    Reference reference;
    double residual; /* m/s, of the last answer; infinite if float cannot hold its impulses */
    /* workspace */
    int room_bodies, room_contacts; /* of the largest problems so far that there is room for */
    float factor;                   /* of the copy's speeds */
    ProblemBody *bodies;            /* of the copy */
    ContactPoint *contacts;
    ArrayBlock copy;
} InteriorPath;

void interior_path_free(InteriorPath *path);

/* Makes room for a solve, so that the step that does need it allocates nothing. False when memory is short. */
bool interior_path_reserve(InteriorPath *path, const ContactProblem *problem);

/* Follows the path until the residual is at most `near`, for at most so many factorizations. speed: the problem's
   fastest (m/s): no limit depends on its unit. ERROR_MEMORY. */
bool interior_path_follow(InteriorPath *path, const ContactProblem *problem, double speed, double near, int most,
                          Error *error);

/* Stores the answer, rounded into the cones. */
void interior_path_take(const InteriorPath *path, const ContactProblem *problem, ContactSolution *solution);
