/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds the scenes that `cmake --install` put beside the program. */
#pragma once

/* A file or folder given on the command line: the path itself; but if it is relative and there is nothing under it in the
   working directory, the one of the installed data, if that exists: "/usr/share/twinbox/scenes/stack.yaml" for
   "scenes/stack.yaml". A name without "/" and "." is a scene's, too: "stack" for "scenes/stack.yaml", of the working
   directory or installed. Valid until the program ends. */
const char *installed_path(const char *path);

/* Calls found("scenes/stack.yaml", context) for each installed scene that installed_path() finds, in the order of names. */
void installed_scenes(void (*found)(const char *path, void *context), void *context);
