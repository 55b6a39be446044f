/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solvers/solvers.h"

#include <string.h>

const ContactSolverKind *const solver_kinds[] = {&solver_engine,      &solver_over_relaxation,
                                                 &solver_momentum,    &solver_learned_momentum,
                                                 &solver_block,       &solver_nncg,
                                                 &solver_robust,      &solver_pair_net,
                                                 &solver_contact_net, &solver_relu_net,
                                                 &solver_scene_net,   &solver_constant,
                                                 &solver_reference,   NULL};

const ContactSolverKind *solver_find(const char *name) {
    for (int i = 0; solver_kinds[i] != NULL; i++)
        if (strcmp(solver_kinds[i]->name, name) == 0) return solver_kinds[i];
    return NULL;
}
