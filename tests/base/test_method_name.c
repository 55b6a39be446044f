/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Names of methods, whatever picture they are in. */
#include "testing.h"

#include "methods/methods.h"

TEST(a_name_has_no_folders) {
    static const struct {
        const char *text, *name;
    } cases[] = {{"engine", "engine"},
                 {"momentum:k=20", "momentum:k=20"},
                 {"pair-net:network=/far/away/net.npz,k=3", "pair-net:network=net.npz,k=3"},
                 {"playback:launches=a/b.csv", "playback:launches=a/b.csv"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char name[64];
        assert_int_equal(method_name(name, sizeof name, cases[i].text), strlen(cases[i].name));
        assert_string_equal(name, cases[i].name);
    }
    char small[9];
    assert_int_equal(method_name(small, sizeof small, "momentum:k=20"), 8);
    assert_string_equal(small, "momentum");
    assert_int_equal(method_name_head("momentum:k=20"), 8);
    assert_int_equal(method_name_head("engine"), 6);
}

RUN_TESTS(NULL, NULL)
