/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Machines that write into one folder at the same time, as over NFS: every file has a name, and locks hold on one
   machine only, hold nothing, or are not there. A sweep never removes what a living process writes, and no two use one
   name, even if the numbers of the processes and their clocks are equal. */
#define _GNU_SOURCE /* O_TMPFILE, RTLD_NEXT */
#include "testing.h"

#include "files.h"

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <time.h>

typedef enum Locks { REAL_LOCKS, EMPTY_LOCKS, NO_LOCKS } Locks;

/* What a process of this test is, before it first writes. */
typedef struct Node {
    Locks locks;
    int machine;
    pid_t process; /* 0: its own */
} Node;

static Node node;
static bool stops_before_rename, dies_before_rename;

#define REAL(name, type, ...)  \
    type (*real)(__VA_ARGS__); \
    *(void **)&real = dlsym(RTLD_NEXT, name)

int openat(int at, const char *path, int flags, ...) {
    REAL("openat", int, int, const char *, int, ...);
    if ((flags & O_TMPFILE) == O_TMPFILE) return errno = EOPNOTSUPP, -1;
    return real(at, path, flags, 0666);
}

/* What tells the starts of kernels apart is the content of a file. */
int open(const char *path, int flags, ...) {
    REAL("open", int, const char *, int, ...);
    int ends[2];
    const char id[] = {(char)('0' + node.machine), '\n'};
    if (strstr(path, "boot_id") == NULL) return real(path, flags, 0666);
    if (pipe(ends) != 0 || write(ends[1], id, sizeof id) != sizeof id) abort();
    close(ends[1]);
    return ends[0];
}

int flock(int file, int operation) {
    REAL("flock", int, int, int);
    if (node.locks == EMPTY_LOCKS) return 0;
    if (node.locks == NO_LOCKS) return errno = ENOLCK, -1;
    return real(file, operation);
}

pid_t getpid(void) {
    REAL("getpid", pid_t, void);
    return node.process > 0 ? node.process : real();
}

int clock_gettime(clockid_t clock, struct timespec *time) {
    REAL("clock_gettime", int, clockid_t, struct timespec *);
    if (node.process == 0) return real(clock, time);
    *time = (struct timespec){0};
    return 0;
}

int renameat(int from, const char *old, int to, const char *new) {
    REAL("renameat", int, int, const char *, int, const char *);
    if (dies_before_rename) raise(SIGKILL);
    if (stops_before_rename) raise(SIGSTOP);
    return real(from, old, to, new);
}

static char folder[128];

static const char *below(const char *name) {
    static char path[300];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static void make_folder(const char *name) {
    Error error = {0};
    snprintf(folder, sizeof folder, "%s", temporary_path(name));
    assert_ok(file_make_directory(folder, &error), error);
}

/* A process on that node, which writes a file of this name and content, and ends, dies or stops before it has the
   name. */
static pid_t start(Node where, const char *name, bool dies, bool stops) {
    const pid_t child = fork();
    if (child != 0) return child;
    Error error = {0};
    prctl(PR_SET_PDEATHSIG, SIGKILL); /* where the test fails while this process is stopped */
    node = where;
    dies_before_rename = dies;
    stops_before_rename = stops;
    _exit(file_write(below(name), name, strlen(name), &error) ? 0 : 1);
}

static int wait_for(pid_t child) {
    int status;
    assert_int_equal(waitpid(child, &status, WUNTRACED), child);
    return status;
}

static void write_whole(Node where, const char *name) {
    assert_int_equal(wait_for(start(where, name, false, false)), 0);
}

/* One process is about to name its file while another writes one. */
static void expect_both(Node first, Node second) {
    const pid_t writing = start(first, "first", false, true);
    assert_true(WIFSTOPPED(wait_for(writing)));
    assert_int_equal(count_files(folder, ""), 1);
    write_whole(second, "second");
    assert_int_equal(count_files(folder, ""), 2);
    kill(writing, SIGCONT);
    assert_int_equal(wait_for(writing), 0);
    assert_file(below("first"), "first");
    assert_file(below("second"), "second");
    assert_int_equal(count_files(folder, ""), 2);
    assert_int_equal(remove(below("first")), 0);
    assert_int_equal(remove(below("second")), 0);
}

/* A process that has ended, so that no other has its number for long. */
static pid_t ended_process(void) {
    const pid_t child = fork();
    if (child == 0) _exit(0);
    wait_for(child);
    return child;
}

TEST(living_processes_keep_their_files) {
    const pid_t ended = ended_process();
    make_folder("living");
    for (Locks locks = REAL_LOCKS; locks <= NO_LOCKS; locks++) {
        expect_both((Node){locks, 1, 0}, (Node){locks, 1, 0});
        expect_both((Node){locks, 1, 0}, (Node){locks, 2, 0});
        expect_both((Node){locks, 1, ended}, (Node){locks, 2, ended});
    }
}

/* Two processes with one name of a machine, one number and one time: the second finds the first name taken. */
TEST(a_name_is_used_once) {
    const pid_t ended = ended_process();
    make_folder("once");
    expect_both((Node){REAL_LOCKS, 1, ended}, (Node){REAL_LOCKS, 1, ended});
}

TEST(a_machine_removes_what_its_killed_processes_left) {
    make_folder("killed");
    for (Locks locks = REAL_LOCKS; locks <= NO_LOCKS; locks++) {
        assert_true(WIFSIGNALED(wait_for(start((Node){locks, 1, 0}, "lost", true, false))));
        write_whole((Node){locks, 2, 0}, "file");
        assert_int_equal(count_files(folder, ""), 2);
        write_whole((Node){locks, 1, 0}, "file");
        assert_int_equal(count_files(folder, ""), 1);
    }
}

RUN_TESTS(NULL, NULL)
