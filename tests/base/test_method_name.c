/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Names of methods, whatever picture they are in. */
#include "testing.h"

#include "methods/methods.h"
#include "methods/names.h"

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

/* Where the file tells two runs apart, it is in the name. */
TEST(a_name_has_its_network_only_where_another_run_differs_by_it) {
    static const char *const texts[] = {"pair-net",
                                        "pair-net:network=far/away/net.npz",
                                        "pair-net:network=net.npz,k=3",
                                        "pair-net:k=3,network=/net.npz,more=2",
                                        "scene-net:network=a/stack.npz,net=off",
                                        "scene-net:network=a/stack.npz",
                                        "pair-net:k=3,network=b"};
    static const struct {
        int first, count, index;
        const char *name;
    } cases[] = {{1, 1, 0, "pair-net"},          {0, 2, 1, "pair-net:network=net.npz"},
                 {0, 2, 0, "pair-net"},          {1, 2, 0, "pair-net"},
                 {1, 2, 1, "pair-net:k=3"},      {3, 1, 0, "pair-net:k=3,more=2"},
                 {4, 2, 0, "scene-net:net=off"}, {4, 2, 1, "scene-net"},
                 {6, 1, 0, "pair-net:k=3"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char name[64];
        method_name_among(name, sizeof name, texts + cases[i].first, cases[i].count, cases[i].index);
        assert_string_equal(name, cases[i].name);
    }
}

RUN_TESTS(NULL, NULL)
