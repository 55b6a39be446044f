/* SPDX-License-Identifier: GPL-3.0-or-later */
#pragma once
#include "testing.h"

#include "engine/engine.h"

/* Two contact problems that are equal to the bit. */
static inline void assert_equal_problems(const ContactProblem *one, const ContactProblem *two) {
    assert_int_equal(one->body_count, two->body_count);
    assert_int_equal(one->contact_count, two->contact_count);
    assert_int_equal(one->bomb, two->bomb);
    assert_true(one->dt == two->dt);
    assert_memory_equal(one->bodies, two->bodies, (size_t)one->body_count * sizeof *one->bodies);
    assert_memory_equal(one->contacts, two->contacts, (size_t)one->contact_count * sizeof *one->contacts);
}
