/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is written is read; what does not fit is refused with file and reason. */
#include "owned.h"

#include "base/npz.h"
#include "subspace_nets.h"

TEST(what_is_written_is_read) {
    const char *path = temporary_path("net.npz");
    OWN(SubspaceNet) *net = subspace_net_by_hand(3);
    net->physics = 0x123456789abcdef;
    strcpy(net->command, "twinbox train");
    for (int i = 0; i < 9; i++) net->before[i] = (float)i;
    net->predictors[1].last.rows[5] = 0.25f;
    assert_ok(subspace_net_write(net, path, &error), error);
    OWN(SubspaceNet) *read = subspace_net_read(path, &error);
    assert_ok(read != NULL, error);
    assert_memory_equal(&read->shape, &net->shape, sizeof net->shape);
    assert_true(read->physics == net->physics);
    assert_string_equal(read->scene, "single");
    assert_string_equal(read->command, "twinbox train");
    assert_near(read->before[8], 8, 0);
    assert_near(read->predictors[1].last.rows[5], 0.25, 0);
    assert_near(read->basis[subspace_lanes(TEST_NUMBERS) + 1], 1, 0);
}

static void refuse(const SubspaceNet *net, const char *reason) {
    const char *path = temporary_path("bad.npz");
    Error error = {0};
    assert_ok(subspace_net_write(net, path, &error), error);
    assert_refused(subspace_net_read(path, &error), reason, "bad.npz");
}

TEST(bad_numbers_are_refused) {
    OWN(SubspaceNet) *net = subspace_net_by_hand(2);
    net->low[3] = 5000;
    refuse(net, "low: number 3 is 5000, above its high, 1000");
    net->low[3] = 0;
    net->before[2] = NAN;
    refuse(net, "before: number 2 is nan; it must be finite");
    net->before[2] = 0;
    net->predictors[0].first.rows[1] = INFINITY;
    refuse(net, "first_rows_0: number 1 is inf; it must be finite");
}

/* The arrays are those of the true shape; only the sizes lie. */
TEST(sizes_that_do_not_fit_are_refused) {
    OWN(SubspaceNet) *net = subspace_net_by_hand(2);
    const SubspaceShape shape = net->shape;
    net->shape.hidden = 24;
    refuse(net, "24 hidden units");
    net->shape = shape;
    net->shape.predictors[1] = 4;
    refuse(net, "do not fit together");
    net->shape = shape;
    net->shape.bodies = 100000;
    assert_refused(subspace_shape_check(&net->shape, "file", &error), "file: error: 100000 bodies");
}

TEST(another_kind_is_refused) {
    assert_refused(subspace_net_read(SOURCE_DIR "/scenes/networks/pair-net.npz", &error), "pair-net.npz", "subspace");
}

RUN_TESTS(NULL, NULL)
