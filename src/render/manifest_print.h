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

/* Bytes of the longest line of a picture. */
enum { MANIFEST_LINE_SIZE = 640 };

/* The index of the frame that a line, without indentation and comma, lists, and its hashes as far as the line has any;
   -1: the line lists no frame. */
int manifest_line_read(const char *line, size_t length, PictureHashes *hashes);
