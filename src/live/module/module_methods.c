/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The registry of a module, in place of methods/registry.c; compiled for each of the two. */
#include "live/live.h"
#include "methods/methods.h"

#ifdef LIVE_PLAIN
#undef LIVE_METHODS
#define LIVE_METHODS LIVE_PLAIN_METHODS
#endif

const MethodKind method_kinds[] = {LIVE_METHODS(METHOD_KIND_SOLVER, METHOD_KIND_STEPPING){NULL, NULL, NULL}};
