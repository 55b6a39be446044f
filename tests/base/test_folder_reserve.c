/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A folder belongs to one process at a time; what is left of an ended process is waited for. */
#include "testing.h"

#include "base/machine.h"
#include "base/file.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>

static char folder[256];

static void choose_folder(const char *name) { snprintf(folder, sizeof folder, "%s", temporary_path(name)); }

/* Exit status of a process that reserves the folder, and its error. */
static int reserve_in_child(Error *error) {
    int ends[2], status;
    assert_int_equal(pipe(ends), 0);
    const pid_t child = fork();
    if (child == 0) {
        folder_reserve(folder, error);
        _exit(write(ends[1], error, sizeof *error) == sizeof *error ? 0 : 1);
    }
    close(ends[1]);
    assert_int_equal(read(ends[0], error, sizeof *error), sizeof *error);
    close(ends[0]);
    assert_int_equal(waitpid(child, &status, 0), child);
    return status;
}

/* A process with the folder, which waits for its end, or, if `leave`, leaves it to a child for a moment. */
static pid_t start_holder(bool leave) {
    int ends[2];
    char byte;
    Error error = {0};
    assert_int_equal(pipe(ends), 0);
    const pid_t holder = fork();
    if (holder == 0) {
        if (!folder_reserve(folder, &error) || (leave && fork() != 0)) _exit(0);
        if (write(ends[1], "x", 1) != 1) _exit(1);
        if (!leave) pause();
        sleep(1);
        _exit(0);
    }
    close(ends[1]);
    assert_int_equal(read(ends[0], &byte, 1), 1);
    close(ends[0]);
    return holder;
}

TEST(a_folder_has_one_process) {
    choose_folder("held/by/another");
    const pid_t holder = start_holder(false);
    assert_int_equal(reserve_in_child(&error), 0);
    assert_error(error, ERROR_SYSTEM, folder);
    assert_error(error, ERROR_SYSTEM, "another process is writing into this folder");
    kill(holder, SIGKILL);
    assert_int_equal(waitpid(holder, NULL, 0), holder);
    error = (Error){0};
    assert_int_equal(reserve_in_child(&error), 0);
    assert_ok(error.kind == ERROR_NONE, error);
}

TEST(children_of_an_ended_process_are_waited_for) {
    choose_folder("left");
    const pid_t holder = start_holder(true);
    assert_int_equal(waitpid(holder, NULL, 0), holder);
    assert_int_equal(reserve_in_child(&error), 0);
    assert_ok(error.kind == ERROR_NONE, error);
}

TEST(a_process_may_reserve_a_folder_again) {
    for (int i = 0; i < 6; i++) {
        choose_folder(printed("own-%d", i % 3));
        assert_ok(folder_reserve(folder, &error) && folder_reserve(folder, &error), error);
    }
    assert_int_equal(reserve_in_child(&error), 0);
    assert_ok(error.kind == ERROR_NONE, error);
    write_bytes(temporary_path("file"), "x", 1);
    choose_folder("file/folder");
    assert_false(folder_reserve(folder, &error));
    assert_error(error, ERROR_SYSTEM, "cannot make this folder");
}

RUN_TESTS(NULL, NULL)
