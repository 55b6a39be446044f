/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files that are no .npz, or one made for harm: refused with the reason, before they cost time or memory. */
#include "made.h"

#include "files.h"

#include <zip.h>

/* A zip of one member with these bytes. */
static void write_member(const char *path, const char *name, const char *data, size_t size, zip_int32_t method) {
    remove(path);
    zip_t *archive = zip_open(path, ZIP_CREATE, NULL);
    assert_non_null(archive);
    zip_int64_t index = zip_file_add(archive, name, zip_source_buffer(archive, data, size, 0), 0);
    assert_int_equal(index, 0);
    assert_int_equal(zip_set_file_compression(archive, 0, method, 0), 0);
    assert_int_equal(zip_close(archive), 0);
}

static void expect_refused(const char *path, const char *reason) {
    Error error = {0};
    assert_refused(npz_open(path, &error), path, reason);
}

/* A file of one array with this dictionary and data_size bytes of data. */
static const char *write_head(const char *dictionary, size_t data_size) {
    const char *path = temporary_path("head.npz");
    FREED char *member = calloc(1, 10 + strlen(dictionary) + data_size);
    memcpy(member, "\x93NUMPY\1\0", 8);
    member[8] = (char)(strlen(dictionary) & 0xff);
    member[9] = (char)(strlen(dictionary) >> 8);
    memcpy(member + 10, dictionary, strlen(dictionary));
    write_member(path, "array.npy", member, 10 + strlen(dictionary) + data_size, ZIP_CM_STORE);
    return path;
}

static void expect_head_refused(const char *dictionary, size_t data_size, const char *reason) {
    const char *path = write_head(dictionary, data_size);
    if (reason == NULL)
        npz_close(npz_of(path));
    else
        expect_refused(path, reason);
}

/* What NumPy can write makes no other array of the file unreadable. */
static void expect_foreign(const char *dictionary, size_t data_size, const char *reason) {
    const char *path = write_head(dictionary, data_size);
    OWN(NpzFile) *file = npz_of(path);
    npz_convert(file);
    assert_true(npz_has(file, "array"));
    for (NpzType type = NPZ_FLOAT32; type <= NPZ_TEXT; type++)
        for (int rank = 0; rank <= NPZ_MAX_RANK; rank++) {
            int64_t shape[NPZ_MAX_RANK];
            Error error = {0};
            assert_refused(npz_shape(file, "array", type, rank, shape, &error), path, "'array' is ", reason);
        }
}

#define HEAD(type, order, shape) "{'descr': '" type "', 'fortran_order': " order ", 'shape': " shape ", }\n"

TEST(heads_are_read_strictly) {
    expect_head_refused(HEAD("<f4", "False", "(3, 2)"), 24, NULL);
    expect_head_refused(HEAD("<f4", "False", "(3,)"), 12, NULL);
    expect_head_refused(HEAD("<f4", "False", "()"), 4, NULL);
    expect_head_refused(HEAD("<U3", "False", "()"), 12, NULL);
    expect_head_refused(HEAD("<f4", "True", "(3, 2)"), 24, NULL);
    expect_head_refused(HEAD(">f4", "False", "(3, 2)"), 24, NULL);
    expect_head_refused(HEAD("<f2", "False", "(3, 2)"), 12, NULL);
    expect_head_refused(HEAD(">f2", "False", "(3, 2)"), 12, NULL);
    static const char *const damaged[] = {
        "(3)",     "(3,2)",   "(,)", "(3, )", "(3, 2,)", "(-3, 2)", "(3, 2", "3", "(99999999999999999999,)",
        "( 3, 2)", "(3, 2) x"};
    for (size_t i = 0; i < sizeof damaged / sizeof damaged[0]; i++) {
        const char *head = printed(HEAD("<f4", "False", "%s"), damaged[i]);
        expect_head_refused(head, 24, "damaged head");
    }
    expect_head_refused(HEAD("<f4", "Maybe", "(3, 2)"), 24, "damaged head");
    expect_head_refused("{'shape': (3, 2), }\n", 24, "damaged head");
}

TEST(arrays_of_other_kinds_are_refused_where_they_are_read) {
    expect_foreign(HEAD(">u1", "False", "(3, 2)"), 6, "of the unsupported type '>u1'");
    expect_foreign(HEAD("=f4", "False", "(3, 2)"), 24, "of the unsupported type '=f4'");
    expect_foreign(HEAD("|O", "False", "(3, 2)"), 99, "of the unsupported type '|O'");
    expect_foreign(HEAD("|S7", "False", "(3, 2)"), 42, "of the unsupported type '|S7'");
    expect_foreign(HEAD("\33[2J", "False", "(3, 2)"), 24, "of the unsupported type ''");
    expect_foreign(HEAD("<U2", "False", "(3,)"), 24, "an array of texts");
    expect_foreign(HEAD("<f4", "False", "(1, 1, 1, 1, 6)"), 24, "of more than 4 dimensions");
    expect_foreign("{'descr': [('x', '<f4')], 'fortran_order': False, 'shape': (3,), }\n", 12, "not a plain array");
}

TEST(sizes_must_agree_before_anything_is_inflated) {
    expect_head_refused(HEAD("<f4", "False", "(3, 2)"), 23, "array 'array' is damaged: ");
    expect_head_refused(HEAD("<f4", "False", "(3, 2)"), 25, "array 'array' is damaged: ");
    expect_head_refused(HEAD("<f4", "False", "(4294967296, 4294967296)"), 0, "larger than 2 GiB");
    expect_head_refused(HEAD("<f4", "False", "(65536, 65536, 65536, 65536)"), 0, "larger than 2 GiB");
    expect_head_refused(HEAD("<U4611686018427387904", "False", "()"), 0, "larger than 2 GiB");
    expect_head_refused(HEAD("<f4", "False", "(0, 7)"), 0, NULL);
}

TEST(other_files_are_refused) {
    const char *path = temporary_path("other.npz");
    expect_refused(temporary_path("missing.npz"), "cannot open: ");
    expect_refused("/dev/zero", "not a regular file");
    write_bytes(path, "no zip at all", 13);
    expect_refused(path, "not .npz");
    write_bytes(path, "PK\5\6\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0", 22);
    expect_refused(path, "");
    write_member(path, "a.txt", "text", 4, ZIP_CM_STORE);
    expect_refused(path, "a member that is not a named .npy array");
    write_member(path, "a\33[2J.npy", "text", 4, ZIP_CM_STORE);
    expect_refused(path, "a member that is not a named .npy array");
    write_member(path, ".npy", "text", 4, ZIP_CM_STORE);
    expect_refused(path, "a member that is not a named .npy array");
    write_member(path, "a.npy", "text", 4, ZIP_CM_STORE);
    expect_refused(path, "'a' is not a .npy array");
    write_member(path, "a.npy", "\x93NUMPY\3\0      ", 14, ZIP_CM_STORE);
    expect_refused(path, "'a' is in version 3.0 of .npy");
    write_member(path, "a.npy", "\x93NUMPY\1\0\xff\xff     ", 15, ZIP_CM_STORE);
    expect_refused(path, "cut off or longer");
}

/* The first place of the last header of this kind. */
static char *find_header(char *data, size_t size, const char *signature) {
    for (char *at = data + size - 4; at >= data; at--)
        if (memcmp(at, signature, 4) == 0) return at;
    fail_msg("no header");
    return NULL;
}

TEST(too_many_arrays_are_refused) {
    static char names[257][16];
    static NpzArray many[257];
    uint8_t value = 1;
    for (int i = 0; i < 257; i++) {
        snprintf(names[i], sizeof names[i], "a%d", i);
        many[i] = (NpzArray){names[i], NPZ_UINT8, 0, {0}, &value};
    }
    const char *path = temporary_path("many.npz");
    assert_ok(npz_write(path, many, 256, &error), error);
    npz_close(npz_of(path));
    assert_ok(npz_write(path, many, 257, &error), error);
    expect_refused(path, "holds 257 arrays; expected 1 to 256");
}

static void set_little_endian(char *at, uint32_t value) {
    for (int i = 0; i < 4; i++) at[i] = (char)(value >> (8 * i) & 0xff);
}

/* A member that claims a gigabyte and takes a few hundred bytes: more than deflate can do. */
TEST(small_files_cannot_hold_much) {
    const char *path = temporary_path("claim.npz");
    NpzArray array = {"empty", NPZ_FLOAT32, 1, {0}, NULL};
    assert_ok(npz_write(path, &array, 1, &error), error);
    size_t size;
    char *data = read_whole(path, &size);
    set_little_endian(find_header(data, size, "PK\1\2") + 24, 1U << 30);
    write_bytes(path, data, size);
    free(data);
    expect_refused(path, "it cannot hold 1073741824 bytes");
}

/* A .npz of one array of `size` zeros of one byte, deflated by libzip. */
static void write_zeros(const char *path, const char *type, size_t size) {
    FREED char *member = calloc(1, 128 + size);
    int head = snprintf(member + 10, 118, "{'descr': '%s', 'fortran_order': False, 'shape': (%zu,), }", type, size);
    memcpy(member, "\x93NUMPY\1\0v", 9);
    memset(member + 10 + head, ' ', 117 - (size_t)head);
    member[127] = '\n';
    write_member(path, "zeros.npy", member, 128 + size, ZIP_CM_DEFLATE);
}

/* 16 MiB and 256 times the file. Zeros deflate to 1/1000, by npz_write() to 1/218. */
TEST(more_than_the_budget_is_refused) {
    const char *path = temporary_path("bomb.npz");
    write_zeros(path, "|u1", 16 << 20);
    npz_close(npz_of(path));
    write_zeros(path, "|u1", 64 << 20);
    expect_refused(path, "its arrays take 67108864 bytes; expected at most 3");
    expect_refused(path, "(16 MiB and 256 times the size of the file)");
}

/* An array that is read again and again: 15 MiB, three times of which would exceed 16 MiB and 256 times 15 KB. */
TEST(all_that_is_read_is_limited) {
    enum { SIZE = 15 << 20 };
    const char *path = temporary_path("again.npz");
    const int64_t shape = SIZE;
    write_zeros(path, "|u1", SIZE);
    NpzFile *file = npz_of(path);
    int read = 0;
    for (void *data; (data = npz_read(file, "zeros", NPZ_UINT8, 1, &shape, &error)) != NULL; read++) free(data);
    npz_close(file);
    assert_int_equal(read, 1);
    assert_error(error, ERROR_INPUT, "bytes together");
}

/* 15 MiB of bytes are 120 MiB as integers of 8 bytes. */
TEST(converted_arrays_count_as_what_they_become) {
    enum { SIZE = 15 << 20 };
    const char *path = temporary_path("converted.npz");
    const int64_t shape = SIZE;
    write_zeros(path, "|i1", SIZE);
    NpzFile *file = npz_of(path);
    npz_convert(file);
    assert_null(npz_read(file, "zeros", NPZ_INT64, 1, &shape, &error));
    npz_close(file);
    assert_error(error, ERROR_INPUT, "bytes together");
}

/* Directories of millions of entries, or thousands of directories, never reach libzip. */
TEST(large_directories_are_refused) {
    const char *path = temporary_path("directory.npz");
    enum { SIZE = 1 << 20 };
    FREED char *data = calloc(SIZE, 1);
    for (size_t at = 0; at + 46 + 22 <= SIZE; at += 46) memcpy(data + at, "PK\1\2", 4);
    char *end = data + SIZE - 22;
    memset(end, 0, 22);
    memcpy(end, "PK\5\6", 4);
    set_little_endian(end + 12, SIZE - 100);
    write_bytes(path, data, SIZE);
    expect_refused(path, "its directory is too large");
    set_little_endian(end + 12, 46);
    for (char *other = end - 22; other > end - 2200; other -= 22) memcpy(other, end, 22);
    write_bytes(path, data, SIZE);
    expect_refused(path, "its directory is too large");
    memset(end - 2200, 0, 2200);
    memcpy(end - 20, "PK\6\7", 4);
    write_bytes(path, data, SIZE);
    expect_refused(path, "its directory is too large");
}

RUN_TESTS(NULL, NULL)
