/* SPDX-License-Identifier: GPL-3.0-or-later */
/* key=value settings: what they mean and what is refused. */
#include "testing.h"

#include "base/base.h"

static const SettingSpec known[] = {{"iterations", "sweeps"}, {"network", "a file"}, {"warm", "on or off"}, {0}};
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
    int iterations = 1;
    bool warm = true;
    Error error = {0};
    assert_ok(settings_int(&settings, "iterations", 1, 12, &iterations, &error), error);
    assert_int_equal(iterations, 12);
    assert_ok(settings_bool(&settings, "warm", &warm, &error), error);
    assert_false(warm);
}

TEST(missing_keys_leave_the_value) {
    Settings settings = parsed("");
    int iterations = 5;
    bool warm = true;
    Error error = {0};
    assert_true(settings_int(&settings, "iterations", 1, 10, &iterations, &error));
    assert_true(settings_bool(&settings, "warm", &warm, &error));
    assert_int_equal(iterations, 5);
    assert_true(warm);
}

TEST(a_number_is_read_in_its_range) {
    Settings settings = parsed("iterations=1.25");
    float value = 0;
    Error error = {0};
    assert_ok(settings_float(&settings, "iterations", 1, 2, &value, &error), error);
    assert_true(value == 1.25f);
    assert_ok(settings_float(&settings, "warm", 1, 2, &value, &error), error);
    assert_true(value == 1.25f);
    assert_refused(settings_float(&settings, "iterations", 0, 1, &value, &error),
                   "iterations: error: must be a number from 0 to 1 (got '1.25')");
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
    refuse("colour=red", known, "'colour' is not a setting; known: iterations, network, warm");
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
    Settings settings = parsed("iterations=0,warm=yes");
    int iterations = 5;
    bool warm = true;
    Error error = {0}, other = {0};
    assert_refused(settings_int(&settings, "iterations", 1, 10, &iterations, &error),
                   "iterations: error: must be a whole number from 1 to 10 (got '0')");
    assert_int_equal(iterations, 5);
    assert_false(settings_bool(&settings, "warm", &warm, &other));
    assert_error(other, ERROR_INPUT, "warm: error: must be on or off (got 'yes')");
    assert_true(warm);
}

int main(void) { return run_all_tests(NULL, NULL); }
