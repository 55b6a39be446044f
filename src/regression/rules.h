/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rules of a comparison: what the files of certain names may differ in. A YAML file:

     rules:
       - files: "stack_*"        # a glob of names, with their folder if they have one; * also stands for /
         tolerance: 3            # as the options of compare of these names
         beyond: 0.001
         fuzzy: [2, 0.01]
         flip: 0.01              # or: flip: {mean: 0.01, p99: 0.1}
         antialias: on
         masks:
           - rectangle: [0, 0, 320, 20]
           - picture: clock.png  # beside this file
           - colour: "#ff00ff"   # opaque pixels that have this colour in the expected picture

   Rules apply from top to bottom: a later one replaces the limits of an earlier one, and all masks count. */
#pragma once
#include "image/mask.h"
#include "regression/tolerance.h"

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

/* Replaces in *tolerance what the rules for this name give. */
void rules_override(const Rules *rules, const char *name, Tolerance *tolerance);

/* Whether the rules for this name have masks; mask_most_hidden() of all of them, and mask_draw(). */
bool rules_have_masks(const Rules *rules, const char *name);
double rules_most_hidden(const Rules *rules, const char *name, int width, int height);
bool rules_draw_masks(const Rules *rules, const char *name, const Image *expected, const char *path, uint8_t *masked,
                      Error *error);
