/* SPDX-License-Identifier: GPL-3.0-or-later */
/* No text of a file or of a command line reaches a terminal as a command. */
#include "testing.h"

#include "base/base.h"

static void assert_shown(const char *text, VisibleLines lines, const char *expected) {
    char shown[256];
    assert_int_equal(visible_text(shown, sizeof shown, text, lines), strlen(expected));
    assert_string_equal(shown, expected);
}

TEST(what_is_obeyed_becomes_visible) {
    assert_shown("a \xc3\xa4 \xf0\x9f\x98\x80\\", VISIBLE_ONE_LINE, "a \xc3\xa4 \xf0\x9f\x98\x80\\");
    assert_shown("\33[31m\a\x7f\r\t\n", VISIBLE_ONE_LINE, "\\x1b[31m\\x07\\x7f\\x0d\\x09\\n");
    assert_shown("\33[31m\r\t\n", VISIBLE_LINES, "\\x1b[31m\\x0d\t\n");
    assert_shown("\xff\xc3 \x9b", VISIBLE_LINES, "\\xff\\xc3 \\x9b");
    /* CSI as one character, a right-to-left override, an isolate, the end of a line in Unicode. */
    assert_shown("\xc2\x9b \xe2\x80\xae \xe2\x81\xa6 \xe2\x80\xa8", VISIBLE_LINES, "\\u009b \\u202e \\u2066 \\u2028");
}

/* Every byte alone, and all characters below U+3000: what is shown has no control and is shown as it is again. */
TEST(what_is_shown_stays) {
    for (unsigned c = 1; c < 0x3000; c++) {
        char text[4] = {(char)c}, shown[64], again[64];
        if (c >= 0x100 && c < 0x800) text[0] = (char)(0xc0 | c >> 6), text[1] = (char)(0x80 | (c & 63));
        if (c >= 0x800)
            text[0] = (char)(0xe0 | c >> 12), text[1] = (char)(0x80 | (c >> 6 & 63)), text[2] = (char)(0x80 | (c & 63));
        visible_text(shown, sizeof shown, text, VISIBLE_ONE_LINE);
        visible_text(again, sizeof again, shown, VISIBLE_ONE_LINE);
        assert_string_equal(again, shown);
        assert_int_equal(control_in_text(shown), 0);
    }
}

TEST(the_middle_goes_where_room_is_short) {
    char shown[24];
    for (int length = 0; length < 200; length++) {
        char text[256] = "begin";
        memset(text + 5, '\33', (size_t)length);
        strcpy(text + 5 + length, "end");
        const size_t got = visible_text(shown, sizeof shown, text, VISIBLE_ONE_LINE);
        assert_int_equal(got, strlen(shown));
        assert_true(got < sizeof shown);
        assert_memory_equal(shown, "begin", 5);
        assert_string_equal(shown + got - 3, "end");
        assert_true(5 + 4 * length + 3 < (int)sizeof shown || strstr(shown, "...") != NULL);
    }
}

TEST(a_name_is_no_second_message) {
    Error name = {0}, key = {0}, output = {0}, where = {0};
    error_input(&name, "a\nb.yaml", "cannot open");
    assert_string_equal(name.message, "a\\nb.yaml: error: cannot open");
    error_input(&key, "a.yaml", "'%s' is not a key", "x\n::stop-commands::\33]0;title\a");
    assert_string_equal(key.message, "a.yaml: error: 'x\\n::stop-commands::\\x1b]0;title\\x07' is not a key");
    error_system(&output, "ffmpeg", "failed\n%s", "line 1\nline 2\33[2J\n\n");
    assert_string_equal(output.message, "ffmpeg: error: failed\nline 1\nline 2\\x1b[2J");
    error_system(&where, "ffmpeg", "failed\n%s", "");
    assert_string_equal(where.message, "ffmpeg: error: failed");
    error_add(&where, ", in scene %s", "\33");
    assert_string_equal(where.message, "ffmpeg: error: failed, in scene \\x1b");
}

TEST(controls_are_found) {
    assert_int_equal(control_in_text("a \xc3\xa4 \xff"), 0);
    assert_int_equal(control_in_text("a\nb"), '\n');
    assert_int_equal(control_in_text("a\x7f"), 0x7f);
    assert_int_equal(control_in_text("\xc2\x9b"), 0x9b);
    assert_int_equal(control_in_text("a\xe2\x80\xae"), 0x202e);
    assert_int_equal(control_in_text("\xe2\x81\xa6"), 0x2066);
}

RUN_TESTS(NULL, NULL)
