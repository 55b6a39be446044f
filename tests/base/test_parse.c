/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers from text: what is taken, what is refused, and to which float it rounds. */
#include "testing.h"

#include "base/base.h"

#include <locale.h>

static float parsed(const char *text) {
    float value = 0;
    if (!parse_float(text, &value)) fail_msg("'%s' is refused", text);
    return value;
}

TEST(decimals_round_to_the_nearest_float) {
    static const char *const texts[] = {"0",   "1",    "-1",    "+2.5",         ".5",    "5.",
                                        "1e3", "1E-3", "-0.05", "3.4028235e38", "1e-45", "0.1"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) assert_true(parsed(texts[i]) == strtof(texts[i], NULL));
    assert_true(signbit(parsed("-0")));
    assert_true(parsed("1e-60") == 0);
}

/* Just above the middle between 1 and its successor 1 + 2^-23, by less than a double can tell. */
TEST(decimals_round_once) {
    const char *text = "1.000000059604644775390625000000000001";
    assert_true((float)strtod(text, NULL) == 1);
    assert_true(parsed(text) == nextafterf(1, 2));
}

TEST(fractions_divide_in_float) {
    assert_true(parsed("1/60") == 1.0F / 60.0F);
    assert_true(parsed("-1/0.3") == -1.0F / 0.3F);
}

TEST(what_is_no_decimal_is_refused) {
    static const char *const texts[] = {
        "",      " 1",   "1 ",   "\t1", "1x",    "0x10", "inf",        "-inf",      "nan",     "infinity",
        ".",     "+",    "-",    "e5",  "1e",    "1e+",  "1,5",        "--1",       "1e39",    "-1e39",
        "1/0",   "1/-0", "1/",   "/2",  "1/2/3", "1/ 2", "1e38/1e-38", "1e39/1e39", "1/1e-60", "1e99999999999999999999",
        "1_000", "1..2", "0x1p3"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        float value = 7;
        if (parse_float(texts[i], &value)) fail_msg("'%s' is taken as %g", texts[i], (double)value);
        assert_true(value == 7);
    }
}

/* A thread's own locale stands for one of the user's: C.UTF-8 always exists but has the same point, so a
   German one is used where the machine has it. */
TEST(locale_does_not_matter) {
    locale_t german = newlocale(LC_ALL_MASK, "de_DE.UTF-8", (locale_t)0);
    locale_t other = german != (locale_t)0 ? german : newlocale(LC_ALL_MASK, "C.UTF-8", (locale_t)0);
    assert_true(other != (locale_t)0);
    locale_t previous = uselocale(other);
    assert_true(parsed("0.5") == 0.5F);
    float value;
    assert_false(parse_float("0,5", &value));
    assert_true(uselocale((locale_t)0) == other);
    uselocale(previous);
    freelocale(other);
}

TEST(whole_numbers) {
    int64_t value = 0;
    assert_true(parse_int("42", 0, 100, &value) && value == 42);
    assert_true(parse_int("-7", -7, 0, &value) && value == -7);
    assert_true(parse_int("+100", 0, 100, &value) && value == 100);
    assert_true(parse_int("-9223372036854775808", INT64_MIN, INT64_MAX, &value) && value == INT64_MIN);
    assert_true(parse_int("9223372036854775807", INT64_MIN, INT64_MAX, &value) && value == INT64_MAX);
    static const char *const texts[] = {
        "", " 1", "1 ", "1.0", "1e2", "0x1", "-", "101", "-1", "9223372036854775808", "99999999999999999999"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        value = 7;
        if (parse_int(texts[i], 0, 100, &value)) fail_msg("'%s' is taken", texts[i]);
        assert_int_equal(value, 7);
    }
    assert_false(parse_int("9223372036854775808", INT64_MIN, INT64_MAX, &value));
}

/* Every value of a range is the float of its decimal, as if it were written out. */
static void check_range(const char *text, double first, double step, int decimals, int count) {
    FloatRange range;
    assert_true(parse_range(text, 100000, &range));
    assert_int_equal(range.count, count);
    for (int i = 0; i < count; i++) {
        const char *decimal = printed("%.*f", decimals, first + i * step);
        if (range_value(&range, i) != strtof(decimal, NULL)) fail_msg("%s: value %d is not %s", text, i, decimal);
    }
}

TEST(doubles_keep_their_digits) {
    double value = 7;
    assert_true(parse_double("-0.1", &value));
    assert_true(value == -0.1);
    assert_true(parse_double("1/240", &value) && value == 1.0 / 240);
    static const char *const texts[] = {"", "nan", "1/0", "1e39/1", "1e20/1e-20", "1e39", " 1", "1,5", "0x1"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) assert_false(parse_double(texts[i], &value));
}

TEST(ranges_give_the_decimals) {
    check_range("-5:5:0.05", -5, 0.05, 2, 201);
    check_range("-0.3:0.3:0.1", -0.3, 0.1, 1, 7);
    check_range("0:1:0.001", 0, 0.001, 3, 1001);
    check_range("-1:1:0.0001", -1, 0.0001, 4, 20001);
    check_range("0:1:0.3", 0, 0.3, 1, 4);
    check_range("2:2:1", 2, 1, 0, 1);
    check_range("0:0.9:1", 0, 1, 0, 1);
}

TEST(bad_ranges_are_refused) {
    static const char *const texts[] = {
        "",        "1",      "1:2",    "1:2:",   ":2:1",          "1:2:3:4",        "2:1:0.5",    "1:2:0",    "1:2:-1",
        "1:2:nan", " 1:2:1", "1:2:1 ", "0:10:1", "0:1e300:1e299", "-1e308:1e308:1", "0:1:1e-320", "0:1e999:1"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        FloatRange range = {0};
        if (parse_range(texts[i], 10, &range)) fail_msg("'%s' is taken", texts[i]);
        assert_int_equal(range.count, 0);
    }
    FloatRange range;
    assert_true(parse_range("0:10:1", 11, &range));
}

RUN_TESTS(NULL, NULL)
