/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The text of a manifest, for file_print(). The context is a Manifest or a ManifestLine. */
#pragma once
#include "render/manifest.h"

typedef struct ManifestLine {
    const Manifest *manifest;
    int index;
    PictureHashes hashes;
} ManifestLine;

/* The text before the first picture. */
void manifest_print_head(FILE *out, const void *manifest);

/* One picture, without indentation and comma. */
void manifest_print_line(FILE *out, const void *line);

/* The head and the lines of known pictures. */
void manifest_print_journal(FILE *out, const void *manifest);

void manifest_print_whole(FILE *out, const void *manifest);
