/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds the scenes that `cmake --install` put beside the program. */
#pragma once

/* A file or folder given on the command line: the path itself; but if it is relative and there is nothing under it in
   the working directory, the one of the installed data, if that exists: "/usr/share/twinbox/scenes/stack.yaml" for
   "scenes/stack.yaml". A name without "/" and "." is a scene's, too: "stack" for "scenes/stack.yaml", of the working
   directory or installed. Valid until the program ends. */
const char *installed_path(const char *path);

/* The name by which installed_path() found this path, the same in each installation: "scenes/stack.yaml". Of another
   path, itself. */
const char *installed_name(const char *path);
