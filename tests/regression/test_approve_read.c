/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "testing.h"

#include "regression/approve.h"

#define HEAD "{\"format\": \"twinbox compare 1\", \"expected\": \"old\", \"actual\": \"new\""
#define FILE_1 "{\"name\": \"1.png\", \"size\": 7, \"xxh3\": \"00000000000000ff\"}"
#define FILE_0 "{\"name\": \"0.png\", \"size\": 7, \"xxh3\": \"00000000000000ff\"}"

static const char *store(const char *text) { return write_bytes(temporary_path("results.json"), text, strlen(text)); }

TEST(failures_are_read_in_any_order_of_members) {
    ApprovalList list;
    const char *text = "{\"trajectories\": [], \"frames\": [\n"
                       "{\"failed\": true, \"shown\": false, \"expected\": " FILE_0 ", \"actual\": null},\n"
                       "{\"failed\": false, \"shown\": true, \"expected\": " FILE_0 ", \"actual\": " FILE_0 "},\n"
                       "{\"other\": [1], \"actual\": " FILE_1 ", \"shown\": true, \"failed\": true}],\n"
                       "\"extra\": [0, 1e-3], \"actual\": \"n\\u0065w\", \"expected\": \"old\",\n"
                       "\"format\": \"twinbox compare 1\"}\n";
    assert_ok(approval_read(&list, store(text), &error), error);
    assert_string_equal(list.expected, "old");
    assert_string_equal(list.actual, "new");
    assert_int_equal(list.count, 2);
    assert_string_equal(list.items[0].expected.name, "0.png");
    assert_null(list.items[0].actual.name);
    assert_true(list.items[0].expected.hash == 0xff && !list.items[0].shown);
    assert_string_equal(list.items[1].actual.name, "1.png");
    assert_null(list.items[1].expected.name);
    assert_true(list.items[1].shown);
    approval_free(&list);
}

TEST(invalid_results_are_refused_with_their_place) {
    static const struct {
        const char *text, *why;
    } cases[] = {
        {"[]", "results.json:1:1: error: not a report of twinbox compare"},
        {"{}", "results.json:1:2: error: unexpected token"},
        {"{\"format\": \"twinbox compare 2\"", "1:12: error: not a report"},
        {"{\"expected\": \"\"", "1:14: error: 'expected' must be a string of 1 to "},
        {HEAD "}", "results.json: error: 'frames' is missing"},
        {HEAD ",\n\"actual\": \"b\"}", "2:1: error: duplicate key"},
        {HEAD ",\n\"frames\": {}}", "2:11: error: 'frames' must be an array"},
        {HEAD ",\n\"frames\": [1]}", "2:12: error: a frame or trajectory must be an object"},
        {HEAD ",\n\"frames\": [\n  {\"failed\": 1}]}", "3:3: error: 'failed' must be true or false"},
        {HEAD ",\n\"frames\": [\n{\"failed\": true, \"shown\": true}]}",
         "3:1: error: an expected or an actual file is required"},
        {HEAD ",\n\"frames\": [\n{\"failed\": true, \"shown\": true, \"actual\": 1}]}",
         "3:1: error: 'actual' must be null or a file"},
        {HEAD ",\n\"frames\": [{\"failed\": true, \"shown\": true, \"actual\": " FILE_0 "}, {}]}",
         "error: 'failed' must be"},
        {HEAD ", \"frames\": [], \"trajectories\": []}\n}", "2:1: error: end of file expected"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        error = (Error){0};
        ApprovalList list;
        if (approval_read(&list, store(cases[i].text), &error)) fail_msg("read: %s", cases[i].text);
        assert_error(error, ERROR_INPUT, cases[i].why);
    }
}

/* One of thousands, each with its own name. */
TEST(a_file_that_is_named_twice_is_refused) {
    enum { COUNT = 3000, SIZE = 120 };
    for (int twice = 0; twice <= 1; twice++) {
        error = (Error){0};
        ApprovalList list;
        char *text = malloc(COUNT * SIZE + 200), *end = text;
        end += sprintf(end, "%s", HEAD ", \"trajectories\": [], \"frames\": [\n");
        for (int i = 0; i < COUNT; i++)
            end += sprintf(end,
                           "{\"failed\": true, \"shown\": true, \"actual\": {\"name\": \"%d.png\", \"xxh3\": "
                           "\"00000000000000ff\"}}%s",
                           twice && i == COUNT - 1 ? 7 : i, i < COUNT - 1 ? ",\n" : "]}");
        const char *path = store(text);
        free(text);
        if (approval_read(&list, path, &error) == twice) fail_msg("twice %d: %s", twice, error.message);
        if (twice) assert_error(error, ERROR_INPUT, "results.json: error: '7.png' is there twice");
        if (!twice) assert_int_equal(list.count, COUNT);
        if (!twice) approval_free(&list);
    }
}

RUN_TESTS(NULL, NULL)
