/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/options.h"

#include <limits.h>
#include <string.h>

bool options_parse(const struct argp *argp, int argc, char **argv, void *input) {
    argp_err_exit_status = ERROR_INPUT;
    return argp_parse(argp, argc, argv, 0, NULL, input) == 0;
}

bool option_int(const char *option, const char *text, int64_t minimum, int64_t maximum, int *value, Error *error) {
    int64_t parsed;
    if (!parse_int(text, minimum, maximum, &parsed))
        return error_input(error, option, "'%s' is not a whole number from %lld to %lld", text, (long long)minimum,
                           (long long)maximum);
    *value = (int)parsed;
    return true;
}

bool option_seed(const char *option, const char *text, uint64_t *value, Error *error) {
    int64_t parsed;
    if (!parse_int(text, 0, UINT32_MAX, &parsed))
        return error_input(error, option, "'%s' is not a whole number from 0 to %lu", text, (unsigned long)UINT32_MAX);
    *value = (uint64_t)parsed;
    return true;
}

bool option_float(const char *option, const char *text, float minimum, float maximum, float *value, Error *error) {
    float parsed;
    if (!parse_float(text, &parsed) || parsed < minimum || parsed > maximum)
        return error_input(error, option, "'%s' is not a number from %g to %g", text, (double)minimum, (double)maximum);
    *value = parsed;
    return true;
}

void options_add_set(SetOptions *options, const char *text) {
    if (options->count <= SCENE_MAX_PARAMETERS) options->texts[options->count++] = text;
}

static bool read_setting(const char *text, SceneSetting *setting, Error *error) {
    const char *value = strchr(text, '=');
    size_t length = value == NULL ? 0 : (size_t)(value - text);
    if (length == 0 || length >= sizeof setting->name || !parse_double(value + 1, &setting->value))
        return error_input(error, "--set", "'%s' is not NAME=VALUE with a number after '='", text);
    memcpy(setting->name, text, length);
    setting->name[length] = '\0';
    return true;
}

Scene *options_read_scene(const char *path, const SetOptions *options, Error *error) {
    SceneSetting settings[SCENE_MAX_PARAMETERS + 1];
    for (int i = 0; i < options->count; i++)
        if (!read_setting(options->texts[i], &settings[i], error)) return NULL;
    return scene_read_with(path, settings, options->count, error);
}

bool option_range(const char *option, const char *text, FloatRange *range, Error *error) {
    enum { MAX_VALUES = 100000 };
    if (!parse_range(text, MAX_VALUES, range))
        return error_input(error, option, "'%s' is not A:B:STEP with A <= B, STEP > 0 and at most %d values", text,
                           MAX_VALUES);
    return true;
}

/* Splits text at the first `separator` into two whole numbers. An empty part leaves its number unchanged. */
static bool parse_two(const char *text, char separator, int64_t minimum, int64_t maximum, int64_t *first,
                      int64_t *second) {
    const char *middle = strchr(text, separator);
    size_t length = middle == NULL ? 0 : (size_t)(middle - text);
    char part[24];
    if (middle == NULL || length >= sizeof part) return false;
    memcpy(part, text, length);
    part[length] = '\0';
    return (length == 0 || parse_int(part, minimum, maximum, first)) &&
           (middle[1] == '\0' || parse_int(middle + 1, minimum, maximum, second));
}

bool option_size(const char *option, const char *text, int minimum, int maximum, int *width, int *height,
                 Error *error) {
    int64_t w = 0, h = 0;
    if (!parse_two(text, 'x', minimum, maximum, &w, &h) || w == 0 || h == 0)
        return error_input(error, option, "'%s' is not WIDTHxHEIGHT, each from %d to %d", text, minimum, maximum);
    *width = (int)w;
    *height = (int)h;
    return true;
}

bool option_frames(const char *option, const char *text, int *first, int *last, Error *error) {
    int64_t a = 0, b = -1;
    bool ok = strchr(text, ':') != NULL ? strcmp(text, ":") != 0 && parse_two(text, ':', 0, INT_MAX, &a, &b)
                                        : parse_int(text, 0, INT_MAX, &a) && ((b = a), true);
    if (!ok || (b != -1 && b < a))
        return error_input(error, option, "'%s' is not A:B with frame numbers 0 <= A <= B", text);
    *first = (int)a;
    *last = (int)b;
    return true;
}
