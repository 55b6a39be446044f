/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The settings of a method, as on the command line: `name:key=value,key=value`. A table has their keys, and the members
   that get their values:

     static const SettingSpec known[] = {{"k", "sweeps", SETTING_INT(Options, sweeps, 1, 100)}, {0}};
     Settings settings;
     if (settings_parse(&settings, "k=20", known, "--method", &error))
         settings_read(&settings, known, &options, &error); */
#pragma once
#include "base/base.h"

enum { SETTINGS_MAX = 16, SETTING_KEY_SIZE = 32, SETTING_VALUE_SIZE = 512 };

typedef struct Setting {
    char key[SETTING_KEY_SIZE];
    char value[SETTING_VALUE_SIZE];
} Setting;

typedef struct Settings {
    int count;
    Setting items[SETTINGS_MAX];
} Settings;

typedef enum SettingType {
    SETTING_IS_OWN, /* whoever has the table reads it with settings_get */
    SETTING_IS_INT,
    SETTING_IS_FLOAT,
    SETTING_IS_BOOL /* on|off */
} SettingType;

/* A key that a method knows ("*": any), what it means, and the member that gets its value; a table of these ends with
   {0}. */
typedef struct SettingSpec {
    const char *key, *summary;
    SettingType type;   /* type and what follows: one of the macros below */
    size_t at;          /* of the member, bytes */
    double least, most; /* numbers: bounds */
} SettingSpec;

#define SETTING_AT(T, member, is) (offsetof(T, member) + 0 * sizeof(_Generic(&((T *)NULL)->member, is * : 0)))
#define SETTING_OWN .type = SETTING_IS_OWN
#define SETTING_BOOL(T, member) .type = SETTING_IS_BOOL, .at = SETTING_AT(T, member, bool)
#define SETTING_INT(T, member, minimum, maximum) \
    .type = SETTING_IS_INT, .at = SETTING_AT(T, member, int), .least = (minimum), .most = (maximum)
#define SETTING_FLOAT(T, member, minimum, maximum) \
    .type = SETTING_IS_FLOAT, .at = SETTING_AT(T, member, float), .least = (double)(minimum), .most = (double)(maximum)

/* Parses "key=value,..." (may be empty). Every key must be in the table (NULL: none), once. `where` begins the
   message. */
bool settings_parse(Settings *settings, const char *text, const SettingSpec *known, const char *where, Error *error);

/* True if the table, which may be NULL, has the key. */
bool settings_known(const SettingSpec *known, const char *key);

/* The value of key, or NULL. */
const char *settings_get(const Settings *settings, const char *key);

/* Sets key to value unless it is set. False if there is no room. */
bool settings_default(Settings *settings, const char *key, const char *value);

/* Sets the members of *values for which a setting is given; the table has their types and bounds. */
bool settings_read(const Settings *settings, const SettingSpec *known, void *values, Error *error);

/* A copy of the `size` bytes of *standard with the settings, which the caller frees; NULL with error set. what: begins
   the message when memory is short. */
void *settings_make(const Settings *settings, const SettingSpec *known, const void *standard, size_t size,
                    const char *what, Error *error);
