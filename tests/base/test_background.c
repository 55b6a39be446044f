/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "testing.h"

#include "base/machine.h"

enum { ITEMS = 1000 };

typedef struct Log {
    int count;
    int items[ITEMS];
} Log;

static bool note(void *context, void *item, Error *error) {
    Log *log = context;
    const int number = *(int *)item;
    log->items[log->count++] = number;
    return number != 500 || error_input(error, "item", "number %d", number);
}

/* Two buffers in turn, as a recorder gives them. */
static bool give(Background *background, int from, int to, Error *error) {
    static int buffers[2];
    bool done = true;
    for (int i = from; done && i < to; i++) {
        buffers[i % 2] = i;
        done = background_give(background, &buffers[i % 2], error);
    }
    return done;
}

TEST(items_are_done_in_order) {
    Log log = {0};
    Background *background = background_start(note, &log, &error);
    assert_ok(background != NULL, error);
    assert_ok(give(background, 0, 500, &error), error);
    assert_ok(background_wait(background, &error), error);
    assert_int_equal(log.count, 500);
    for (int i = 0; i < 500; i++) assert_int_equal(log.items[i], i);
    background_stop(background);
}

TEST(nothing_is_done_after_a_failure) {
    Log log = {0};
    Background *background = background_start(note, &log, &error);
    assert_ok(background != NULL, error);
    assert_refused(give(background, 400, ITEMS, &error) && background_wait(background, &error),
                   "item: error: number 500");
    background_stop(background);
    assert_int_equal(log.items[log.count - 1], 500);
}

TEST(it_stops_with_an_item_in_work) {
    Log log = {0};
    int item = 7;
    Background *background = background_start(note, &log, &error);
    assert_ok(background != NULL, error);
    assert_ok(background_give(background, &item, &error), error);
    background_stop(background);
    assert_int_equal(log.count, 1);
    background_stop(NULL);
}

RUN_TESTS(NULL, NULL)
