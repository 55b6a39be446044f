/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "testing.h"
#include "files.h"

#include "base/json.h"

enum { MAX_SIZE = 1 << 20 };

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

TEST(what_is_written_has_this_form) {
    const char *path = temporary_path("kinds.json");
    assert_ok(file_write_text(path, write_all_kinds, NULL, &error), error);
    assert_file(path, "{\n"
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
}

RUN_TESTS(NULL, NULL)
