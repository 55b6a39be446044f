/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How far a picture may differ and still pass: the limits of a comparison, and rules that give them by name.

     Rules *rules = rules_read("expected/compare.yaml", error);
     Tolerance tolerance = {0};                            ... every pixel must be equal
     rules_override(rules, "stack_1.png", &tolerance);
     bool passes = tolerance_holds(&tolerance, &difference); */
#pragma once
#include "base/base.h"
#include "pixels/png.h"
#include "regression/image_compare.h"

#include <stdint.h>

/* Bits of Tolerance.given. */
typedef enum ToleranceLimit {
    LIMIT_TOLERANCE = 1 << 0,
    LIMIT_BEYOND = 1 << 1,
    LIMIT_ANTIALIAS = 1 << 2
} ToleranceLimit;

/* How many pixels may differ: a share of those that count, 0..1, or a number. A share passes in a long page what it
   does not pass in a small picture; a number is for marks of one size. */
typedef struct PixelLimit {
    double most;
    bool number;
} PixelLimit;

/* "0.01", a share, or "20px". False for anything else. */
bool pixel_limit_parse(PixelLimit *limit, const char *text);
#define PIXEL_LIMIT_FORM "a share from 0 to 1 or a number of pixels, such as 20px"

/* All that is given must hold. Members that are not given are 0. */
typedef struct Tolerance {
    unsigned given;
    int tolerance;     /* pixels that differ by at most this, 0..255, count as equal */
    PixelLimit beyond; /* of pixels that differ by more than `tolerance` */
    bool antialias;    /* ignore pixels along edges (antialias.h) */
} Tolerance;

/* Replaces in *tolerance what `over` gives. */
void tolerance_override(Tolerance *tolerance, const Tolerance *over);

bool tolerance_holds(const Tolerance *tolerance, const ImageDifference *difference);

/* "differences above 2 in at most 1% of the pixels, edges may move within a pixel"; "none". */
typedef struct ToleranceText {
    char text[160];
} ToleranceText;
ToleranceText tolerance_words(const Tolerance *tolerance);

/* Rules of a comparison: what the files of certain names may differ in. A YAML file:

     rules:
       - files: "stack_*"        # a glob of names, with their folder if they have one; * also stands for /
         tolerance: 3            # as the options of compare of these names
         beyond: 0.001           # or a number of pixels: 20px
         antialias: on
         masks:
           - rectangle: [0, 0, 320, 20]
           - picture: clock.png  # beside this file
           - colour: "#ff00ff"   # opaque pixels that have this colour in the expected picture

   Rules apply from top to bottom: a later one replaces the limits of an earlier one, and all masks count. */

#define RULES_NAME "compare.yaml" /* in the expected folder */

/* Of one file: each name is matched with each rule, and pictures stay in memory. */
enum { RULES_MAX = 256, RULES_MAX_PICTURES = 64 };

typedef struct Rules Rules;

/* ERROR_INPUT, with line and column, for anything that is not a rule: unknown keys, values out of range, masks that
   cannot be read. */
Rules *rules_read(const char *path, Error *error);
void rules_destroy(Rules *rules); /* NULL: does nothing */
const char *rules_path(const Rules *rules);

/* Finds the rules for each of the names. ERROR_INPUT, with the place of the rule, if one matches none of them. */
bool rules_check_names(const Rules *rules, const char *const *names, int count, Error *error);

/* What follows takes NULL for no rules. Replaces in *tolerance what the rules for this name give. */
void rules_override(const Rules *rules, const char *name, Tolerance *tolerance);

/* Whether the rules for this name have masks; mask_most_hidden() of all of them, and mask_draw(). */
bool rules_have_masks(const Rules *rules, const char *name);
double rules_most_hidden(const Rules *rules, const char *name, int width, int height);
bool rules_draw_masks(const Rules *rules, const char *name, const Image *expected, const char *path, uint8_t *masked,
                      Error *error);
