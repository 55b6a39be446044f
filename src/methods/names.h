/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How methods are named in all pictures: captions, legends, charts and figures. Their colours: pictures/colours.h.

   The name is the method's text as on the command line ("momentum:k=20"), without the folders of its files. */
#pragma once
#include <stddef.h>

/* Copies a method's text without the folders of its files, which differ between machines. Returns its length. */
size_t method_name(char *name, size_t size, const char *text);

/* The name of run `index` of a picture whose runs have these methods: without the file of its network, unless another
   of them has the same settings but for this file. */
size_t method_name_among(char *name, size_t size, const char *const *methods, int count, int index);

/* Length of the part of a name before its settings. */
size_t method_name_head(const char *name);
