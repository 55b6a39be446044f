/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every method of the registry can be told apart in all pictures. */
#include "testing.h"

#include "methods/methods.h"

TEST(every_method_has_a_caption_and_a_look_of_its_own) {
    for (int i = 0; method_kinds[i].description != NULL; i++) {
        const MethodDescription *method = method_kinds[i].description;
        if (method->caption == NULL || method->look.colour == METHOD_NO_COLOUR)
            fail_msg("%s has no look", method->name);
        for (int k = 0; k < i; k++) {
            const MethodDescription *other = method_kinds[k].description;
            if (method->look.colour == other->look.colour && method->look.symbol == other->look.symbol)
                fail_msg("%s and %s have one look", other->name, method->name);
        }
    }
}

/* Frames and figures show these together. */
TEST(those_compared_most_differ_in_colour) {
    static const char *const names[] = {"engine", "pair-net", "momentum", "interior", "reference", "contact-net"};
    for (int i = 0; i < 6; i++)
        for (int k = 0; k < i; k++)
            assert_int_not_equal(method_describe(names[i])->look.colour, method_describe(names[k])->look.colour);
}

RUN_TESTS(NULL, NULL)
