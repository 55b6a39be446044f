/* SPDX-License-Identifier: GPL-3.0-or-later */
/* key=value settings: what they mean and what is refused. */
#include "testing.h"

#include "base/base.h"
#include "base/settings.h"

typedef struct Values {
    int iterations;
    float share;
    bool warm;
} Values;

static const SettingSpec known[] = {{"iterations", "sweeps", SETTING_INT(Values, iterations, 1, 12)},
                                    {"share", "of a step", SETTING_FLOAT(Values, share, 0.25f, 2)},
                                    {"network", "a file", SETTING_OWN},
                                    {"warm", "on or off", SETTING_BOOL(Values, warm)},
                                    {0}};
static const Values standard = {5, 0.5f, true};
static const SettingSpec none[] = {{0}};

static Settings parsed(const char *text) {
    Settings settings;
    Error error = {0};
    assert_ok(settings_parse(&settings, text, known, "method", &error), error);
    return settings;
}

TEST(values_are_found_by_key) {
    Settings settings = parsed("network=a=b.npz,iterations=12,warm=off");
    assert_int_equal(settings.count, 3);
    assert_string_equal(settings_get(&settings, "network"), "a=b.npz");
    assert_null(settings_get(&settings, "warms"));
    Values *values = settings_make(&settings, known, &standard, sizeof standard, "test", &error);
    assert_ok(values != NULL, error);
    assert_int_equal(values->iterations, 12);
    assert_false(values->warm);
    assert_true(values->share == 0.5f); /* not given */
    free(values);
    values = settings_make(&(Settings){0}, known, &standard, sizeof standard, "test", &error);
    assert_memory_equal(values, &standard, sizeof standard);
    free(values);
}

TEST(defaults_do_not_replace) {
    Settings settings = parsed("warm=on");
    assert_true(settings_default(&settings, "warm", "off"));
    assert_true(settings_default(&settings, "network", "n.npz"));
    assert_string_equal(settings_get(&settings, "warm"), "on");
    assert_string_equal(settings_get(&settings, "network"), "n.npz");
    settings.count = SETTINGS_MAX;
    assert_false(settings_default(&settings, "iterations", "1"));
    assert_true(settings_default(&settings, "network", "other"));
}

static void refuse(const char *text, const SettingSpec *table, const char *reason) {
    Settings settings;
    Error error = {0};
    if (settings_parse(&settings, text, table, "--method", &error)) fail_msg("'%s' is taken", text);
    assert_error(error, ERROR_INPUT, reason);
    assert_error(error, ERROR_INPUT, "--method: error: ");
}

TEST(bad_settings_are_refused) {
    refuse("iterations", known, "'iterations' is not key=value");
    refuse("iterations=", known, "'iterations=' is not key=value");
    refuse("=3", known, "not key=value");
    refuse("warm=on,", known, "not key=value");
    refuse(",warm=on", known, "not key=value");
    refuse("warm=on,warm=off", known, "'warm' is given twice");
    refuse("colour=red", known, "'colour' is not a setting; known: iterations, share, network, warm");
    refuse("colour=red", none, "'colour' is not a setting; known: none");
    char text[SETTING_VALUE_SIZE + 16];
    memset(text, 'x', sizeof text);
    text[sizeof text - 1] = '\0';
    memcpy(text, "network=", 8);
    refuse(text, known, "too long");
    text[SETTING_VALUE_SIZE + 7] = '\0';
    assert_int_equal(strlen(settings_get(&(Settings[]){parsed(text)}[0], "network")), SETTING_VALUE_SIZE - 1);
    text[7] = 'x';
    text[40] = '=';
    refuse(text, known, "too long");
}

TEST(too_many_settings_are_refused) {
    char keys[SETTINGS_MAX + 1][2], text[8 * (SETTINGS_MAX + 1)] = "";
    SettingSpec table[SETTINGS_MAX + 2] = {0};
    for (int i = 0; i <= SETTINGS_MAX; i++) {
        keys[i][0] = (char)('a' + i);
        keys[i][1] = '\0';
        table[i].key = keys[i];
        sprintf(text + strlen(text), "%s%s=1", i > 0 ? "," : "", keys[i]);
    }
    refuse(text, table, "more than 16 settings");
}

TEST(bad_values_are_refused) {
    static const char *const bad[][2] = {
        {"iterations=0", "iterations: error: must be a whole number from 1 to 12 (got '0')"},
        {"iterations=13", "iterations: error: must be a whole number from 1 to 12 (got '13')"},
        {"iterations=1.5", "iterations: error: must be a whole number from 1 to 12 (got '1.5')"},
        {"share=0.249", "share: error: must be a number from 0.25 to 2 (got '0.249')"},
        {"share=2.001", "share: error: must be a number from 0.25 to 2 (got '2.001')"},
        {"share=x", "share: error: must be a number from 0.25 to 2 (got 'x')"},
        {"warm=yes", "warm: error: must be on or off (got 'yes')"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        const Settings settings = parsed(bad[i][0]);
        assert_refused(settings_make(&settings, known, &standard, sizeof standard, "test", &error) != NULL, bad[i][1]);
    }
    const Settings settings = parsed("iterations=1,share=1.25,warm=off");
    Values values = standard;
    assert_ok(settings_read(&settings, known, &values, &error), error);
    assert_true(values.iterations == 1 && values.share == 1.25f && !values.warm);
}

RUN_TESTS(NULL, NULL)
