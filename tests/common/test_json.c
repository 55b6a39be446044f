/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "testing.h"

#include "common/file.h"
#include "common/json.h"

#include <math.h>

enum { MAX_SIZE = 1 << 20 };

static const char *store(const char *text, size_t size) {
    Error error = {0};
    const char *path = temporary_path("values.json");
    assert_ok(file_write(path, text, size, &error), error);
    return path;
}

static Json read_good(const char *text) {
    Error error = {0};
    Json json;
    assert_ok(json_read(&json, store(text, strlen(text)), MAX_SIZE, &error), error);
    return json;
}

static void assert_refused(const char *text, size_t size, const char *why) {
    Error error = {0};
    Json json;
    if (json_read(&json, store(text, size), MAX_SIZE, &error)) fail_msg("read: %s", text);
    assert_error(error, ERROR_INPUT, why);
}

/* Every kind of value, key and layout. */
static void write_all_kinds(FILE *out, const void *context) {
    (void)context;
    JsonWriter writer = {.out = out};
    json_begin_object(&writer, NULL, JSON_LINES);
    json_put_text(&writer, "text", "a \"b\" \\ \n\x7f \xc3\xa4 \xf0\x9f\x93\xa6");
    json_put_text(&writer, "no UTF-8", "x\xffy");
    json_put_text(&writer, "none", NULL);
    json_begin_array(&writer, "numbers", JSON_ONE_LINE);
    json_put_number(&writer, NULL, 0.1);
    json_put_number(&writer, NULL, -1.0 / 3);
    json_put_number(&writer, NULL, NAN);
    json_put_int(&writer, NULL, -9007199254740991);
    json_begin_object(&writer, NULL, JSON_LINES);
    json_end(&writer);
    json_end(&writer);
    json_begin_array(&writer, "rows", JSON_LINES);
    for (int i = 0; i < 2; i++) {
        json_begin_object(&writer, NULL, JSON_ONE_LINE);
        json_put_bool(&writer, "first", i == 0);
        json_put_hash(&writer, "hash", 0xfeed);
        json_end(&writer);
    }
    json_end(&writer);
    json_begin_array(&writer, "empty", JSON_LINES);
    json_end(&writer);
    json_end(&writer);
}

static void what_is_written_has_this_form(void **state) {
    (void)state;
    Error error = {0};
    size_t size;
    const char *path = temporary_path("kinds.json");
    assert_ok(file_write_text(path, write_all_kinds, NULL, &error), error);
    char *text = file_read(path, MAX_SIZE, &size, &error);
    assert_string_equal(text, "{\n"
                              "  \"text\": \"a \\\"b\\\" \\\\ \\u000a\\u007f \xc3\xa4 \xf0\x9f\x93\xa6\",\n"
                              "  \"no UTF-8\": \"x\xef\xbf\xbdy\",\n"
                              "  \"none\": null,\n"
                              "  \"numbers\": [0.1, -0.3333333333333333, null, -9007199254740991, {}],\n"
                              "  \"rows\": [\n"
                              "    {\"first\": true, \"hash\": \"000000000000feed\"},\n"
                              "    {\"first\": false, \"hash\": \"000000000000feed\"}\n"
                              "  ],\n"
                              "  \"empty\": []\n"
                              "}\n");
    free(text);
}

static void what_is_written_can_be_read(void **state) {
    (void)state;
    Error error = {0};
    Json json;
    const char *path = temporary_path("kinds.json");
    assert_ok(file_write_text(path, write_all_kinds, NULL, &error), error);
    assert_ok(json_read(&json, path, MAX_SIZE, &error), error);
    const JsonValue *whole = json.values;
    assert_string_equal(json_need(&json, whole, "text", JSON_STRING, &error)->text,
                        "a \"b\" \\ \n\x7f \xc3\xa4 \xf0\x9f\x93\xa6");
    assert_int_equal(json_need(&json, whole, "none", JSON_NULL, &error)->kind, JSON_NULL);
    const JsonValue *numbers = json_need(&json, whole, "numbers", JSON_ARRAY, &error);
    const JsonValue *item = json_first(numbers);
    assert_int_equal(numbers->count, 5);
    assert_true(item->number == 0.1);
    item = json_next(numbers, item);
    assert_true(item->number == -1.0 / 3);
    item = json_next(numbers, json_next(numbers, item));
    assert_true(item->number == -9007199254740991);
    item = json_next(numbers, item);
    assert_null(json_first(item));
    assert_null(json_next(numbers, item));
    const JsonValue *rows = json_need(&json, whole, "rows", JSON_ARRAY, &error);
    int found = 0;
    for (const JsonValue *row = json_first(rows); row != NULL; row = json_next(rows, row), found++)
        assert_int_equal(json_member(row, "first")->kind, found == 0 ? JSON_TRUE : JSON_FALSE);
    assert_int_equal(found, 2);
    assert_int_equal(json_need(&json, whole, "empty", JSON_ARRAY, &error)->count, 0);
    json_free(&json);
}

static void escapes_and_spaces_are_those_of_the_standard(void **state) {
    (void)state;
    Json json = read_good(" [ \"\\\"\\\\\\/\\b\\f\\n\\r\\t\\u00e4\\uD83D\\uDCE6\" ,\t-0.5E+1\r\n,0, 1e-2 ] ");
    const JsonValue *item = json_first(json.values);
    assert_string_equal(item->text, "\"\\/\b\f\n\r\t\xc3\xa4\xf0\x9f\x93\xa6");
    item = json_next(json.values, item);
    assert_true(item->number == -5);
    item = json_next(json.values, item);
    assert_true(item->number == 0 && item->line == 2 && item->column == 2);
    assert_true(json_next(json.values, item)->number == 0.01);
    json_free(&json);
}

static void what_is_no_json_is_refused(void **state) {
    (void)state;
    static const struct {
        const char *text, *why;
    } cases[] = {
        {"", "values.json:1:1: error: no value"},
        {"{\n \"a\": 1,\n \"a\": 2}", "values.json:3:2: error: the key comes twice"},
        {"[1,]", "1:4: error: no value"},
        {"[1 2]", "',' or ']' is needed"},
        {"[1", "',' or ']' is needed"},
        {"{\"a\":1", "',' or '}' is needed"},
        {"{\"a\" 1}", "':' is needed"},
        {"{a:1}", "a key in quotes"},
        {"{\"a\":1,}", "a key in quotes"},
        {"[1] 2", "1:5: error: something behind"},
        {"[01]", "no value"},
        {"[+1]", "no value"},
        {"[.5]", "no value"},
        {"[1.]", "no value"},
        {"[-]", "no value"},
        {"[1e]", "no number"},
        {"[1e999]", "no number"},
        {"[nan]", "no value"},
        {"[NaN]", "no value"},
        {"[True]", "no value"},
        {"[0x10]", "',' or ']' is needed"},
        {"['a']", "no value"},
        {"[\"a", "no UTF-8 text"},
        {"[\"a\n\"]", "a control character"},
        {"[\"\\x\"]", "no escape"},
        {"[\"\\u12\"]", "no character"},
        {"[\"\\u0000\"]", "no character"},
        {"[\"\\ud800\"]", "no character"},
        {"[\"\\ud800\\u0041\"]", "no character"},
        {"[\"\\udc00\"]", "no character"},
        {"[\"\xff\"]", "no UTF-8 text"},
        {"[\"\xed\xa0\x80\"]", "no UTF-8 text"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        assert_refused(cases[i].text, strlen(cases[i].text), cases[i].why);
    assert_refused("[\"a\0b\"]", 7, "a control character");
    assert_refused("1\0", 2, "something behind");
}

static void depth_members_and_size_are_bounded(void **state) {
    (void)state;
    enum { DEEP = 100000 };
    Error error = {0};
    Json json;
    char *text = malloc(DEEP + 1), *at = text;
    memset(text, '[', DEEP);
    assert_refused(text, DEEP, "values.json:1:33: error: too many values inside each other");
    *at++ = '{';
    for (int i = 0; i <= JSON_MEMBERS_MAX; i++) at += sprintf(at, "%s\"%d\":0", i > 0 ? "," : "", i);
    *at++ = '}';
    assert_refused(text, (size_t)(at - text), "too many members");
    free(text);
    assert_false(json_read(&json, store("[1, 2]", 6), 5, &error));
    assert_error(error, ERROR_INPUT, "larger than 5 bytes");
}

/* No cut of a file is read beyond its end, or taken for the whole. */
static void every_cut_is_refused(void **state) {
    (void)state;
    static const char whole[] = "{\"a\": [1, \"\\u00e4\xc3\xa4\", {\"b\": null}], \"c\": -1.5e3}";
    for (size_t size = 0; size < sizeof whole - 1; size++) assert_refused(whole, size, "values.json:1:");
}

static void members_are_of_the_kind_that_is_needed(void **state) {
    (void)state;
    Error error = {0};
    int64_t value = 0;
    Json json = read_good("{\"n\": 7,\n \"half\": 0.5, \"big\": 1e17}");
    assert_ok(json_need_int(&json, json.values, "n", 0, 7, &value, &error), error);
    assert_int_equal(value, 7);
    assert_null(json_need(&json, json.values, "m", JSON_NUMBER, &error));
    assert_error(error, ERROR_INPUT, "values.json:1:1: error: \"m\" is missing");
    error = (Error){0};
    assert_null(json_need(&json, json.values, "half", JSON_STRING, &error));
    assert_error(error, ERROR_INPUT, "values.json:2:10: error: \"half\" is not a text");
    static const char *const wrong[] = {"half", "big", "n"};
    for (int i = 0; i < 3; i++) {
        error = (Error){0};
        assert_false(json_need_int(&json, json.values, wrong[i], -6, 6, &value, &error));
        assert_error(error, ERROR_INPUT, "is not a whole number from -6 to 6");
    }
    json_free(&json);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_written_has_this_form),
        cmocka_unit_test(what_is_written_can_be_read),
        cmocka_unit_test(escapes_and_spaces_are_those_of_the_standard),
        cmocka_unit_test(what_is_no_json_is_refused),
        cmocka_unit_test(depth_members_and_size_are_bounded),
        cmocka_unit_test(every_cut_is_refused),
        cmocka_unit_test(members_are_of_the_kind_that_is_needed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
