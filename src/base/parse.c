/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers from text, and the settings of a method. */
#include "base/base.h"

#include <errno.h>
#include <inttypes.h>
#include <locale.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *skip_sign(const char *text) { return *text == '+' || *text == '-' ? text + 1 : text; }

static const char *skip_digits(const char *text) {
    while (*text >= '0' && *text <= '9') text++;
    return text;
}

/* End of the decimal number that text begins with, or NULL. strtof alone would also accept blanks, hexadecimal, inf and
   nan. */
static const char *decimal_end(const char *text) {
    const char *whole = skip_sign(text), *end = skip_digits(whole);
    ptrdiff_t digits = end - whole;
    if (*end == '.') {
        const char *fraction = end + 1;
        end = skip_digits(fraction);
        digits += end - fraction;
    }
    if (digits == 0) return NULL;
    if (*end == 'e' || *end == 'E') {
        const char *exponent = skip_sign(end + 1);
        end = skip_digits(exponent);
        if (end == exponent) return NULL;
    }
    return end;
}

/* strtof and strtod use the decimal point of the thread's locale, so the C locale is set meanwhile. */
static locale_t enter_c_locale(void) {
    locale_t c = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    return c == (locale_t)0 ? c : uselocale(c);
}

static void leave_c_locale(locale_t previous) { freelocale(uselocale(previous)); }

/* Each width is rounded once, from the text: a float by way of double would be rounded twice. */
typedef struct Number {
    float single;
    double full;
} Number;

/* The number of a text that is known to begin with a decimal. */
static bool parse_convert(const char *text, Number *number) {
    locale_t previous = enter_c_locale();
    if (previous == (locale_t)0) return false;
    *number = (Number){strtof(text, NULL), strtod(text, NULL)};
    leave_c_locale(previous);
    return isfinite(number->single);
}

/* The decimal number up to `terminator`; *rest is what follows it. */
static bool take_number(const char *text, char terminator, Number *number, const char **rest) {
    const char *end = decimal_end(text);
    if (end == NULL || *end != terminator) return false;
    *rest = end + 1;
    return parse_convert(text, number);
}

bool parse_float(const char *text, float *value) {
    Number number, divisor;
    const char *rest;
    if (take_number(text, '\0', &number, &rest)) {
        *value = number.single;
        return true;
    }
    if (!take_number(text, '/', &number, &rest) || !take_number(rest, '\0', &divisor, &rest)) return false;
    if (divisor.single == 0 || !isfinite(number.single / divisor.single)) return false;
    *value = number.single / divisor.single;
    return true;
}

bool parse_double(const char *text, double *value) {
    Number number;
    const char *rest;
    if (!take_number(text, '\0', &number, &rest)) return false;
    *value = number.full;
    return true;
}

bool parse_leading_double(const char *text, double *value, const char **rest) {
    Number number;
    const char *end = decimal_end(text);
    if (end == NULL || !parse_convert(text, &number)) return false;
    *value = number.full;
    *rest = end;
    return true;
}

bool parse_leading_int(const char *text, int64_t minimum, int64_t maximum, int64_t *value, const char **rest) {
    const char *digits = skip_sign(text), *end = skip_digits(digits);
    if (end == digits) return false;
    errno = 0;
    intmax_t number = strtoimax(text, NULL, 10);
    if (errno != 0 || number < minimum || number > maximum) return false;
    *value = number;
    *rest = end;
    return true;
}

bool parse_int(const char *text, int64_t minimum, int64_t maximum, int64_t *value) {
    int64_t number;
    const char *rest;
    const bool whole = parse_leading_int(text, minimum, maximum, &number, &rest) && *rest == '\0';
    if (whole) *value = number;
    return whole;
}

/* In steps: a value this far past the end still counts as the end, one this near zero as zero. A, B and STEP are
   decimals and seldom exact in binary. */
static const double STEP_TOLERANCE = 1e-6;

bool parse_range(const char *text, int max_count, FloatRange *range) {
    Number first, last, step;
    const char *rest;
    if (!take_number(text, ':', &first, &rest) || !take_number(rest, ':', &last, &rest) ||
        !take_number(rest, '\0', &step, &rest))
        return false;
    if (!(step.full > 0) || first.full > last.full) return false;
    double count = floor((last.full - first.full) / step.full + STEP_TOLERANCE) + 1;
    if (!(count <= max_count)) return false;
    *range = (FloatRange){first.full, step.full, (int)count};
    return true;
}

float range_value(const FloatRange *range, int i) {
    double value = range->first + i * range->step;
    return fabs(value) < STEP_TOLERANCE * range->step ? 0 : (float)value;
}

/* The settings of a method. */

static const Setting *parse_find(const Settings *settings, const char *key) {
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
    if (!settings_known(known, setting.key) && !settings_known(known, "*"))
        return unknown_key(known, setting.key, where, error);
    if (parse_find(settings, setting.key) != NULL)
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
    const Setting *setting = parse_find(settings, key);
    return setting == NULL ? NULL : setting->value;
}

bool settings_default(Settings *settings, const char *key, const char *value) {
    if (parse_find(settings, key) != NULL) return true;
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
