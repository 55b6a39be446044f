/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the reader adds to jansson: places, limits, and walking containers without reading beyond the file. */
#include "owned.h"

#include "base/json.h"

OWNED_VALUE(JsonReader, json_read_close)

enum { MAX_SIZE = 1 << 20 };

static const char *store(const char *text, size_t size) {
    return write_bytes(temporary_path("values.json"), text, size);
}

static JsonReader open_text(const char *text, size_t size) {
    Error error = {0};
    JsonReader reader;
    assert_ok(json_read_open(&reader, store(text, size), MAX_SIZE, &error), error);
    return reader;
}

/* Reads a file that is an array of any values. */
static bool read_array(JsonReader *reader, int *count, Error *error) {
    *count = 0;
    if (!json_read_char(reader, '[')) return json_read_error(reader, error, "no array");
    for (bool more = !json_read_char(reader, ']'); more; ++*count)
        if (json_read_value(reader, error) == NULL || !json_read_more(reader, ']', &more, error)) return false;
    return json_read_end(reader, error);
}

static void refuse(const char *text, size_t size, const char *why) {
    Error error = {0};
    int count;
    OWN(JsonReader) reader = open_text(text, size);
    if (read_array(&reader, &count, &error)) fail_msg("read: %s", text);
    assert_error(error, ERROR_INPUT, why);
}

TEST(values_are_read_one_by_one_with_their_places) {
    static const char text[] = " [ -0.5E+1 ,\r\n\t\"\xc3\xa4\\u00e4\",  {\n \"a\": [1,\n2]} ,\n7] ";
    bool more;
    OWN(JsonReader) reader = open_text(text, sizeof text - 1);
    assert_true(json_read_char(&reader, '['));
    assert_false(json_read_char(&reader, ']'));
    assert_true(json_real_value(json_read_value(&reader, &error)) == -5);
    assert_true(reader.value_line == 1 && reader.value_column == 4);
    assert_true(json_read_more(&reader, ']', &more, &error) && more);
    assert_string_equal(json_string_value(json_read_value(&reader, &error)), "\xc3\xa4\xc3\xa4");
    assert_true(reader.value_line == 2 && reader.value_column == 2);
    assert_true(json_read_more(&reader, ']', &more, &error) && more);
    const json_t *object = json_read_value(&reader, &error);
    assert_int_equal(json_array_size(json_object_get(object, "a")), 2);
    assert_true(reader.value_line == 2 &&
                reader.value_column == 14); /* characters: the first a-umlaut is one of them */
    assert_true(json_read_more(&reader, ']', &more, &error) && more);
    assert_int_equal(json_integer_value(json_read_value(&reader, &error)), 7);
    assert_int_equal(reader.value_line, 5);
    assert_true(json_read_more(&reader, ']', &more, &error) && !more);
    assert_ok(json_read_end(&reader, &error), error);
}

TEST(invalid_json_is_refused_with_its_place) {
    static const struct {
        const char *text, *why;
    } cases[] = {
        {"", "values.json:1:1: error: no array"},
        {"[0,\n  {\"a\": 1,\n \"a\": 2}]", "values.json:3:4: error: duplicate object key"},
        {"[0, {\"a\": 1, \"a\": 2}]", "values.json:1:16: error: duplicate object key"},
        {"[1,]", "values.json:1:4: error: unexpected token"},
        {"[1 2]", "values.json:1:4: error: ',' or ']' expected"},
        {"[1] 2", "values.json:1:5: error: end of file expected"},
        {"[0,\nNaN]", "values.json:2:3: error: invalid token"},
        {"[1e999]", "error: real number overflow"},
        {"[\"\\u0000\"]", "error: \\u0000 is not allowed"},
        {"[\"\\ud800\"]", "error: invalid Unicode"},
        {"[\"\xff\"]", "error: unable to decode byte 0xff"},
        {"[\"\xed\xa0\x80\"]", "error: unable to decode byte 0xed"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        refuse(cases[i].text, strlen(cases[i].text), cases[i].why);
    refuse("[\"a\0b\"]", 7, "control character 0x0");
    refuse("[1]\0", 4, "end of file expected");
    refuse("[1,\0]", 5, "invalid token");
}

/* Terminal escape sequences in a file must not reach the terminal. */
TEST(messages_contain_nothing_of_the_file) {
    OWN(JsonReader) reader = open_text("[\x1b[31m]", 7);
    int count;
    assert_false(read_array(&reader, &count, &error));
    assert_null(strchr(error.message, 0x1b));
    assert_error(error, ERROR_INPUT, "values.json:1:2: error: invalid token");
}

/* A truncated file is never read beyond its end or accepted. */
TEST(every_truncated_file_is_refused) {
    static const char whole[] = "[{\"a\": [1, \"\\u00e4\xc3\xa4\", {\"b\": null}], \"c\": -1.5e3}, true, 12]";
    for (size_t size = 0; size < sizeof whole - 1; size++) refuse(whole, size, "values.json:1:");
}

/* `count` times a part, between a first and a last. */
static size_t repeat(char *text, const char *first, const char *part, size_t count, const char *last) {
    char *at = text + sprintf(text, "%s", first);
    size_t length = strlen(part);
    for (size_t i = 0; i < count; i++, at += length) memcpy(at, part, length);
    return (size_t)(at - text) + (size_t)sprintf(at, "%s", last);
}

TEST(size_depth_and_memory_of_a_value_are_limited) {
    FREED char *text = malloc(MAX_SIZE + 1);
    const size_t most = JSON_VALUE_SIZE;
    int count;
    JsonReader reader = open_text(text, repeat(text, "[\"", "x", most - 2, "\", 0]"));
    assert_ok(read_array(&reader, &count, &error), error);
    assert_int_equal(count, 2);
    json_read_close(&reader);
    refuse(text, repeat(text, "[0, \"", "x", most - 1, "\", 0]"), "1:5: error: a value must have at most 65536");
    /* The limit falls between characters of four bytes, and after each byte of one. */
    static const char *const firsts[] = {"[\"xxx", "[\"xx", "[\"x", "[\""};
    for (int i = 0; i < 4; i++)
        refuse(text, repeat(text, firsts[i], "\xf0\x9f\x93\xa6", most / 4 + 1, "\"]"), "a value must have at most");
    refuse(text, repeat(text, "[[", "{},", most / 4, "0]]"), "1:2: error: a value must take at most 1048576 bytes");
    refuse(text, repeat(text, "[", "[", 3000, ""), "1:2050: error: maximum parsing depth reached");
}

RUN_TESTS(NULL, NULL)
