/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The registry of methods, from the list in methods/methods.h. It is alone in its file so that a test can link a
   registry with methods of its own. */
#include "methods/methods.h"

const MethodKind method_kinds[] = {METHODS(METHOD_KIND_SOLVER, METHOD_KIND_STEPPING){NULL, NULL, NULL}};
