/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Invalid scene files, and the message for each mistake. */
#include "scene_text.h"

#include "base/yaml.h"

#define BOX "size: [1, 1], mass: 1, position: [0, 0]"
#define TEXT_64 "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa"

static const Refused keys[] = {
    {BASE, "1:1: error: a scene needs the key 'bodies'"},
    {"hello\n", "1:1: error: a scene must be a mapping of keys to values (got hello)"},
    {BASE GROUND "gravty: 1\n", "7:1: error: 'gravty' is not a key of a scene; did you mean 'gravity'?"},
    {BASE GROUND "\"a\\eb\": red\n", "7:2: error: 'a?b' is not a key of a scene; known: " SCENE_KEYS},
    {BASE GROUND ": 1\n", "7:1: error: expected a key; check the indentation"},
    {BODY("massa: 1"), "6:6: error: 'massa' is not a key of a body; did you mean 'mass'?"},
    {BASE "bodies:\n  - box\n", "6:5: error: a body must be a mapping of keys to values (got box)"},
    {BASE "bodies: []\n", "5:9: error: bodies must be a list of at least one body (got none)"},
};

static const Refused numbers[] = {
    {"gravity: 10\n", "1:10: error: gravity must be a list of two numbers (got 10)"},
    {"gravity: [0, -1e5]\n", "1:14: error: gravity must be from -10000 to 10000 m/s^2 (got -1e5)"},
    {"dt: NaN\n", "1:5: error: dt must be a number (got NaN)"},
    {"dt:\n", "1:1: error: dt must be a number (got nothing)"},
    {"dt: -1/60\n", "1:5: error: dt must be greater than 0 (got -0.0166666675 s, from -1/60)"},
    {"iterations: 2.5\n", "1:13: error: iterations must be a whole number from 1 to 1000000 (got 2.5)"},
    {"warm_starting: maybe\n", "1:16: error: warm_starting must be on or off (got maybe)"},
    {"dt: " TEXT_64 "\n", "1:5: error: dt must be a number (got aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa...)"},
};

static const Refused bodies[] = {
    {BODY("size: [1, 1], mass: -10, position: [0, 0]"), "6:26: error: mass must be greater than 0 (got -10)"},
    {BODY("position: [0, 2e6]"), "6:20: error: position must be from -1e+06 to 1e+06 m (got 2e6)"},
    {BODY("size: [1, 1], position: [0, 0]"), "6:5: error: a body needs the key 'mass', or 'static: true'"},
    {BODY(BOX ", static: true"), "6:26: error: a static body must not have a mass"},
    {BODY("static: on, size: [1, 1], position: [0, 0], velocity: [0, 0]"),
     "6:60: error: a static body must not have the key 'velocity'"},
    {BODY(BOX ", pattern: heap"), "6:56: error: pattern must be row, stack or pyramid (got heap)"},
    {BODY(BOX ", pattern: row, count: 3"), "6:5: error: a pattern needs the key 'spacing'"},
    {BODY(BOX ", count: 3"), "6:54: error: count needs the key 'pattern' beside it"},
    {BODY(BOX ", pattern: row, count: 3, spacing: [0, 5e5]"), NULL}, /* 0, 5e5, 1e6: just within reach */
    {BODY(BOX ", pattern: row, count: 4, spacing: [0, 5e5]"),
     "6:68: error: body 3 of the pattern is at (0, 1.5e+06), beyond 1e+06 m"},
};

#define TEXT_31 "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa"
#define NAME_IS "6:53: error: name must be a text of 1 to 31 bytes without control characters "

static const Refused names[] = {
    {BODY(BOX ", name: " TEXT_31), NULL},
    {BODY(BOX ", name: " TEXT_31 "\xc3\xa4"), NAME_IS "(got " TEXT_31 "\xc3\xa4)"},
    {BODY(BOX ", name: \"\""),
     "6:54: error: name must be a text of 1 to 31 bytes without control characters (got nothing)"},
    {BODY(BOX ", name: \"a\\nb\""),
     "6:54: error: name must be a text of 1 to 31 bytes without control characters (got a?b)"},
    {BODY(BOX ", name: a\xe2\x80\xae"
              "b"),
     NAME_IS "(got a?b)"},
};

static const Refused untils[] = {
    {BODY(BOX ", until: 300"), NULL},
    {BODY(BOX ", until: 0"), "6:54: error: until must be a whole number from 1 to 1000000 (got 0)"},
    {BODY(BOX ", until: 301"), "6:54: error: until 301 is after the last frame (frames: 300)"},
    {BODY(BOX ", until: 3}\n  - {" BOX), "6:54: error: only the last body may have an until"},
    {BODY(BOX ", until: 3") "bomb: {x: 1, y: 15, size: [1, 1], mass: 50}\n",
     "6:54: error: until cannot be combined with a bomb"},
    {BODY(BOX ", until: 3, pattern: row, count: 1, spacing: [1, 1]"),
     "6:54: error: until is only for a single body, not for a pattern"},
    {BODY("static: on, size: [1, 1], position: [0, 0], until: 1"),
     "6:57: error: a static body must not have the key 'until'"},
};

#define BOMB "x: 1, y: 15, size: [1, 1], mass: 50"

static const Refused bombs[] = {
    {BASE GROUND "bomb: {" BOMB ", angle: 1}\n", "7:45: error: 'angle' is not a key of a bomb; known: x, y, size, "
                                                 "mass, friction, rotation, spin, frame, velocity, impact_frames"},
    {BASE GROUND "bomb: {" BOMB ", frame: 300}\n", NULL},
    {BASE GROUND "bomb: {" BOMB ", frame: 301}\n", "7:7: error: the bomb's frame 301 is after the last (frames: 300)"},
    {BASE GROUND "bomb: {" BOMB ", velocity: {times_position: 1000}}\n",
     "7:55: error: the bomb's start velocity is (1000, 15000) m/s; the largest allowed component is 10000"},
};

#define FAMILY(x, rest) BASE GROUND "bomb: {x: " x ", y: 15, size: [1, 1], " rest "}\n"

static const Refused families[] = {
    {FAMILY("{from: -5, to: 5, value: 5}",
            "mass: {from: 1, to: 50}, rotation: {from: -1, to: 1}, spin: {from: 0, to: 2}"),
     NULL},
    {FAMILY("{from: 5, to: -5}", "mass: 50"), "7:18: error: x: from must be less than to (got 5 and -5)"},
    {FAMILY("{from: -5, to: 5, value: 6}", "mass: 50"), "7:36: error: x: value must be from -5 to 5 (got 6)"},
    {FAMILY("1", "mass: {from: 0, to: 50}"), "7:48: error: from must be greater than 0 (got 0)"},
    {FAMILY("{from: -5, to: 9000}", "mass: 50, velocity: {times_position: -1.5}"),
     "7:74: error: the bomb's start velocity is (-13500, -22.5) m/s; the largest allowed component is 10000"},
};

static const Refused networks[] = {
    {BASE GROUND "networks: {Pair: x.npz}\n", "7:12: error: a method's name must consist of a-z, 0-9 and - (got Pair)"},
    {BASE GROUND "networks: {a: \"b\\nc\"}\n", "7:16: error: a network must be the path of a file (got b?c)"},
    {BASE GROUND "networks: {a: b, b: b, c: b, d: b, e: b, f: b, g: b, h: b, "
                 "i: b, j: b, k: b, l: b, m: b, n: b, o: b, p: b, q: b}\n",
     "7:108: error: a scene must have at most 16 networks"},
    {BASE GROUND "networks: {a: " TEXT_64 TEXT_64 TEXT_64 TEXT_64 TEXT_64 TEXT_64 TEXT_64 TEXT_64 "}\n",
     "7:15: error: the path of a network must have at most 511 bytes"},
};

static const Refused yaml[] = {
    {"a: &x 1\n", "1:4: error: anchors (&) are not allowed"},
    {"a: *x\n", "1:4: error: aliases (*) are not allowed"},
    {"a: !x 1\n", "1:4: error: tags (!) are not allowed"},
    {"%YAML 1.1\n---\na: 1\n", "1:1: error: YAML directives are not allowed"},
    {BASE GROUND "---\n" BASE GROUND, "7:1: error: a file must hold one document only"},
    {"a: \"\\0\"\n", "1:5: error: a text must not contain the character \\0"},
    {"a: \x01\n", "1:4: error: control character 0x01"},
    {"a: x\xe2\x80\xa8y\n", "1:5: error: the character U+2028 is not allowed"},
    {"a: b\n\xc3\xa4\xff\n", "2:2: error: not UTF-8 text"},
    {"", "1:1: error: the file is empty"},
};

TEST(keys_are_checked) { CHECK_TABLE(keys); }
TEST(numbers_are_checked) { CHECK_TABLE(numbers); }
TEST(bodies_are_checked) { CHECK_TABLE(bodies); }
TEST(names_are_checked) { CHECK_TABLE(names); }
TEST(untils_are_checked) { CHECK_TABLE(untils); }
TEST(bombs_are_checked) { CHECK_TABLE(bombs); }
TEST(families_are_checked) { CHECK_TABLE(families); }
TEST(networks_are_checked) { CHECK_TABLE(networks); }
TEST(yaml_is_checked) { CHECK_TABLE(yaml); }

TEST(nul_bytes_are_refused) {
    static const char text[] = "dt: 1\0\niterations: 10\n";
    expect_refused_bytes(text, sizeof text - 1,
                         "1:6: error: control character 0x00\n"
                         "    1 | dt: 1?\n"
                         "      |      ^");
}

/* Words of rare mistakes are libyaml's. */
static const Refused syntax[] = {
    {"gravity: [0, -10\ndt: 1\n", "2:3: error: expected ',' or ']'"},
    {"a: {b: 1, c [1]}\n", "1:13: error: expected ',' or '}'"},
    {"a: 1\n b: 1\n",
     "2:3: error: a key cannot be here; check the indentation, the ':' above, and quotes around texts with ':'"},
    {"a: [1]\n b: 1\n", "2:2: error: expected a key; check the indentation"},
    {"a: b: c\n",
     "1:5: error: a key cannot be here; check the indentation, the ':' above, and quotes around texts with ':'"},
    {"a: - b\n", "1:4: error: an item '- ' cannot be here; check the indentation"},
    {"a:\n\t- b\n", "2:1: error: a tab must not indent; use blanks"},
    {"a: @b\n", "1:4: error: a text cannot begin with this character; use quotes"},
    {"a: ]\n", "1:4: error: expected a value"},
    {"a: \"\\q\"\n", "1:4: error: a text in double quotes has an unknown escape; write \\\\ for a backslash"},
    {"a: 1\nb\nc: 1\n", "2:1: error: a key needs a ':' and a blank behind it"},
    {"- a\nb: c\n", "2:1: error: expected '- ' for the next item; check the indentation"},
};

TEST(syntax_errors_have_place_and_excerpt) {
    CHECK_TABLE(syntax);
    assert_null(read_text("dt: 1\nframes: \"3\n", &error));
    assert_int_equal(error.kind, ERROR_INPUT);
    assert_int_equal(strncmp(behind_path(&error), "2:9: ", 5), 0);
    assert_non_null(strstr(error.message, "\n    2 | frames: \"3\n      | "));
    assert_int_equal(error.message[strlen(error.message) - 1], '^');
}

TEST(excerpt_points_at_the_value) {
    expect_refused("dt: 1/60\nframes: few\n", "2:9: error: frames must be a whole number from 1 to 1000000 (got few)\n"
                                              "    2 | frames: few\n"
                                              "      |         ^");
    expect_refused("dt: 1/60\r\nframes: few\r\n",
                   "2:9: error: frames must be a whole number from 1 to 1000000 (got few)\n"
                   "    2 | frames: few\n"
                   "      |         ^");
}

TEST(excerpt_keeps_tabs_and_counts_characters) {
    expect_refused("{\"\xc3\xa4\xe2\x82\xac\xf0\x9f\x98\x80\":\t1}\n",
                   "1:3: error: '\xc3\xa4\xe2\x82\xac\xf0\x9f\x98\x80' is not a key of a scene; known: " SCENE_KEYS "\n"
                   "    1 | {\"\xc3\xa4\xe2\x82\xac\xf0\x9f\x98\x80\":\t1}\n"
                   "      |   ^");
    expect_refused("{dt:\t\"\xc3\xa4\"\t}\n", "1:7: error: dt must be a number (got \xc3\xa4)\n"
                                              "    1 | {dt:\t\"\xc3\xa4\"\t}\n"
                                              "      |     \t ^");
    expect_refused("{\"\xc3\xa4\": 1\x07}\n", "1:8: error: control character 0x07\n"
                                              "    1 | {\"\xc3\xa4\": 1?}\n"
                                              "      |        ^");
}

TEST(byte_order_mark_is_no_character) {
    expect_refused("\xef\xbb\xbfhello\n", "1:1: error: a scene must be a mapping of keys to values (got hello)\n"
                                          "    1 | hello\n"
                                          "      | ^");
}

/* Marks that turn the direction of text could make a line look like another one. */
TEST(excerpt_hides_what_does_not_print) {
    expect_refused("dt: \"\xe2\x80\xae\xe2\x80\x8bx\"\n", "1:6: error: dt must be a number (got ??x)\n"
                                                          "    1 | dt: \"??x\"\n"
                                                          "      |      ^");
}

TEST(excerpt_of_a_long_line_is_cut_around_the_caret) {
    expect_refused(
        "{dt: 1, \"" TEXT_64 TEXT_64 "\": 1, " TEXT_64 TEXT_64 ": 2}\n",
        "1:10: error: 'aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa...' is not a key of a scene; known: " SCENE_KEYS "\n"
        "    1 | {dt: 1, \"" TEXT_64 "aaaaaaaaaaaaaaaaaaaaaaaaaaa...\n"
        "      |          ^");
    expect_refused("[" TEXT_64 TEXT_64 ", &a b, " TEXT_64 "]\n",
                   "1:132: error: anchors (&) are not allowed\n"
                   "    1 | ...aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa, &a b, "
                   "aaaaaaaaaaaaaaaaaaaaaaaa...\n"
                   "      |    "
                   "                                                                      ^");
}

RUN_TESTS(NULL, NULL)
