/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The registry of contact solvers: adding one is one file and one line in solvers.c. */
#pragma once
#include "dynamics/contact_solver.h"

extern const ContactSolverKind solver_engine;
extern const ContactSolverKind solver_over_relaxation;
extern const ContactSolverKind solver_momentum;
extern const ContactSolverKind solver_learned_momentum;
extern const ContactSolverKind solver_block;
extern const ContactSolverKind solver_nncg;
extern const ContactSolverKind solver_robust;
extern const ContactSolverKind solver_pair_net;
extern const ContactSolverKind solver_contact_net;
extern const ContactSolverKind solver_relu_net;
extern const ContactSolverKind solver_scene_net;
extern const ContactSolverKind solver_constant;
extern const ContactSolverKind solver_reference;

/* All kinds, ended by NULL. */
extern const ContactSolverKind *const solver_kinds[];

/* The kind of that name, or NULL. */
const ContactSolverKind *solver_find(const char *name);
