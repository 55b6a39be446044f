/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The settings of a method. */
#include "base/settings.h"

#include "base/base.h"

#include <stdlib.h>
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
    if (!settings_known(known, setting.key) && !settings_known(known, "*")) {
        NameList keys = {0};
        for (; known != NULL && known->key != NULL; known++) name_list_add(&keys, known->key);
        return error_unknown(error, where, setting.key, "a setting", &keys);
    }
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

static bool read_number(const SettingSpec *spec, const char *text, void *value, Error *error) {
    int64_t whole;
    float number;
    if (spec->type == SETTING_IS_INT) {
        if (!parse_int(text, (int64_t)spec->least, (int64_t)spec->most, &whole))
            return error_input(error, spec->key, "must be a whole number from %d to %d (got '%.64s')", (int)spec->least,
                               (int)spec->most, text);
        *(int *)value = (int)whole;
        return true;
    }
    if (!parse_float(text, &number) || (double)number < spec->least || (double)number > spec->most)
        return error_input(error, spec->key, "must be a number from %g to %g (got '%.64s')", spec->least, spec->most,
                           text);
    *(float *)value = number;
    return true;
}

bool settings_read(const Settings *settings, const SettingSpec *known, void *values, Error *error) {
    for (const SettingSpec *spec = known; spec->key != NULL; spec++) {
        const char *text = settings_get(settings, spec->key);
        void *value = (char *)values + spec->at;
        if (text == NULL || spec->type == SETTING_IS_OWN) continue;
        if (spec->type != SETTING_IS_BOOL) {
            if (!read_number(spec, text, value, error)) return false;
            continue;
        }
        const bool on = *(bool *)value = strcmp(text, "on") == 0;
        if (!on && strcmp(text, "off") != 0)
            return error_input(error, spec->key, "must be on or off (got '%.64s')", text);
    }
    return true;
}

void *settings_make(const Settings *settings, const SettingSpec *known, const void *standard, size_t size,
                    const char *what, Error *error) {
    void *values = malloc(size);
    if (values == NULL) return error_memory(error, what), NULL;
    memcpy(values, standard, size);
    if (settings_read(settings, known, values, error)) return values;
    free(values);
    return NULL;
}
