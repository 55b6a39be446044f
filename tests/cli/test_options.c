/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The numbers of options. */
#include "testing.h"

#include "cli/options.h"

typedef struct Values {
    double full;
    float single;
} Values;

static const Option table[] = {{"--full", 0, "N", "A double", OPTION_DOUBLE(Values, full, 0, 1e12)},
                               {"--single", 0, "N", "A float", OPTION_FLOAT(Values, single, 0, 1e12)},
                               {0}};

static const CommandSpec spec = {.options = table, .help = "\v"};

static bool parse(Values *values, const char *option, const char *text, Error *error) {
    char name[16], value[64];
    snprintf(name, sizeof name, "%s", option);
    snprintf(value, sizeof value, "%s", text);
    return options_parse(&spec, 3, (char *[]){"test", name, value, NULL}, values, error);
}

/* A float has 24 bits: it would make 16777216 of 16777217. */
TEST(a_double_keeps_its_bits) {
    static const struct {
        const char *text;
        double value;
    } cases[] = {
        {"16777217", 16777217}, {"0.1", 0.1}, {"29.97", 29.97}, {"30000/1001", 30000.0 / 1001}, {"1e12", 1e12}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Values values = {0};
        assert_ok(parse(&values, "--full", cases[i].text, &error), error);
        assert_true(values.full == cases[i].value);
        assert_ok(parse(&values, "--single", cases[i].text, &error), error);
        assert_true(values.single == (float)cases[i].value);
    }
}

TEST(what_is_no_number_within_the_bounds_is_refused) {
    const char *const texts[] = {"",    "-1",  "1e13", "1/0", "1/",    "/2",      "1/2/3",
                                 "0x1", "nan", "inf",  "1 ",  "1e400", "1e12/0.5"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        Values values = {7, 7};
        assert_refused(parse(&values, "--full", texts[i], &error), "--full: error: '",
                       "' is not a number from 0 to 1e+12");
        assert_refused(parse(&values, "--single", texts[i], &error), "--single: error: '");
        assert_true(values.full == 7 && values.single == 7);
    }
}

RUN_TESTS(NULL, NULL)
