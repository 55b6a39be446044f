/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The contacts of a step over a picture of its bodies: points, normals, and impulses as arrows and numbers. */
#pragma once
#include "common/error.h"
#include "sketch/sketch.h"
#include "trajectory/trajectory.h"

typedef struct ContactLook {
    double ring;        /* mm, radius of a point's mark */
    double arrow_scale; /* mm a N s */
    double largest;     /* N s, of all that are compared */
    double points;      /* of type */
} ContactLook;

/* Of numbers: their type over the figure's. */
#define CONTACT_TYPE 0.85

/* N s */
double impulse_size(const TrajectoryContact *contact);

/* A damaged run may hold any bits. */
bool contact_has_numbers(const TrajectoryContact *contact);

/* Marks those inside the view. *numbered of *count have their impulse written: the others found no room. */
bool put_contacts(Sketch *sketch, const View *view, const ContactLook *look, const Trajectory *run, int step,
                  int *count, int *numbered, Error *error);

/* A contact's mark with a normal to the right, and what it is. */
void put_contact_sample(Sketch *sketch, Point at, const ContactLook *look);
