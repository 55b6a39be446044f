/* SPDX-License-Identifier: GPL-3.0-or-later */
/* .npz: arrays come back as they went in, the same arrays give the same bytes, and damaged or hostile files
   are refused. test_numpy.c asks NumPy itself. */
#include "testing.h"

#include "common/file.h"
#include "common/npz.h"

#include <time.h>
#include <zip.h>

static const float matrix[3][2] = {{1, -2.5F}, {0, 3e38F}, {-0.0F, 1e-45F}};
static const int64_t starts[] = {0, -1, INT64_MAX};
static const uint64_t hash = 0xfedcba9876543210U;
static const uint8_t bytes[] = {0, 1, 255, 7, 8};
static const NpzArray arrays[] = {
    {"matrix", NPZ_FLOAT32, 2, {3, 2}, matrix},
    {"starts", NPZ_INT64, 1, {3}, starts},
    {"hash", NPZ_UINT64, 0, {0}, &hash},
    {"bytes", NPZ_UINT8, 1, {5}, bytes},
    {"empty", NPZ_FLOAT32, 2, {0, 2}, NULL},
    {"name", NPZ_TEXT, 0, {0}, "z\xc3\xa4h \xe2\x82\xac \xf0\x9f\xa7\xb1"},
    {"nothing", NPZ_TEXT, 0, {0}, ""},
};
enum { ARRAYS = sizeof arrays / sizeof arrays[0] };

static void write_arrays(const char *path) {
    Error error = {0};
    assert_ok(npz_write(path, arrays, ARRAYS, &error), error);
}

static NpzFile *open_file(const char *path) {
    Error error = {0};
    NpzFile *file = npz_open(path, &error);
    assert_ok(file != NULL, error);
    return file;
}

/* 1 where all arrays are read and equal, 0 where something is refused; anything else fails. */
static int read_and_compare(const char *path) {
    static const size_t sizes[] = {sizeof matrix, sizeof starts, sizeof hash, sizeof bytes, 0};
    Error error = {0};
    NpzFile *file = npz_open(path, &error);
    bool done = file != NULL;
    for (size_t i = 0; done && i < ARRAYS; i++) {
        if (arrays[i].type == NPZ_TEXT) {
            char text[32];
            done = npz_read_text(file, arrays[i].name, text, sizeof text, &error);
            if (done) assert_string_equal(text, arrays[i].data);
            continue;
        }
        void *data = npz_read(file, arrays[i].name, arrays[i].type, arrays[i].rank, arrays[i].shape, &error);
        done = data != NULL;
        if (done && sizes[i] > 0) assert_memory_equal(data, arrays[i].data, sizes[i]);
        free(data);
    }
    npz_close(file);
    if (!done) assert_error(error, ERROR_INPUT, path);
    return done;
}

static void written_is_read(void **state) {
    (void)state;
    const char *path = temporary_path("written.npz");
    write_arrays(path);
    assert_int_equal(read_and_compare(path), 1);
    NpzFile *file = open_file(path);
    assert_true(npz_has(file, "matrix"));
    assert_false(npz_has(file, "matri"));
    int64_t shape[2];
    Error error = {0};
    assert_ok(npz_shape(file, "matrix", NPZ_FLOAT32, 2, shape, &error), error);
    assert_int_equal(shape[0], 3);
    assert_int_equal(shape[1], 2);
    npz_close(file);
}

static char *file_bytes(const char *path, size_t *size) {
    Error error = {0};
    char *data = file_read(path, 1 << 20, size, &error);
    assert_ok(data != NULL, error);
    return data;
}

/* Whatever the time zone: a zip holds local time. */
static void same_arrays_same_bytes(void **state) {
    (void)state;
    static const char *const zones[] = {"UTC0", "XXX-14", "XXX+12", "EST5EDT,M3.2.0,M11.1.0",
                                        "XXX3:30YYY,J1/0,J2/0"};
    const char *first = temporary_path("first.npz"), *second = temporary_path("second.npz");
    write_arrays(first);
    size_t size, other_size;
    char *data = file_bytes(first, &size);
    for (size_t i = 0; i < sizeof zones / sizeof zones[0]; i++) {
        setenv("TZ", zones[i], 1);
        tzset();
        write_arrays(second);
        char *other = file_bytes(second, &other_size);
        if (other_size != size || memcmp(data, other, size) != 0)
            fail_msg("other bytes in zone %s", zones[i]);
        free(other);
    }
    /* 1980-01-01 12:00 in the first local header. */
    assert_memory_equal(data + 10, "\x00\x60\x21\x00", 4);
    free(data);
}

static void mismatches_name_found_and_wanted(void **state) {
    (void)state;
    const char *path = temporary_path("mismatch.npz");
    write_arrays(path);
    NpzFile *file = open_file(path);
    Error missing = {0}, type = {0}, rank = {0}, shape = {0}, text = {0};
    int64_t found[NPZ_MAX_RANK];
    assert_null(npz_read(file, "no", NPZ_FLOAT32, 0, NULL, &missing));
    assert_error(missing, ERROR_INPUT, "mismatch.npz: error: has no array 'no'");
    assert_null(npz_read(file, "matrix", NPZ_FLOAT64, 2, (int64_t[]){3, 2}, &type));
    assert_error(type, ERROR_INPUT, "array 'matrix' is float32 of 2 dimensions; float64 of 2 is needed");
    assert_false(npz_shape(file, "matrix", NPZ_FLOAT32, 3, found, &rank));
    assert_error(rank, ERROR_INPUT, "float32 of 3 is needed");
    assert_null(npz_read(file, "matrix", NPZ_FLOAT32, 2, (int64_t[]){3, 4}, &shape));
    assert_error(shape, ERROR_INPUT, "array 'matrix' has shape (3, 2); (3, 4) is needed");
    char small[13], exact[14];
    assert_false(npz_read_text(file, "name", small, sizeof small, &text));
    assert_error(text, ERROR_INPUT, "'name'");
    Error error = {0};
    assert_ok(npz_read_text(file, "name", exact, sizeof exact, &error), error);
    npz_close(file);
}

static void bad_texts_are_not_written(void **state) {
    (void)state;
    static const char *const texts[] = {"\xff",
                                        "\x80",
                                        "\xc3",
                                        "\xc0\xaf",
                                        "\xe0\x80\x80",
                                        "\xed\xa0\x80",
                                        "\xf4\x90\x80\x80",
                                        "\xf8\x88\x80\x80\x80"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        NpzArray array = {"name", NPZ_TEXT, 0, {0}, texts[i]};
        Error error = {0};
        assert_false(npz_write(temporary_path("text.npz"), &array, 1, &error));
        assert_error(error, ERROR_INPUT, "text.npz: error: cannot store 'name'");
        assert_int_not_equal(access(temporary_path("text.npz"), F_OK), 0);
    }
}

/* A new file each time: some file systems write an overwritten one to disk at once, for safety. */
static void put(const char *path, const char *data, size_t size) {
    remove(path);
    FILE *out = fopen(path, "wb");
    assert_non_null(out);
    assert_int_equal(fwrite(data, 1, size, out), size);
    assert_int_equal(fclose(out), 0);
}

static void truncated_files_are_refused(void **state) {
    (void)state;
    const char *path = temporary_path("truncated.npz");
    write_arrays(path);
    size_t size;
    char *data = file_bytes(path, &size);
    for (size_t length = 0; length < size; length++) {
        put(path, data, length);
        if (read_and_compare(path) != 0) fail_msg("cut off at %zu, and read", length);
    }
    free(data);
}

static uint32_t random_next(uint32_t *seed) { return *seed = *seed * 1664525 + 1013904223; }

/* Whatever is changed, what is read is what was written. */
static void flipped_bytes_are_refused_or_harmless(void **state) {
    (void)state;
    const char *path = temporary_path("flipped.npz");
    write_arrays(path);
    size_t size;
    char *data = file_bytes(path, &size), *damaged = malloc(size);
    uint32_t seed = 1;
    int refused = 0;
    for (int round = 0; round < 4000; round++) {
        memcpy(damaged, data, size);
        for (int flips = 1 + round % 3; flips > 0; flips--)
            damaged[(random_next(&seed) >> 4) % size] ^= (char)(1 + (random_next(&seed) >> 8) % 255);
        put(path, damaged, size);
        refused += read_and_compare(path) == 0;
    }
    assert_true(refused > 1000);
    free(damaged);
    free(data);
}

/* A zip of one member with these bytes. */
static void write_member(const char *path, const char *name, const char *data, size_t size,
                         zip_int32_t method) {
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
    assert_null(npz_open(path, &error));
    assert_error(error, ERROR_INPUT, path);
    assert_error(error, ERROR_INPUT, reason);
}

/* An array with this dictionary and data_size bytes of data. */
static void expect_head_refused(const char *dictionary, size_t data_size, const char *reason) {
    const char *path = temporary_path("head.npz");
    char *member = calloc(1, 10 + strlen(dictionary) + data_size);
    memcpy(member, "\x93NUMPY\1\0", 8);
    member[8] = (char)(strlen(dictionary) & 0xff);
    member[9] = (char)(strlen(dictionary) >> 8);
    memcpy(member + 10, dictionary, strlen(dictionary));
    write_member(path, "array.npy", member, 10 + strlen(dictionary) + data_size, ZIP_CM_STORE);
    free(member);
    if (reason == NULL)
        npz_close(open_file(path));
    else
        expect_refused(path, reason);
}

#define HEAD(type, order, shape) "{'descr': '" type "', 'fortran_order': " order ", 'shape': " shape ", }\n"

static void heads_are_read_strictly(void **state) {
    (void)state;
    expect_head_refused(HEAD("<f4", "False", "(3, 2)"), 24, NULL);
    expect_head_refused(HEAD("<f4", "False", "(3,)"), 12, NULL);
    expect_head_refused(HEAD("<f4", "False", "()"), 4, NULL);
    expect_head_refused(HEAD("<U3", "False", "()"), 12, NULL);
    expect_head_refused(HEAD("<f4", "True", "(3, 2)"), 24, "'array' is in Fortran order");
    expect_head_refused(HEAD(">f4", "False", "(3, 2)"), 24, "'array' is of type '>f4', which");
    expect_head_refused(HEAD("<f2", "False", "(3, 2)"), 12, "of type '<f2'");
    expect_head_refused(HEAD("|O", "False", "(3, 2)"), 24, "of type '|O'");
    expect_head_refused(HEAD("\33[2J", "False", "(3, 2)"), 24, "of type '', which");
    expect_head_refused(HEAD("<U2", "False", "(3,)"), 24, "an array of texts");
    expect_head_refused("{'descr': [('x', '<f4')], 'fortran_order': False, 'shape': (3,), }\n", 12,
                        "no plain array");
    static const char *const damaged[] = {
        "(3)",     "(3,2)",   "(,)", "(3, )",           "(3, 2,)",
        "(-3, 2)", "(3, 2",   "3",   "(1, 1, 1, 1, 6)", "(99999999999999999999,)",
        "( 3, 2)", "(3, 2) x"};
    for (size_t i = 0; i < sizeof damaged / sizeof damaged[0]; i++) {
        char head[200];
        snprintf(head, sizeof head, HEAD("<f4", "False", "%s"), damaged[i]);
        expect_head_refused(head, 24, "damaged head");
    }
    expect_head_refused(HEAD("<f4", "Maybe", "(3, 2)"), 24, "damaged head");
}

static void sizes_must_agree_before_anything_is_inflated(void **state) {
    (void)state;
    expect_head_refused(HEAD("<f4", "False", "(3, 2)"), 23, "array 'array' is damaged: ");
    expect_head_refused(HEAD("<f4", "False", "(3, 2)"), 25, "array 'array' is damaged: ");
    expect_head_refused(HEAD("<f4", "False", "(4294967296, 4294967296)"), 0, "larger than 2 GiB");
    expect_head_refused(HEAD("<f4", "False", "(65536, 65536, 65536, 65536)"), 0, "larger than 2 GiB");
    expect_head_refused(HEAD("<U4611686018427387904", "False", "()"), 0, "larger than 2 GiB");
    expect_head_refused(HEAD("<f4", "False", "(0, 7)"), 0, NULL);
}

static void other_files_are_refused(void **state) {
    (void)state;
    const char *path = temporary_path("other.npz");
    expect_refused(temporary_path("missing.npz"), "cannot open: ");
    expect_refused("/dev/zero", "not a regular file");
    put(path, "no zip at all", 13);
    expect_refused(path, "no .npz");
    put(path, "PK\5\6\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0", 22);
    expect_refused(path, "");
    write_member(path, "a.txt", "text", 4, ZIP_CM_STORE);
    expect_refused(path, "something else than named .npy arrays");
    write_member(path, "a\33[2J.npy", "text", 4, ZIP_CM_STORE);
    expect_refused(path, "something else than named .npy arrays");
    write_member(path, ".npy", "text", 4, ZIP_CM_STORE);
    expect_refused(path, "something else than named .npy arrays");
    write_member(path, "a.npy", "text", 4, ZIP_CM_STORE);
    expect_refused(path, "'a' is no .npy array");
    write_member(path, "a.npy", "\x93NUMPY\3\0      ", 14, ZIP_CM_STORE);
    expect_refused(path, "'a' is in version 3.0 of .npy");
    write_member(path, "a.npy", "\x93NUMPY\1\0\xff\xff     ", 15, ZIP_CM_STORE);
    expect_refused(path, "cut off or longer");
}

static void other_compressions_are_refused(void **state) {
    (void)state;
    const char *path = temporary_path("bzip2.npz");
    char zeros[10000] = {0};
    write_member(path, "a.npy", zeros, sizeof zeros, ZIP_CM_BZIP2);
    expect_refused(path, "array 'a' is neither stored nor deflated");
}

static void encrypted_arrays_are_refused(void **state) {
    (void)state;
    const char *path = temporary_path("encrypted.npz");
    remove(path);
    zip_t *archive = zip_open(path, ZIP_CREATE, NULL);
    assert_int_equal(zip_file_add(archive, "a.npy", zip_source_buffer(archive, "text", 4, 0), 0), 0);
    assert_int_equal(zip_file_set_encryption(archive, 0, ZIP_EM_AES_256, "word"), 0);
    assert_int_equal(zip_close(archive), 0);
    expect_refused(path, "array 'a' is encrypted");
}

/* The first place of the last header of this kind. */
static char *find_header(char *data, size_t size, const char *signature) {
    for (char *at = data + size - 4; at >= data; at--)
        if (memcmp(at, signature, 4) == 0) return at;
    fail_msg("no header");
    return NULL;
}

static void a_name_twice_is_refused(void **state) {
    (void)state;
    const char *path = temporary_path("twice.npz");
    float value = 1;
    NpzArray twins[] = {{"twin1", NPZ_FLOAT32, 0, {0}, &value}, {"twin2", NPZ_FLOAT32, 0, {0}, &value}};
    Error error = {0};
    assert_ok(npz_write(path, twins, 2, &error), error);
    size_t size;
    char *data = file_bytes(path, &size);
    find_header(data, size, "PK\1\2")[46 + 4] = '1';
    find_header(data, size, "PK\3\4")[30 + 4] = '1';
    put(path, data, size);
    free(data);
    expect_refused(path, "holds array 'twin1' twice");
}

static void too_many_arrays_are_refused(void **state) {
    (void)state;
    static char names[257][16];
    static NpzArray many[257];
    uint8_t value = 1;
    for (int i = 0; i < 257; i++) {
        snprintf(names[i], sizeof names[i], "a%d", i);
        many[i] = (NpzArray){names[i], NPZ_UINT8, 0, {0}, &value};
    }
    const char *path = temporary_path("many.npz");
    Error error = {0};
    assert_ok(npz_write(path, many, 256, &error), error);
    npz_close(open_file(path));
    assert_ok(npz_write(path, many, 257, &error), error);
    expect_refused(path, "holds 257 arrays; 1 to 256 are possible");
}

static void set_little_endian(char *at, uint32_t value) {
    for (int i = 0; i < 4; i++) at[i] = (char)(value >> (8 * i) & 0xff);
}

/* A member that claims a gigabyte and takes a few hundred bytes: more than deflate can do. */
static void small_files_cannot_hold_much(void **state) {
    (void)state;
    const char *path = temporary_path("claim.npz");
    NpzArray array = {"empty", NPZ_FLOAT32, 1, {0}, NULL};
    Error error = {0};
    assert_ok(npz_write(path, &array, 1, &error), error);
    size_t size;
    char *data = file_bytes(path, &size);
    set_little_endian(find_header(data, size, "PK\1\2") + 24, 1U << 30);
    put(path, data, size);
    free(data);
    expect_refused(path, "it cannot hold 1073741824 bytes");
}

/* Honest, but of 64 MiB at each reading: after 2 GiB it is enough. */
static void all_that_is_read_is_limited(void **state) {
    (void)state;
    enum { SIZE = 64 << 20 };
    const char *path = temporary_path("bomb.npz");
    NpzArray array = {"zeros", NPZ_UINT8, 1, {SIZE}, calloc(SIZE, 1)};
    Error error = {0};
    assert_ok(npz_write(path, &array, 1, &error), error);
    free((void *)array.data);
    NpzFile *file = open_file(path);
    int read = 0;
    for (void *data; (data = npz_read(file, "zeros", NPZ_UINT8, 1, array.shape, &error)) != NULL; read++)
        free(data);
    npz_close(file);
    assert_int_equal(read, 32);
    assert_error(error, ERROR_INPUT, "larger than 2 GiB together");
}

/* Directories of millions of entries, or thousands of directories, never reach libzip. */
static void large_directories_are_refused(void **state) {
    (void)state;
    const char *path = temporary_path("directory.npz");
    enum { SIZE = 1 << 20 };
    char *data = calloc(SIZE, 1);
    for (size_t at = 0; at + 46 + 22 <= SIZE; at += 46) memcpy(data + at, "PK\1\2", 4);
    char *end = data + SIZE - 22;
    memset(end, 0, 22);
    memcpy(end, "PK\5\6", 4);
    set_little_endian(end + 12, SIZE - 100);
    put(path, data, SIZE);
    expect_refused(path, "its directory is too large");
    set_little_endian(end + 12, 46);
    for (char *other = end - 22; other > end - 2200; other -= 22) memcpy(other, end, 22);
    put(path, data, SIZE);
    expect_refused(path, "its directory is too large");
    memcpy(end - 20, "PK\6\7", 4);
    put(path, data, SIZE);
    expect_refused(path, "its directory is too large");
    free(data);
}

/* A file of holes of more than 2 GiB. */
static void large_files_are_refused(void **state) {
    (void)state;
    const char *path = temporary_path("large.npz");
    put(path, "", 0);
    assert_int_equal(truncate(path, ((off_t)1 << 31) + 1), 0);
    expect_refused(path, "larger than 2 GiB");
    remove(path);
}

static void failed_writes_tell(void **state) {
    (void)state;
    Error error = {0};
    assert_false(npz_write(temporary_path("nowhere/x.npz"), arrays, ARRAYS, &error));
    assert_error(error, ERROR_SYSTEM, "nowhere/x.npz: error: cannot write: ");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(written_is_read),
        cmocka_unit_test(same_arrays_same_bytes),
        cmocka_unit_test(mismatches_name_found_and_wanted),
        cmocka_unit_test(bad_texts_are_not_written),
        cmocka_unit_test(truncated_files_are_refused),
        cmocka_unit_test(flipped_bytes_are_refused_or_harmless),
        cmocka_unit_test(heads_are_read_strictly),
        cmocka_unit_test(sizes_must_agree_before_anything_is_inflated),
        cmocka_unit_test(other_files_are_refused),
        cmocka_unit_test(other_compressions_are_refused),
        cmocka_unit_test(encrypted_arrays_are_refused),
        cmocka_unit_test(a_name_twice_is_refused),
        cmocka_unit_test(too_many_arrays_are_refused),
        cmocka_unit_test(small_files_cannot_hold_much),
        cmocka_unit_test(all_that_is_read_is_limited),
        cmocka_unit_test(large_directories_are_refused),
        cmocka_unit_test(large_files_are_refused),
        cmocka_unit_test(failed_writes_tell),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
