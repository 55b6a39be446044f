/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The text of a manifest, for file_print(): the context is a Manifest, or a line of one. */
#pragma once
#include "render/manifest.h"

typedef struct ManifestLine {
    const Manifest *manifest;
    int index;
    PictureHashes hashes;
} ManifestLine;

/* Up to the first picture. */
void manifest_print_head(FILE *out, const void *manifest);

/* A picture, without what stands around it in the manifest. */
void manifest_print_line(FILE *out, const void *line);

/* The head and the lines of what is known. */
void manifest_print_journal(FILE *out, const void *manifest);

void manifest_print_whole(FILE *out, const void *manifest);
