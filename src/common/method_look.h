/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How methods are named and told apart in all pictures: captions, legends, charts and figures.

   The name is the method's text as on the command line ("momentum:k=20"), without the folders of its files. The colour is
   the one that its description states (common/method_description.h), unless another run of the picture has it. */
#pragma once
#include "common/method_description.h"

#include <stddef.h>

/* Copies a method's text without the folders of its files, which differ between machines. Returns its length. */
size_t method_name(char *name, size_t size, const char *text);

/* Length of the part of a name before its settings. */
size_t method_name_head(const char *name);

/* Colours of the runs of one picture, all different: the described ones in the order of the runs; then for the others the
   first ones that are left. methods[i] NULL: unknown. count < METHOD_COLOURS. */
void method_colours_assign(const MethodDescription *const *methods, int count, MethodColour *colours);
