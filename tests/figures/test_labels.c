/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Placement of labels. */
#include "owned.h"

#include "figures/labels.h"
#include "figures/sketch.h"

static LabelField *field_10_by_10(void) {
    LabelField *field = calloc(1, sizeof *field);
    assert_non_null(field);
    field->frame = (PageBox){0, 0, 10, 10};
    return field;
}

TEST(labels_go_where_nothing_is) {
    FREED LabelField *field = field_10_by_10();
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
}

TEST(labels_stay_inside_the_frame) {
    FREED LabelField *field = field_10_by_10();
    PageBox box;
    assert_true(label_place(field, 9, 9.5, 0.5, 2, 1, false, &box));
    assert_true(box.right <= 10 && box.top <= 10);
    assert_false(label_place(field, 5, 5, 0.5, 11, 1, true, &box));
}

TEST(only_what_must_be_there_crosses_a_line) {
    FREED LabelField *field = field_10_by_10();
    PageBox box;
    for (int i = 0; i <= 20; i++) label_add_segment(field, (Segment){0, 0.5 * i, 10, 0.5 * i});
    assert_false(label_place(field, 5, 5, 1, 2, 1, false, &box));
    assert_true(label_place(field, 5, 5, 1, 2, 1, true, &box));
    /* But nothing covers a mark. */
    label_add_box(field, (PageBox){0, 0, 10, 10});
    assert_false(label_place(field, 5, 5, 1, 2, 1, true, &box));
}

RUN_TESTS(NULL, NULL)
