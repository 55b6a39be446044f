/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What can be written in pictures and figures, and what is refused. */
#include "testing.h"

#include "base/base.h"
#include "pixels/type.h"

static void assert_all(unsigned first, unsigned last) {
    for (unsigned code = first; code <= last; code++)
        if (type_find(&type_regular, code) == NULL || type_find(&type_semibold, code) == NULL)
            fail_msg("U+%04X is missing", code);
}

TEST(alphabets_are_whole) {
    assert_all(0x20, 0x7E);
    assert_all(0xA0, 0xAC);  /* Latin-1, without the soft hyphen */
    assert_all(0xAE, 0x148); /* Latin Extended-A, without the deprecated U+0149 */
    assert_all(0x14A, 0x17F);
    assert_all(0x1EA0, 0x1EF9); /* Vietnamese */
    assert_all(0x391, 0x3A1);   /* Greek */
    assert_all(0x3A3, 0x3CE);
    assert_all(0x400, 0x45F); /* Cyrillic */
}

TEST(common_symbols_are_there) {
    assert_ok(
        type_check("\u2264\u2265\u00D7\u00B0\u00B5\u2192\u2190\u2013\u2014\u2026\u00B7\u00B2\u00B3\u00BD\u0394\u03C0"
                   "\u00B1\u2260\u2248\u221E\u2211\u221A\u2202\u222B\u03BC\u2126\u2212\u201E\u201C\u201D\u2018\u2019"
                   "\u00AB\u00BB\u2020\u2030\u20AC\u00A3\u00A5\u20BD\u2116\u2122\u00A9\u00AE\u2080\u2081\u2070\u2075"
                   "\u207B\u2022\u2032\u2033\u21D2\u2191\u2193\u2194\u00BC\u00BE\u2153\u25CF\u25A0\u2713",
                   "--title", &error),
        error);
}

TEST(a_letter_and_its_mark_are_one_character) {
    const char *text = "U\xCC\x88"
                       "bungsblatt"; /* U and a combining diaeresis */
    assert_int_equal(type_next_code(&text), 0xDC);
    assert_string_equal(text, "bungsblatt");
    assert_int_equal(type_advance("U\xCC\x88"), type_advance("\xC3\x9C"));
    text = "u\xCC\x88\xCC\x84x"; /* two marks: U+01D6 */
    assert_int_equal(type_next_code(&text), 0x1D6);
    assert_string_equal(text, "x");
    text = "\xD0\xB8\xCC\x86"; /* Cyrillic: U+0439 */
    assert_int_equal(type_next_code(&text), 0x439);
}

static void refuse(const char *text, const char *message) {
    Error error = {0};
    assert_refused(type_check(text, "--title", &error), message);
}

TEST(what_cannot_be_drawn_is_named) {
    refuse("1 \xE6\x97\xA5", "--title: error: the font has no character '\xE6\x97\xA5' (U+65E5)");
    refuse("\xF0\x9F\x98\x80", "(U+1F600)");
    refuse("a\nb", "control character U+000A");
    refuse("x\xCC\x88q\xCC\x88", "combining mark U+0308");
    refuse("\xCC\x88", "combining mark U+0308");
    refuse("ab\xFC", "byte 3 of the text is 0xFC, which is not UTF-8");
    refuse("\xC0\xAF", "byte 1 of the text is 0xC0");     /* overlong */
    refuse("\xED\xA0\x80", "byte 1 of the text is 0xED"); /* a surrogate */
    refuse("abc\xE4\xBD", "byte 4 of the text is 0xE4");  /* cut off */
    assert_true(type_check(NULL, "--title", &error) && type_check("", "--title", &error));
}

/* Every character is either drawn or refused. */
TEST(every_character_passes_or_fails) {
    int passed = 0;
    for (uint32_t code = 1; code < 0x30000; code++) {
        char text[8] = "";
        if (code >= 0xD800 && code < 0xE000) continue;
        utf8_put(text, code);
        const bool ok = type_check(text, "text", &error);
        assert_int_equal(ok, type_find(&type_regular, code) != NULL);
        passed += ok;
    }
    assert_int_equal(passed, type_glyph_count);
}

TEST(figures_carry_the_font_that_they_need) {
    assert_true(font_file_suffices("Pyramid: 5 \xC2\xB5s \xE2\x80\x93 \xE2\x88\x92"
                                   "1"));
    assert_false(font_file_suffices("\xC3\x9C"));
    assert_true(font_file(true).size < 16384);
    assert_true(font_file(false).size < 98304);
    assert_memory_equal(font_file(false).bytes, "OTTO", 4);
}

RUN_TESTS(NULL, NULL)
