/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/installed.h"
#include "cli/options.h"
#include "common/names.h"
#include "common/standard_io.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

bool option_text(const Option *option, const char *text, void *value, Error *error) {
    (void)option, (void)error;
    *(const char **)value = text;
    return true;
}

/* Only one input can be standard input. */
static bool check_input(const char *text, Error *error) {
    static int count;
    return !path_is_standard(text) || ++count == 1 ||
           error_input(error, "-", "only one file can be read from standard input");
}

bool option_path(const Option *option, const char *text, void *value, Error *error) {
    return check_input(text, error) && option_text(option, installed_path(text), value, error);
}

bool option_output(const Option *option, const char *text, void *value, Error *error) {
    return (!path_is_standard(text) || standard_output_reserve(error)) && option_text(option, text, value, error);
}

bool option_binary(const Option *option, const char *text, void *value, Error *error) {
    if (path_is_standard(text) && isatty(STDOUT_FILENO))
        return error_input(error, option->name, "binary data cannot go to a terminal; redirect standard output");
    return option_output(option, text, value, error);
}

bool option_flag(const Option *option, const char *text, void *value, Error *error) {
    (void)option, (void)text, (void)error;
    *(bool *)value = true;
    return true;
}

static bool read_int(const Option *option, const char *text, int64_t least, int64_t most, int64_t *value,
                     Error *error) {
    return parse_int(text, least, most, value) ||
           error_input(error, option->name, "'%.64s' is not a whole number from %lld to %lld", text, (long long)least,
                       (long long)most);
}

bool option_int(const Option *option, const char *text, void *value, Error *error) {
    int64_t parsed;
    if (!read_int(option, text, (int64_t)option->least, (int64_t)option->most, &parsed, error)) return false;
    *(int *)value = (int)parsed;
    return true;
}

bool option_seed(const Option *option, const char *text, void *value, Error *error) {
    int64_t parsed;
    if (!read_int(option, text, 0, UINT32_MAX, &parsed, error)) return false;
    *(uint64_t *)value = (uint64_t)parsed;
    return true;
}

bool option_float(const Option *option, const char *text, void *value, Error *error) {
    float parsed;
    if (!parse_float(text, &parsed) || (double)parsed < option->least || (double)parsed > option->most)
        return error_input(error, option->name, "'%.64s' is not a number from %g to %g", text, option->least,
                           option->most);
    *(float *)value = parsed;
    return true;
}

bool option_double(const Option *option, const char *text, void *value, Error *error) {
    float parsed = 0;
    if (!option_float(option, text, &parsed, error)) return false;
    *(double *)value = (double)parsed;
    return true;
}

/* The index of the name that `text` begins with, up to `length`; -1 with error set if there is no such name. */
static int find_name(const Option *option, const char *text, size_t length, Error *error) {
    NameList known = {0};
    char name[65];
    for (int i = 0; option->names[i] != NULL; i++) {
        if (strlen(option->names[i]) == length && strncmp(option->names[i], text, length) == 0) return i;
        name_list_add(&known, option->names[i]);
    }
    snprintf(name, sizeof name, "%.*s", (int)(length < sizeof name ? length : sizeof name), text);
    error_unknown(error, option->name, name, "a valid value", &known);
    return -1;
}

bool option_enum(const Option *option, const char *text, void *value, Error *error) {
    const int i = find_name(option, text, strlen(text), error);
    if (i >= 0) *(unsigned *)value = (unsigned)i;
    return i >= 0;
}

bool option_flags(const Option *option, const char *text, void *value, Error *error) {
    *(unsigned *)value = 0;
    for (;; text++) {
        const size_t length = strcspn(text, ",");
        const int i = find_name(option, text, length, error);
        if (i < 0) return false;
        *(unsigned *)value |= 1u << i;
        text += length;
        if (*text == '\0') return true;
    }
}

bool option_texts(const Option *option, const char *text, void *value, Error *error) {
    int *count = (int *)((char *)value - option->at + option->count_at);
    if (*count == (int)option->most) return error_input(error, option->name, "can be given at most %d times", *count);
    ((const char **)value)[(*count)++] = text;
    return true;
}

bool option_paths(const Option *option, const char *text, void *value, Error *error) {
    return check_input(text, error) && option_texts(option, installed_path(text), value, error);
}

bool option_range(const Option *option, const char *text, void *value, Error *error) {
    enum { MAX_VALUES = 100000 };
    return parse_range(text, MAX_VALUES, value) ||
           error_input(error, option->name, "'%.64s' is not A:B:STEP with A <= B, STEP > 0 and at most %d values", text,
                       MAX_VALUES);
}

bool option_set(const Option *option, const char *text, void *value, Error *error) {
    SceneSettings *settings = value;
    if (settings->count > SCENE_MAX_PARAMETERS) return true;
    SceneSetting *setting = &settings->items[settings->count++];
    const char *number = strchr(text, '=');
    const size_t length = number == NULL ? 0 : (size_t)(number - text);
    if (length == 0 || length >= sizeof setting->name || !parse_double(number + 1, &setting->value))
        return error_input(error, option->name, "'%.64s' is not NAME=VALUE with a number after '='", text);
    memcpy(setting->name, text, length);
    setting->name[length] = '\0';
    return true;
}
