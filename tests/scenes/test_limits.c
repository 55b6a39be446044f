/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files that would eat time or memory. Files damaged at random: tests/fuzz. */
#include "scene_text.h"
#include "owned.h"

#include "base/yaml.h"

/* A text that grows. */
typedef struct Text {
    char *data;
    size_t size;
} Text;

static Text text_begin(const char *start) {
    Text text = {malloc(8 << 20), strlen(start)};
    assert_non_null(text.data);
    memcpy(text.data, start, text.size);
    return text;
}

static void text_append(Text *text, const char *more, int times) {
    for (int i = 0; i < times; i++) {
        memcpy(text->data + text->size, more, strlen(more));
        text->size += strlen(more);
    }
}

static void text_expect(Text *text, const char *message) {
    expect_refused_bytes(text->data, text->size, message);
    free(text->data);
}

static int text_body_count(Text *text) {
    Error error;
    OWN(Scene) *scene = read_bytes(text->data, text->size, &error);
    assert_ok(scene != NULL, error);
    int count = scene->body_count;
    free(text->data);
    return count;
}

/* start + unit * times (+ line end), refused with the message. */
static void expect_flood(const char *start, const char *unit, int times, const char *message) {
    Text text = text_begin(start);
    text_append(&text, unit, times);
    text_append(&text, "\n", 1);
    text_expect(&text, message);
}

TEST(ten_thousand_bodies_can_be_listed) {
    static const char body[] = "  - {size: [1, 1], mass: 10, position: [-12.345, 123.456], angle: 0.123, "
                               "velocity: [1.23, 4.56], spin: 0.123, friction: 0.25}\n";
    Text text = text_begin(BASE "bodies:\n");
    text_append(&text, body, 10000);
    text_append(&text, "overlaps: allowed\n", 1);
    assert_int_equal(text_body_count(&text), 10000);
}

#define ROW(count) "  - {pattern: row, count: " count ", spacing: [0, 1], size: [1, 1], mass: 1, position: [0, 0]}\n"
#define PYRAMID(rows) \
    "  - {pattern: pyramid, count: " rows ", spacing: [2, 2], size: [1, 1], mass: 1, position: [0, 0]}\n"

TEST(patterns_make_at_most_25000) {
    Text text = text_begin(BASE "bodies:\n" ROW("25000"));
    assert_int_equal(text_body_count(&text), 25000);
    text = text_begin(BASE GROUND PYRAMID("223") "overlaps: allowed\n");
    assert_int_equal(text_body_count(&text), 1 + 223 * 224 / 2);
    expect_refused(BASE GROUND ROW("25000"), "7:27: error: a scene must have at most 25000 bodies (got 25001)");
    expect_refused(BASE GROUND PYRAMID("224"), "7:31: error: a scene must have at most 25000 bodies (got 25201)");
    expect_refused(BASE GROUND PYRAMID("25000"), "7:31: error: a scene must have at most 25000 bodies (got 312512501)");
}

TEST(many_keys_are_refused) {
    Text text = text_begin("");
    for (int i = 0; i < 20000; i++) text.size += (size_t)sprintf(text.data + text.size, "k%d: 1\n", i);
    text_expect(&text, "65:1: error: a mapping must have at most 64 keys");
}

TEST(deep_nesting_is_refused) {
    static const char deep[] = "lists and mappings must be nested at most 8 deep";
    char message[128];
    expect_flood("", "[", 4000, (snprintf(message, sizeof message, "1:9: error: %s", deep), message));
    expect_flood("", "{a: ", 1000, (snprintf(message, sizeof message, "1:33: error: %s", deep), message));
    expect_flood("", "[\n ", 500000, (snprintf(message, sizeof message, "9:2: error: %s", deep), message));
}

TEST(floods_are_refused) {
    static const char key[] = "1:1: error: 'a' is not a key of a scene; known: " SCENE_KEYS;
    static const char empty[] = "1:1: error: the file is empty";
    expect_flood("a: ", "x", 300000, key);
    expect_flood("", "#\n", 100000, empty);
    expect_flood("bodies: [", "a,\n ", 300000, "219998:2: error: more than 220000 values in one file");
}

TEST(large_files_are_refused) {
    Text text = text_begin("#");
    text_append(&text, "\n#", SOURCE_MAX_SIZE / 2);
    assert_refused(read_bytes(text.data, text.size, &error), "larger than 1572864 bytes");
    free(text.data);
}

RUN_TESTS(NULL, NULL)
