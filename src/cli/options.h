/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Option values: text -> number, with a message that names the option. */
#pragma once
#include "common/error.h"
#include "common/parse.h"
#include "scene/scene.h"

#include <argp.h>
#include <stdint.h>

/* argp_parse with exit status 2 on bad usage. Options may stand between arguments. False if a parser returned EINVAL
   with error set. */
bool options_parse(const struct argp *argp, int argc, char **argv, void *input);

bool option_int(const char *option, const char *text, int64_t minimum, int64_t maximum, int *value, Error *error);
bool option_seed(const char *option, const char *text, uint64_t *value, Error *error);

/* A float in [minimum, maximum], read by parse_float. */
bool option_float(const char *option, const char *text, float minimum, float maximum, float *value, Error *error);

/* The values of all --set options. Has room for one more than a scene can have, which the scene then refuses. */
typedef struct SetOptions {
    int count;
    const char *texts[SCENE_MAX_PARAMETERS + 1];
} SetOptions;

#define OPTION_SET(key, group) \
    { "set", (key), "NAME=VALUE", 0, "Value of one of the scene's parameters (may be repeated)", (group) }

void options_add_set(SetOptions *options, const char *text);

/* scene_read_with() these settings. */
Scene *options_read_scene(const char *path, const SetOptions *options, Error *error);

bool option_range(const char *option, const char *text, FloatRange *range, Error *error);

/* "1920x1080" */
bool option_size(const char *option, const char *text, int minimum, int maximum, int *width, int *height, Error *error);

/* "A:B", ":B", "A:" or "A": whole numbers, A <= B; *last is -1 if left open. */
bool option_frames(const char *option, const char *text, int *first, int *last, Error *error);
