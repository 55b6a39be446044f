/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The settings of a method. */
#include "common/settings.h"

#include "common/names.h"
#include "common/parse.h"

#include <stddef.h>
#include <stdio.h>
#include <string.h>

static const Setting *find(const Settings *settings, const char *key) {
    for (int i = 0; i < settings->count; i++)
        if (strcmp(settings->items[i].key, key) == 0) return &settings->items[i];
    return NULL;
}

bool settings_known(const SettingSpec *known, const char *key) {
    for (; known != NULL && known->key != NULL; known++)
        if (strcmp(known->key, key) == 0) return true;
    return false;
}

static bool unknown_key(const SettingSpec *known, const char *key, const char *where, Error *error) {
    NameList keys = {0};
    for (; known != NULL && known->key != NULL; known++) name_list_add(&keys, known->key);
    return error_unknown(error, where, key, "a setting", &keys);
}

/* One "key=value" of `length` bytes. The value may contain further '='. */
static bool parse_item(Settings *settings, const char *item, size_t length, const SettingSpec *known, const char *where,
                       Error *error) {
    Setting setting = {0};
    int shown = length < 64 ? (int)length : 64;
    const char *equals = memchr(item, '=', length);
    if (equals == NULL || equals == item || equals == item + length - 1)
        return error_input(error, where, "'%.*s' is not key=value", shown, item);
    size_t key_length = (size_t)(equals - item), value_length = length - key_length - 1;
    if (key_length >= sizeof setting.key || value_length >= sizeof setting.value)
        return error_input(error, where, "'%.*s' is too long; a key has at most %d and a value %d bytes", shown, item,
                           SETTING_KEY_SIZE - 1, SETTING_VALUE_SIZE - 1);
    memcpy(setting.key, item, key_length);
    memcpy(setting.value, equals + 1, value_length);
    if (!settings_known(known, setting.key)) return unknown_key(known, setting.key, where, error);
    if (find(settings, setting.key) != NULL)
        return error_input(error, where, "setting '%s' is given twice", setting.key);
    if (settings->count == SETTINGS_MAX) return error_input(error, where, "more than %d settings", SETTINGS_MAX);
    settings->items[settings->count++] = setting;
    return true;
}

bool settings_parse(Settings *settings, const char *text, const SettingSpec *known, const char *where, Error *error) {
    *settings = (Settings){0};
    if (*text == '\0') return true;
    for (;;) {
        size_t length = strcspn(text, ",");
        if (!parse_item(settings, text, length, known, where, error)) return false;
        if (text[length] == '\0') return true;
        text += length + 1;
    }
}

const char *settings_get(const Settings *settings, const char *key) {
    const Setting *setting = find(settings, key);
    return setting == NULL ? NULL : setting->value;
}

bool settings_default(Settings *settings, const char *key, const char *value) {
    if (find(settings, key) != NULL) return true;
    if (settings->count == SETTINGS_MAX || strlen(key) >= SETTING_KEY_SIZE || strlen(value) >= SETTING_VALUE_SIZE)
        return false;
    Setting *setting = &settings->items[settings->count++];
    strcpy(setting->key, key);
    strcpy(setting->value, value);
    return true;
}

bool settings_int(const Settings *settings, const char *key, int minimum, int maximum, int *value, Error *error) {
    const char *text = settings_get(settings, key);
    if (text == NULL) return true;
    int64_t number;
    if (!parse_int(text, minimum, maximum, &number))
        return error_input(error, key, "must be a whole number from %d to %d (got '%.64s')", minimum, maximum, text);
    *value = (int)number;
    return true;
}

bool settings_float(const Settings *settings, const char *key, float minimum, float maximum, float *value,
                    Error *error) {
    const char *text = settings_get(settings, key);
    if (text == NULL) return true;
    float number;
    if (!parse_float(text, &number) || number < minimum || number > maximum)
        return error_input(error, key, "must be a number from %g to %g (got '%.64s')", (double)minimum, (double)maximum,
                           text);
    *value = number;
    return true;
}

bool settings_bool(const Settings *settings, const char *key, bool *value, Error *error) {
    const char *text = settings_get(settings, key);
    if (text == NULL) return true;
    bool on = strcmp(text, "on") == 0;
    if (!on && strcmp(text, "off") != 0) return error_input(error, key, "must be on or off (got '%.64s')", text);
    *value = on;
    return true;
}
