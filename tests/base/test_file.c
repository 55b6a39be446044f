/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whole files: what is under a name is whole, and failures leave nothing behind. */
#include "testing.h"

#include "files.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

static void write_file(const char *path, const char *text) {
    Error error = {0};
    assert_ok(file_write(path, text, strlen(text), &error), error);
}

static const char *fresh_folder(const char *name) {
    const char *folder = temporary_path(name);
    Error error = {0};
    assert_ok(file_make_directory(folder, &error), error);
    return folder;
}

static void expect_write_error(const char *path, const char *reason) {
    Error error = {0};
    assert_false(file_write(path, "text", 4, &error));
    assert_error(error, ERROR_SYSTEM, path);
    assert_error(error, ERROR_SYSTEM, reason);
}

TEST(written_is_read) {
    const char *folder = fresh_folder("written"), *path = temporary_path("written/file");
    write_file(path, "first");
    assert_file(path, "first");
    write_file(path, "");
    assert_file(path, "");
    write_file(path, "second");
    assert_file(path, "second");
    assert_int_equal(count_files(folder, ""), 1);
}

TEST(new_files_follow_the_umask) {
    const char *path = temporary_path("umask");
    mode_t previous = umask(027);
    write_file(path, "text");
    umask(previous);
    struct stat status;
    assert_int_equal(stat(path, &status), 0);
    assert_int_equal(status.st_mode & 0777, 0640);
}

TEST(links_are_followed) {
    fresh_folder("links");
    const char *target = temporary_path("links/target"), *link = temporary_path("links/link");
    write_file(target, "old");
    assert_int_equal(symlink("target", link), 0);
    write_file(link, "new");
    assert_file(target, "new");
    struct stat status;
    assert_int_equal(lstat(link, &status), 0);
    assert_true(S_ISLNK(status.st_mode));
}

/* The path of a device to write to; false where there is none. Who may replace the machine's own devices gets
   one of the test's own instead: a file_write that is broken would do it. */
static bool find_device(char path[256], const char *name, unsigned minor_number) {
    strcpy(path, temporary_path(name));
    if (mknod(path, S_IFCHR | 0600, makedev(1, minor_number)) != 0) {
        if (access("/dev", W_OK) == 0) return false;
        snprintf(path, 256, "/dev/%s", name);
    }
    int file = open(path, O_WRONLY);
    if (file >= 0) close(file);
    return file >= 0;
}

TEST(devices_are_written_into) {
    char null[256], full[256];
    if (!find_device(null, "null", 3) || !find_device(full, "full", 7)) skip();
    write_file(null, "text");
    struct stat status;
    assert_int_equal(lstat(null, &status), 0);
    assert_true(S_ISCHR(status.st_mode));
    expect_write_error(full, strerror(ENOSPC));
    assert_int_equal(lstat(full, &status), 0);
    assert_true(S_ISCHR(status.st_mode));
}

static void *read_fifo(void *path) {
    static char text[16];
    int fifo = open(path, O_RDONLY);
    ssize_t got = read(fifo, text, sizeof text - 1);
    text[got > 0 ? got : 0] = '\0';
    close(fifo);
    return text;
}

TEST(fifos_are_written_into) {
    char path[256];
    strcpy(path, temporary_path("fifo"));
    assert_int_equal(mkfifo(path, 0600), 0);
    pthread_t reader;
    void *text;
    assert_int_equal(pthread_create(&reader, NULL, read_fifo, path), 0);
    write_file(path, "text");
    pthread_join(reader, &text);
    assert_string_equal(text, "text");
}

/* A link such as /dev/stdout, when it leads to a file, is written where the program's output has got to. */
TEST(standard_output_is_written_into) {
    const char *path = temporary_path("output"), *link = temporary_path("stdout");
    assert_int_equal(symlink("/proc/self/fd/1", link), 0);
    fflush(stdout);
    int saved = dup(STDOUT_FILENO), output = open(path, O_WRONLY | O_CREAT, 0600);
    assert_true(saved >= 0 && output >= 0);
    dup2(output, STDOUT_FILENO);
    close(output);
    bool before = write(STDOUT_FILENO, "before ", 7) == 7;
    bool done = file_write(link, "text", 4, &error);
    bool after = write(STDOUT_FILENO, " after", 6) == 6;
    dup2(saved, STDOUT_FILENO);
    close(saved);
    assert_ok(done, error);
    assert_true(before && after);
    assert_file(path, "before text after");
}

TEST(failed_writes_leave_nothing) {
    const char *folder = fresh_folder("failed");
    expect_write_error(temporary_path("failed/missing/file"), "its folder does not exist");
    expect_write_error("", "cannot write: ");
    expect_write_error("/proc/twinbox", "cannot write: nothing new can be made there");
    expect_write_error(folder, strerror(EISDIR));
    char longest[NAME_MAX + 16];
    memset(longest, 'x', sizeof longest - 1);
    longest[sizeof longest - 1] = '\0';
    const char *path = temporary_path("failed/x");
    char *joined = malloc(strlen(path) + sizeof longest);
    sprintf(joined, "%s%s", path, longest);
    expect_write_error(joined, strerror(ENAMETOOLONG));
    free(joined);
    assert_int_equal(count_files(folder, ""), 0);
}

static void expect_read_error(const char *path, size_t limit, const char *reason) {
    Error error = {0};
    size_t size;
    assert_refused(file_read(path, limit, &size, &error), path, reason);
}

TEST(bad_inputs_are_refused) {
    const char *path = temporary_path("limit"), *fifo = temporary_path("unread");
    write_file(path, "1234567890");
    expect_read_error(path, 9, "larger than 9 bytes");
    expect_read_error(temporary_path("nowhere"), 9, strerror(ENOENT));
    expect_read_error("/", 9, "not a regular file");
    expect_read_error("/dev/zero", 9, "not a regular file");
    assert_int_equal(mkfifo(fifo, 0600), 0);
    expect_read_error(fifo, 9, "not a regular file");
    /* Files of /proc say that they are empty, and are not. */
    expect_read_error("/proc/self/maps", 100, "larger than 100 bytes");
}

TEST(directories_are_made_with_those_above) {
    const char *path = temporary_path("a//b/c/"), *file = temporary_path("file");
    assert_ok(file_make_directory(path, &error), error);
    assert_ok(file_make_directory(path, &error), error);
    assert_int_equal(access(path, W_OK), 0);
    write_file(file, "text");
    Error refused = {0}, empty = {0};
    assert_false(file_make_directory(temporary_path("file/below"), &refused));
    assert_error(refused, ERROR_SYSTEM, strerror(EEXIST));
    assert_false(file_make_directory("", &empty));
    assert_error(empty, ERROR_SYSTEM, strerror(ENOENT));
}

RUN_TESTS(NULL, NULL)
