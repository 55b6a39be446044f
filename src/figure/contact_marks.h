/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws the contacts of a step over a picture of its bodies: points, normals, and impulses as arrows and numbers. */
#pragma once
#include "common/error.h"
#include "sketch/sketch.h"
#include "trajectory/trajectory.h"

typedef struct ContactLook {
    double ring;        /* mm, radius of a point's mark */
    double arrow_scale; /* mm per N s */
    double largest;     /* N s, largest impulse of all panels */
    double points;      /* font size */
} ContactLook;

/* Font size of the numbers / the figure's font size. */
#define CONTACT_TYPE 0.85

/* In N s. */
double impulse_magnitude(const TrajectoryContact *contact);

/* False for NaN or infinity, which a damaged file may contain. */
bool contact_is_finite(const TrajectoryContact *contact);

/* Draws the contacts inside the view. *numbered of *count have their impulse as a number; for the others there was
   no room. */
bool draw_contacts(Sketch *sketch, const View *view, const ContactLook *look, const Trajectory *run, int step,
                   int *count, int *numbered, Error *error);

/* A sample for the legend: a contact's mark with its label. */
void draw_contact_sample(Sketch *sketch, Point at, const ContactLook *look);
