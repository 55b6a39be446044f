/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The settings of a method, as on the command line: `name:key=value,key=value`. */
#pragma once
#include "common/error.h"

enum { SETTINGS_MAX = 16, SETTING_KEY_SIZE = 32, SETTING_VALUE_SIZE = 512 };

typedef struct Setting {
    char key[SETTING_KEY_SIZE];
    char value[SETTING_VALUE_SIZE];
} Setting;

typedef struct Settings {
    int count;
    Setting items[SETTINGS_MAX];
} Settings;

/* A key that a method knows, and what it means; a table of these ends with a NULL key. */
typedef struct SettingSpec {
    const char *key, *summary;
} SettingSpec;

/* Parses "key=value,..." (may be empty). Every key must be in the table (NULL: none), once. `where` begins the message. */
bool settings_parse(Settings *settings, const char *text, const SettingSpec *known, const char *where, Error *error);

/* True if the table, which may be NULL, has the key. */
bool settings_known(const SettingSpec *known, const char *key);

/* The value of key, or NULL. */
const char *settings_get(const Settings *settings, const char *key);

/* Sets key to value unless it is set. False if there is no room. */
bool settings_default(Settings *settings, const char *key, const char *value);

/* The value of key as a whole number of [minimum, maximum]; *value is unchanged if the key is missing. */
bool settings_int(const Settings *settings, const char *key, int minimum, int maximum, int *value, Error *error);

/* The same for a number of [minimum, maximum]. */
bool settings_float(const Settings *settings, const char *key, float minimum, float maximum, float *value,
                    Error *error);

/* on|off, the same way. */
bool settings_bool(const Settings *settings, const char *key, bool *value, Error *error);
