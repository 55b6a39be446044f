/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The registry of the module, in place of methods/registry.c. */
#include "live/live.h"
#include "methods/methods.h"

const MethodKind method_kinds[] = {LIVE_METHODS(METHOD_KIND_SOLVER, METHOD_KIND_STEPPING){NULL, NULL, NULL}};
