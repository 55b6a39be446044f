/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The registry of methods, from the list in solvers/solvers.h. It is alone in its file so that a test can link a
   registry with methods of its own. */
#include "simulate/method.h"
#include "solvers/solvers.h"

const MethodKind method_kinds[] = {METHODS(METHOD_KIND_SOLVER, METHOD_KIND_STEPPING){NULL, NULL, NULL}};
