/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Constants of an iteration; interior.c has those of its schedule. */
#pragma once

/* In an iteration l and z keep at least this share of themselves, as do p and q, and the distances of t to its bounds. */
static const double kept = 0.2, kept_slip = 0.11, kept_distance = 0.27;
/* The targets of friction, as a multiple of those of normal impulses. */
static const double slip_aim = 4;
/* Largest D at the target, as a multiple of the effective mass: the contact is then open by l / m / stiffest. */
static const double stiffest = 1e12;
