/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The registry of a module, in place of methods/registry.c; compiled for each of the two. */
#include "methods/methods.h"

#define LIVE(entry) entry
#ifdef LIVE_PLAIN
#define LIVE_NETWORK(entry)
#else
#define LIVE_NETWORK(entry) entry
#endif
#define NOT_LIVE(entry)
#define SOLVER_HERE(name, where) where(METHOD_KIND_SOLVER(name, where))
#define STEPPING_HERE(name, where) where(METHOD_KIND_STEPPING(name, where))

const MethodKind method_kinds[] = {METHODS(SOLVER_HERE, STEPPING_HERE){NULL, NULL, NULL}};
