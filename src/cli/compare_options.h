/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The options of twinbox compare. */
#pragma once
#include "image/mask.h"
#include "regression/tolerance.h"

typedef enum CompareAnnotations { ANNOTATE_NONE, ANNOTATE_GITHUB } CompareAnnotations;
typedef enum CompareMetadata { METADATA_REPORT, METADATA_STRICT } CompareMetadata;

typedef struct CompareOptions {
    const char *paths[2], *report;
    int count, megabytes;
    int max_pixels;
    Tolerance tolerance;
    const char *rules; /* a file; NULL: not given */
    bool flat;
    unsigned metadata;    /* CompareMetadata */
    unsigned annotations; /* CompareAnnotations */
    bool watch, json;
    Mask mask;
} CompareOptions;

/* Reads the command line. False with error set if it is wrong, or after --help. */
bool compare_options_parse(CompareOptions *options, int argc, char **argv, Error *error);
void compare_options_free(CompareOptions *options);
