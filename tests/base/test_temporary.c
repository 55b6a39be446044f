/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A process that is killed while it writes leaves the old file, and nothing that the next one of that name does not
   remove; also on file systems on which every file has a name. What a living process writes stays, also on another
   machine, whose locks this one does not see. */
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

typedef enum Call { NO_CALL, OPEN, WRITE, FSYNC, LINK, RENAME, UNLINK, CALLS } Call;

static Call deadly;                                        /* kills at its entry */
static bool all_have_names, no_locks, stops_before_rename; /* all_have_names: O_TMPFILE fails */
static char machine = 'a';

static void enter(Call call) {
    if (deadly == call) raise(SIGKILL);
}

#define REAL(name, type, ...)  \
    type (*real)(__VA_ARGS__); \
    *(void **)&real = dlsym(RTLD_NEXT, name)

int openat(int at, const char *path, int flags, ...) {
    REAL("openat", int, int, const char *, int, ...);
    if ((flags & O_CREAT) != 0 || (flags & O_TMPFILE) == O_TMPFILE) enter(OPEN);
    if ((flags & O_TMPFILE) == O_TMPFILE && all_have_names) return errno = EOPNOTSUPP, -1;
    return real(at, path, flags, 0666);
}

/* What tells machines apart is the content of a file. */
int open(const char *path, int flags, ...) {
    REAL("open", int, const char *, int, ...);
    int ends[2];
    if (strstr(path, "boot_id") == NULL) return real(path, flags, 0666);
    if (pipe(ends) != 0) abort();
    ssize_t (*put)(int, const void *, size_t);
    *(void **)&put = dlsym(RTLD_NEXT, "write");
    if (put(ends[1], &machine, 1) != 1) abort();
    close(ends[1]);
    return ends[0];
}

int flock(int file, int operation) {
    REAL("flock", int, int, int);
    return no_locks ? (errno = ENOLCK, -1) : real(file, operation);
}

ssize_t write(int file, const void *data, size_t size) {
    REAL("write", ssize_t, int, const void *, size_t);
    enter(WRITE);
    return real(file, data, size);
}

int fsync(int file) {
    REAL("fsync", int, int);
    enter(FSYNC);
    return real(file);
}

int linkat(int from, const char *old, int to, const char *new, int flags) {
    REAL("linkat", int, int, const char *, int, const char *, int);
    enter(LINK);
    return real(from, old, to, new, flags);
}

int renameat(int from, const char *old, int to, const char *new) {
    REAL("renameat", int, int, const char *, int, const char *);
    enter(RENAME);
    if (stops_before_rename) raise(SIGSTOP);
    return real(from, old, to, new);
}

int unlinkat(int at, const char *path, int flags) {
    REAL("unlinkat", int, int, const char *, int);
    enter(UNLINK);
    return real(at, path, flags);
}

static char folder[128];

static const char *below(const char *name) {
    static char paths[4][300];
    static int next;
    char *path = paths[next++ % 4];
    snprintf(path, sizeof paths[0], "%s/%s", folder, name);
    return path;
}

static bool replace_file(const char *path, const char *text, Error *error) {
    return file_write(path, text, strlen(text), error);
}

static bool create_file(const char *path, const char *text, Error *error) {
    return file_create(printed("%s-created", path), text, strlen(text), error) && replace_file(path, text, error);
}

static bool publish_draft(const char *path, const char *text, Error *error) {
    const int draft = file_draft(path, error);
    return draft >= 0 && file_draft_write(draft, path, text, strlen(text), error) &&
           file_draft_publish(draft, path, error);
}

typedef bool Write(const char *path, const char *text, Error *error);

/* Returns how the process ended. */
static int write_in_child(Write *write_file, const char *text, Call call) {
    Error error = {0};
    int status;
    const pid_t child = fork();
    if (child == 0) {
        deadly = call;
        _exit(write_file(below("file"), text, &error) ? 0 : 1);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    return status;
}

static void make_folder(void) {
    static int made;
    Error error = {0};
    snprintf(folder, sizeof folder, "%s", temporary_path(printed("folder-%d", made++)));
    assert_ok(file_make_directory(folder, &error), error);
}

/* At each call in turn. Returns the number of calls at which it was killed. */
static int kill_at_each_call(Write *write_file) {
    int kills = 0;
    for (Call call = OPEN; call < CALLS; call++) {
        make_folder();
        assert_int_equal(write_in_child(replace_file, "old", NO_CALL), 0);
        const int status = write_in_child(write_file, "new", call);
        kills += WIFSIGNALED(status);
        if (WIFSIGNALED(status)) assert_file(below("file"), "old");
        unlink(below("file-created"));
        assert_int_equal(write_in_child(write_file, "new", NO_CALL), 0);
        assert_file(below("file"), "new");
        unlink(below("file-created"));
        assert_int_equal(count_files(folder, ""), 1);
    }
    return kills;
}

TEST(a_kill_leaves_nothing) {
    static Write *const writes[] = {replace_file, create_file, publish_draft};
    (void)state;
    for (int names = 0; names < 2; names++)
        for (int i = 0; i < 3; i++) {
            all_have_names = names == 1;
            /* Open, write, fsync, rename, and link or unlink: a name is given, or taken away. */
            assert_true(kill_at_each_call(writes[i]) >= (all_have_names && i == 0 ? 4 : 5));
        }
    all_have_names = false;
}

/* One process is about to give its file the name while another, perhaps on another machine, writes one of this name. */
static void expect_both(bool locks, char other) {
    int status;
    make_folder();
    no_locks = !locks;
    const pid_t writing = fork();
    if (writing == 0) {
        Error error = {0};
        prctl(PR_SET_PDEATHSIG, SIGKILL); /* where the test fails while this process is stopped */
        stops_before_rename = true;
        _exit(replace_file(below("file"), "first", &error) ? 0 : 1);
    }
    assert_int_equal(waitpid(writing, &status, WUNTRACED), writing);
    assert_true(WIFSTOPPED(status));
    machine = other;
    assert_int_equal(write_in_child(replace_file, "second", NO_CALL), 0);
    assert_file(below("file"), "second");
    kill(writing, SIGCONT);
    assert_int_equal(waitpid(writing, &status, 0), writing);
    assert_int_equal(status, 0);
    assert_file(below("file"), "first");
    assert_int_equal(count_files(folder, ""), 1);
    machine = 'a';
    no_locks = false;
}

TEST(living_processes_keep_their_files) {
    all_have_names = true;
    for (int locks = 0; locks < 2; locks++) {
        expect_both(locks == 1, 'a');
        expect_both(locks == 1, 'b');
    }
    all_have_names = false;
}

TEST(drafts_for_pipes_are_in_the_folder_for_temporary_files) {
    make_folder();
    assert_int_equal(setenv("TMPDIR", folder, 1), 0);
    const int draft = file_draft("-", &error);
    assert_ok(draft >= 0, error);
    char path[64], place[300] = "";
    snprintf(path, sizeof path, "/proc/self/fd/%d", draft);
    assert_true(readlink(path, place, sizeof place - 1) > 0);
    assert_int_equal(strncmp(place, folder, strlen(folder)), 0);
    close(draft);
    assert_int_equal(setenv("TMPDIR", "/nonexistent", 1), 0);
    assert_int_equal(file_draft("-", &error), -1);
    assert_error(error, ERROR_SYSTEM, "/nonexistent/draft: error: cannot write: its folder does not exist");
    unsetenv("TMPDIR");
}

RUN_TESTS(NULL, NULL)
