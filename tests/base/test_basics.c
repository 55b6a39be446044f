/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Hashes, arrays and errors: the small parts. */
#include "owned.h"

#include "base/base.h"
#include "base/hash.h"

/* The step of FNV-1a, written out; the start value is the one that the reference trajectories define. */
TEST(fnv_is_xor_then_multiply) {
    uint64_t expected = ((FNV1A64_START ^ 'a') * 0x100000001b3ULL ^ 'b') * 0x100000001b3ULL;
    assert_true(hash_fnv1a64(FNV1A64_START, "ab", 2) == expected);
    assert_true(hash_fnv1a64(hash_fnv1a64(FNV1A64_START, "a", 1), "b", 1) == expected);
    assert_true(hash_fnv1a64(FNV1A64_START, "", 0) == FNV1A64_START);
}

/* The published value of XXH3 of nothing. */
TEST(xxh3_of_nothing) { assert_true(hash_xxh3("", 0) == 0x2d06800538d394c2ULL); }

TEST(arrays_grow_by_doubling_and_keep_their_items) {
    FREED void *items = NULL;
    size_t capacity = 0, grown = 0;
    for (size_t i = 0; i < 1000; i++) {
        size_t before = capacity;
        assert_true(array_reserve(&items, &capacity, i + 1, sizeof(int)));
        grown += capacity != before;
        ((int *)items)[i] = (int)i;
    }
    assert_true(grown <= 10);
    for (int i = 0; i < 1000; i++) assert_int_equal(((int *)items)[i], i);
    void *kept = items;
    assert_false(array_reserve(&items, &capacity, SIZE_MAX, sizeof(int)));
    assert_false(array_reserve(&items, &capacity, SIZE_MAX / 4, 8));
    assert_ptr_equal(items, kept);
}

TEST(the_first_error_stays) {
    assert_false(error_input(&error, "a.yaml:1:2", "mass is %d", 0));
    assert_false(error_system(&error, "b", "later"));
    assert_int_equal(error.kind, ERROR_INPUT);
    assert_string_equal(error.message, "a.yaml:1:2: error: mass is 0");
}

TEST(long_errors_lose_their_middle) {
    static char long_text[5000];
    memset(long_text, 'x', sizeof long_text - 1);
    memcpy(long_text, "begin", 5);
    memcpy(long_text + sizeof long_text - 4, "end", 3);
    Error other = {0};
    assert_refused(error_input(&error, long_text, "cannot be read"), "xend: error: cannot be read");
    assert_memory_equal(error.message, "beginxx", 7);
    assert_non_null(strstr(error.message, "x...x"));
    assert_false(error_system(&other, "file", "'%s' is too long", long_text));
    assert_error(other, ERROR_SYSTEM, "file: error: 'beginx");
    assert_error(other, ERROR_SYSTEM, "xend' is too long");
    assert_true(strlen(other.message) < sizeof other.message);
}

TEST(known_names_are_listed_once_and_whole) {
    NameList known = {0};
    Error none = {0};
    assert_false(error_unknown(&none, "--kind", "x", "a kind", &known));
    assert_string_equal(none.message, "--kind: error: 'x' is not a kind; known: none");
    static const char *const names[] = {"pair-net", "net", "pair-net", "scene", "net"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) name_list_add(&known, names[i]);
    assert_false(error_unknown(&error, "--kind", "nett", "a kind", &known));
    assert_string_equal(error.message, "--kind: error: 'nett' is not a kind; did you mean 'net'?");
    Error far = {0}, long_known = {0}, long_given = {0};
    assert_false(error_unknown(&far, "--kind", "magic", "a kind", &known));
    assert_string_equal(far.message, "--kind: error: 'magic' is not a kind; known: pair-net, net, scene");
    /* Names that are too long for a suggestion. */
    static const char long_name[] = "0123456789012345678901234567890123456789";
    NameList long_names = {0};
    name_list_add(&long_names, long_name);
    assert_false(error_unknown(&long_known, "--kind", "012345678901234567890123456789", "a kind", &long_names));
    assert_non_null(strstr(long_known.message, "; known: 0123456789"));
    assert_false(error_unknown(&long_given, "--kind", long_name, "a kind", &known));
    assert_non_null(strstr(long_given.message, "; known: pair-net"));
    for (int i = 0; i < 1000; i++) {
        char name[24]; /* room for any int, for gcc */
        snprintf(name, sizeof name, "number-%03d", i);
        name_list_add(&known, name);
    }
    assert_true(known.used == strlen(known.text) && known.used < sizeof known.text);
    assert_int_equal(strlen(strrchr(known.text, ' ') + 1), strlen("number-000"));
}

TEST(text_is_cut_between_characters) {
    static const char text[] = "a\xC3\xA9\xF0\x9F\x98\x80z"; /* characters of 1, 2, 4 and 1 bytes */
    static const size_t lengths[] = {0, 1, 1, 3, 3, 3, 3, 7, 8, 8};
    for (size_t limit = 0; limit < sizeof lengths / sizeof lengths[0]; limit++)
        assert_int_equal(utf8_cut(text, limit), lengths[limit]);
    assert_int_equal(utf8_cut("\x80\xFF", 1), 1); /* what is no UTF-8 counts by bytes */
}

RUN_TESTS(NULL, NULL)
