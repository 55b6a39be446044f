/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rules of a comparison: what is refused, with its place, and what applies to a name; limits that hold or not. */
#include "made.h"

#include "regression/regression.h"

static Rules *read_text(const char *text, Error *error) {
    *error = (Error){.kind = ERROR_NONE};
    return rules_read(write_bytes(temporary_path("compare.yaml"), text, strlen(text)), error);
}

static void expect_refused(const char *text, const char *message) {
    Error error;
    Rules *rules = read_text(text, &error);
    if (rules != NULL) fail_msg("not refused, but expected: %s", message);
    assert_error(error, ERROR_INPUT, message);
}

TEST(mistakes_are_refused_with_their_place) {
    static const struct {
        const char *text, *message;
    } table[] = {
        {"rule: []\n", ":1:1: error: 'rule' is not a key of a file of rules; did you mean 'rules'?"},
        {"rules:\n  - tolerance: 1\n", ":2:5: error: a rule needs the key 'files'"},
        {"rules:\n  - files: a\n", ":2:5: error: a rule needs a limit or a mask"},
        {"rules:\n  - {files: [a], tolerance: 1}\n", ":2:13: error: files must be a glob of names"},
        {"rules:\n  - {files: a, tolerence: 1}\n",
         ":2:16: error: 'tolerence' is not a key of a rule; did you mean 'tolerance'?"},
        {"rules:\n  - {files: a, tolerance: 256}\n",
         ":2:27: error: tolerance must be a whole number from 0 to 255 (got 256)"},
        {"rules:\n  - {files: a, beyond: 1.5}\n",
         ":2:24: error: beyond must be a share from 0 to 1 or a number of pixels, such as 20px (got 1.5)"},
        {"rules:\n  - {files: a, antialias: 2}\n", ":2:27: error: antialias must be on or off (got 2)"},
        {"rules:\n  - {files: a, tolerance: 255}\n", ":2:5: error: a limit of this rule ignores every difference"},
        {"rules:\n  - {files: a, masks: [{colour: \"#000000\", rectangle: [0, 0, 1, 1]}]}\n",
         ":2:24: error: a mask must have one key"},
        {"rules:\n  - {files: a, masks: [{rectangle: [0, 0, 1]}]}\n",
         ":2:36: error: rectangle must be a list [X, Y, W, H]"},
        {"rules:\n  - {files: a, masks: [{colour: red}]}\n",
         ":2:33: error: colour must be \"#rrggbb\", in quotes (got red)"},
        {"rules:\n  - {files: a, masks: [{picture: none.png}]}\n", "none.png: error: "},
    };
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) expect_refused(table[i].text, table[i].message);
}

/* Rules, and pictures of masks. */
TEST(numbers_of_rules_are_limited) {
    enum { ROOM = 64 };
    static char many[(RULES_MAX + 2) * ROOM];
    const Image dot = {1, 1, (uint8_t[]){9, 9, 9, 255}, NULL};
    assert_ok(image_write_png(&dot, temporary_path("dot.png"), NULL, 0, &error), error);
    for (int over = 0; over <= 1; over++) {
        size_t used = (size_t)sprintf(many, "rules:\n");
        for (int i = 0; i < RULES_MAX + over; i++)
            used += (size_t)sprintf(many + used, "- {files: a, tolerance: %d}\n", i % 255);
        Rules *rules = over == 0 ? read_text(many, &error) : NULL;
        if (over == 0) assert_ok(rules != NULL, error);
        if (over == 1) expect_refused(many, ":2:1: error: at most 256 rules (got 257)");
        rules_destroy(rules);
        used = (size_t)sprintf(many, "rules:\n");
        for (int i = 0; i < RULES_MAX_PICTURES + over; i++)
            used += (size_t)sprintf(many + used, "- {files: a, masks: [{picture: dot.png}]}\n");
        rules = over == 0 ? read_text(many, &error) : NULL;
        if (over == 0) assert_ok(rules != NULL, error);
        if (over == 1) expect_refused(many, ":66:32: error: a file of rules must have at most 64 pictures");
        rules_destroy(rules);
    }
}

static const char text[] = "rules:\n"
                           "  - {files: \"*\", tolerance: 2, beyond: 0.5, antialias: on}\n"
                           "  - files: \"sub/*\"\n"
                           "    tolerance: 7\n"
                           "    antialias: off\n"
                           "    masks: [{rectangle: [1, 0, 1, 1]}]\n"
                           "  - {files: sub/a.png, masks: [{colour: \"#0aFF00\"}]}\n"
                           "  - {files: sub/c.png, beyond: 20px}\n";

TEST(later_rules_replace_limits) {
    Rules *rules = read_text(text, &error);
    assert_ok(rules != NULL, error);
    Tolerance a = {0}, b = {0};
    rules_override(rules, "b.png", &a);
    assert_int_equal(a.given, LIMIT_TOLERANCE | LIMIT_BEYOND | LIMIT_ANTIALIAS);
    assert_true(a.tolerance == 2 && a.beyond.most == 0.5 && a.antialias);
    rules_override(rules, "sub/a.png", &b);
    assert_true(b.tolerance == 7 && b.beyond.most == 0.5 && !b.antialias);
    assert_string_equal(tolerance_words(&b).text, "differences above 7 in at most 50% of the pixels");
    Tolerance c = {0};
    rules_override(rules, "sub/c.png", &c);
    assert_string_equal(tolerance_words(&c).text, "differences above 7 in at most 20 pixels");
    assert_string_equal(tolerance_words(&a).text,
                        "differences above 2 in at most 50% of the pixels, edges may move within a pixel");
    rules_destroy(rules);
}

TEST(all_masks_count) {
    Rules *rules = read_text(text, &error);
    Image *expected = image_sized(3, 1);
    uint8_t masked[3] = {0};
    memcpy(expected->pixels + 8, (const uint8_t[]){10, 255, 0, 255}, 4);
    assert_false(rules_have_masks(rules, "b.png"));
    assert_true(rules_have_masks(rules, "sub/b.png"));
    assert_ok(rules_draw_masks(rules, "sub/b.png", expected, "b.png", masked, &error), error);
    assert_true(masked[0] == IGNORED_NOT && masked[1] == IGNORED_MASK && masked[2] == IGNORED_NOT);
    assert_ok(rules_draw_masks(rules, "sub/a.png", expected, "a.png", masked, &error), error);
    assert_true(masked[0] == IGNORED_NOT && masked[2] == IGNORED_MASK);
    image_destroy(expected);
    rules_destroy(rules);
}

TEST(a_rule_without_files_is_refused) {
    static const char *const names[] = {"b.png", "sub/a.png", "sub/c.png"}, *const other[] = {"b.png", "sub/b.png"};
    Rules *rules = read_text(text, &error);
    assert_ok(rules_check_names(rules, names, 3, &error), error);
    assert_refused(rules_check_names(rules, other, 2, &error),
                   ":7:13: error: no picture has a name that matches 'sub/a.png'\n");
    rules_destroy(rules);
}

/* 100 pixels, of which 10 differ by at most 40, and 2 by more than 20. */
TEST(every_limit_that_is_given_must_hold) {
    static const ImageDifference difference = {.pixels = 10, .beyond = 2, .largest = 40, .counted = 100};
    static const struct {
        Tolerance tolerance;
        bool holds;
    } table[] = {
        {{0}, false},
        {{.given = LIMIT_ANTIALIAS, .antialias = true}, false},
        {{.given = LIMIT_BEYOND, .beyond = {2, true}}, true},
        {{.given = LIMIT_BEYOND, .beyond = {1, true}}, false},
        {{.given = LIMIT_TOLERANCE, .tolerance = 20}, false},
        {{.given = LIMIT_TOLERANCE | LIMIT_BEYOND, .tolerance = 20, .beyond = {.most = 0.02}}, true},
        {{.given = LIMIT_TOLERANCE | LIMIT_BEYOND, .tolerance = 20, .beyond = {.most = 0.01}}, false},
    };
    for (size_t i = 0; i < sizeof table / sizeof *table; i++)
        if (tolerance_holds(&table[i].tolerance, &difference) != table[i].holds) fail_msg("row %zu", i);
    assert_true(tolerance_holds(&(Tolerance){0}, &(ImageDifference){.counted = 100}));
}

RUN_TESTS(NULL, NULL)
