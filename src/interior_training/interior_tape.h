/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tape operations of contacts and bodies. Vectors over contacts have a number per slot of the groups, vectors over
   bodies four per position (interior.h). */
#pragma once
#include "interior_training/unrolled_interior.h"

enum { OWN_PUSH = TAPE_OWN, OWN_NORMAL, OWN_TANGENT, OWN_SOLVE };

/* The functions of the tape; their context is the UnrolledInterior. */
void interior_tape_forward(void *context, Tape *tape, const TapeNode *node);
void interior_tape_backward(void *context, Tape *tape, const TapeNode *node);

/* J_n^T normal + J_t^T tangent */
TapeId interior_tape_push(UnrolledInterior *u, TapeId normal, TapeId tangent);

/* J_n x and J_t x */
TapeId interior_tape_normal(UnrolledInterior *u, TapeId x);
TapeId interior_tape_tangent(UnrolledInterior *u, TapeId x);

/* The matrix M + J_n^T D_n J_n + J_t^T (s D_n J_n + D_t J_t), factorized. */
TapeId interior_tape_factor(UnrolledInterior *u, TapeId dn, TapeId dt, TapeId s);

/* A^-1 y, for the last factor */
TapeId interior_tape_solve(UnrolledInterior *u, TapeId factor, TapeId y);
