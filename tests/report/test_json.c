/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is written comes back, and what is no JSON is refused with its line. */
#include "testing.h"

#include "report/json.h"

static void strings_come_back(void **state) {
    (void)state;
    static const char *const texts[] = {
        "", "plain", "\"quoted\" \\ /", "\b\f\n\r\t\x01\x1F", "</script><!-- &amp;", "\xC3\xA9 \xF0\x9F\x98\x80"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        char *text, value[64];
        size_t size;
        FILE *file = open_memstream(&text, &size);
        assert_non_null(file);
        json_put(file, texts[i]);
        fclose(file);
        assert_null(strpbrk(text, "<>&\n"));
        Error error = {0};
        JsonReader reader = json_reader("x.json", text, &error);
        assert_ok(json_string(&reader, value, sizeof value) && json_end(&reader), error);
        assert_string_equal(value, texts[i]);
        free(text);
    }
}

/* Sums what it finds under "n" of a list of objects, passes over the rest. */
static bool walk(const char *text, int *strings, Error *error) {
    JsonReader reader = json_reader("x.json", text, error);
    char key[16], value[16];
    int items = 0;
    *strings = 0;
    while (json_next_item(&reader, &items)) {
        int keys = 0;
        while (json_next_key(&reader, &keys, key, sizeof key)) {
            if (strcmp(key, "n") != 0)
                json_skip(&reader);
            else if (!json_null(&reader))
                *strings += json_string(&reader, value, sizeof value);
        }
    }
    return json_end(&reader);
}

static void what_is_not_asked_for_is_skipped(void **state) {
    (void)state;
    Error error = {0};
    int strings;
    const char *text = " [ {\"n\": \"a\", \"x\": [1, -2.5e+3, {\"y\": [true, null]}, \"\\\"]\"], \"n\": \"b\"},\n"
                       "{}, {\"n\" : null} ] \n";
    assert_ok(walk(text, &strings, &error), error);
    assert_int_equal(strings, 2);
}

static void mistakes_are_told_with_their_line(void **state) {
    (void)state;
    static const struct {
        const char *text, *told;
    } cases[] = {{"", "x.json:1: error: '[' is missing"},
                 {"[{\"n\": 1}]", "'\"' is missing"},
                 {"[{}\n{}]", "x.json:2: error: ',' is missing"},
                 {"[{\"n\" \"a\"}]", "':' is missing"},
                 {"[{\"n\": \"a", "a string does not end"},
                 {"[{\"n\": \"a\nb\"}]", "a string does not end"},
                 {"[{\"x\": \"a", "a string does not end"},
                 {"[{\"x\": \"a\\", "a string does not end"},
                 {"[{\"n\": \"\\x\"}]", "an escape"},
                 {"[{\"n\": \"\\u0000\"}]", "an escape"},
                 {"[{\"n\": \"\\ud800\"}]", "an escape"},
                 {"[{\"n\": \"0123456789abcdef\"}]", "a string of 16 bytes or more"},
                 {"[{\"x\": }]", "a value is missing"},
                 {"[] []", "something follows the end"},
                 {"[{\"x\": [[[[[[[[[[[[[[[[[1]]]]]]]]]]]]]]]]]}]", "nested too deep"}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        Error error = {0};
        int strings;
        assert_false(walk(cases[i].text, &strings, &error));
        assert_error(error, ERROR_INPUT, cases[i].told);
    }
}

/* Whatever is cut off or changed ends in an error or in the end, not beyond it. */
static void broken_texts_end(void **state) {
    (void)state;
    const char *whole = "[{\"n\": \"a\\u0041\", \"x\": [1, {\"y\": \"\\\\\"}]}, {\"n\": null}]";
    size_t size = strlen(whole);
    for (size_t i = 0; i < size; i++)
        for (int byte = 0; byte < 256; byte++) {
            char *text = malloc(size + 1); /* its end is watched */
            Error error = {0};
            int strings;
            memcpy(text, whole, size + 1);
            text[i] = (char)byte;
            bool ok = walk(text, &strings, &error);
            assert_true(ok == (error.kind == ERROR_NONE));
            free(text);
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(strings_come_back),
        cmocka_unit_test(what_is_not_asked_for_is_skipped),
        cmocka_unit_test(mistakes_are_told_with_their_line),
        cmocka_unit_test(broken_texts_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
