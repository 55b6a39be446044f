/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Axes and placement of labels. */
#include "testing.h"

#include "sketch/label_place.h"
#include "sketch/log_axis.h"

#include <math.h>

static void an_axis_has_room_for_its_values(void **state) {
    (void)state;
    LogAxis axis = log_axis(1, 1000);
    assert_true(axis.low < 1 && axis.low > 0.5 && axis.high > 1000 && axis.high < 2000);
    /* One value has a decade around it. */
    axis = log_axis(30, 30);
    assert_near(log10(axis.high / axis.low), 1, 1e-12);
    assert_near(sqrt(axis.high * axis.low), 30, 1e-9);
    axis = (LogAxis){1, 100, 10, 30, false};
    assert_near(log_axis_place(&axis, 1), 10, 1e-12);
    assert_near(log_axis_place(&axis, 10), 20, 1e-12);
    assert_near(log_axis_place(&axis, 100), 30, 1e-12);
}

static void expect_tics(LogAxis axis, bool labelled, const char *expected) {
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    log_axis_write_tics(&axis, 'x', labelled, file);
    fclose(file);
    assert_string_equal(text, expected);
    free(text);
}

static void short_axes_have_tics_at_1_2_5(void **state) {
    (void)state;
    expect_tics((LogAxis){4.5, 22, 0, 1, false}, true,
                "set xtics scale 0.6,0.35 ('5' 5 0, '' 6 1, '' 7 1, '' 8 1, '' 9 1, '10' 10 0, '20' 20 0)\n");
    expect_tics((LogAxis){4.5, 22, 0, 1, false}, false,
                "set xtics scale 0.6,0.35 ('' 5 0, '' 6 1, '' 7 1, '' 8 1, '' 9 1, '' 10 0, '' 20 0)\n");
}

static void long_axes_have_tics_at_decades(void **state) {
    (void)state;
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    LogAxis axis = {0.008, 12, 0, 1, false};
    log_axis_write_tics(&axis, 'y', true, file);
    fclose(file);
    assert_non_null(strstr(text, "'0.01' 0.01 0"));
    assert_non_null(strstr(text, "'10' 10 0"));
    assert_non_null(strstr(text, "'' 0.02 1"));
    assert_null(strstr(text, "'2'"));
    free(text);
}

static LabelField *field_10_by_10(void) {
    LabelField *field = calloc(1, sizeof *field);
    assert_non_null(field);
    field->frame = (PageBox){0, 0, 10, 10};
    return field;
}

static void labels_go_where_nothing_is(void **state) {
    (void)state;
    LabelField *field = field_10_by_10();
    PageBox box;
    /* The right is preferred, then left, above, below. */
    assert_true(label_place(field, 5, 5, 1, 2, 1, false, &box));
    assert_near(box.left, 6, 1e-12);
    assert_near(box.right, 8, 1e-12);
    assert_near(box.bottom, 4.5, 1e-12);
    /* The first label occupies the right, and a line the left. */
    label_add_segment(field, (Segment){0, 0, 4, 10});
    label_add_segment(field, (Segment){0, 5, 4, 5});
    assert_true(label_place(field, 5, 5, 1, 2, 1, false, &box));
    assert_near(box.bottom, 6, 1e-12);
    assert_near(box.left, 4, 1e-12);
    free(field);
}

static void labels_stay_inside_the_frame(void **state) {
    (void)state;
    LabelField *field = field_10_by_10();
    PageBox box;
    assert_true(label_place(field, 9, 9.5, 0.5, 2, 1, false, &box));
    assert_true(box.right <= 10 && box.top <= 10);
    assert_false(label_place(field, 5, 5, 0.5, 11, 1, true, &box));
    free(field);
}

static void only_what_must_be_there_crosses_a_line(void **state) {
    (void)state;
    LabelField *field = field_10_by_10();
    PageBox box;
    for (int i = 0; i <= 20; i++) label_add_segment(field, (Segment){0, 0.5 * i, 10, 0.5 * i});
    assert_false(label_place(field, 5, 5, 1, 2, 1, false, &box));
    assert_true(label_place(field, 5, 5, 1, 2, 1, true, &box));
    /* But nothing covers a mark. */
    label_add_box(field, (PageBox){0, 0, 10, 10});
    assert_false(label_place(field, 5, 5, 1, 2, 1, true, &box));
    free(field);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_axis_has_room_for_its_values), cmocka_unit_test(short_axes_have_tics_at_1_2_5),
        cmocka_unit_test(long_axes_have_tics_at_decades),  cmocka_unit_test(labels_go_where_nothing_is),
        cmocka_unit_test(labels_stay_inside_the_frame),    cmocka_unit_test(only_what_must_be_there_crosses_a_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
