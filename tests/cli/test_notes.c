/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What reaches standard error at each level. Time is that of the test: the linker replaces clock_seconds(). */
#include "owned.h"
#include "files.h"

#include "base/base.h"
#include "cli/notes.h"
#include "cli/progress_bar.h"

static double now; /* s */

double __wrap_clock_seconds(void);
double __wrap_clock_seconds(void) { return now; }

static void work_for_an_hour(void) {
    const Progress *progress = progress_bar_begin("work");
    for (int minute = 1; minute <= 60; minute++) {
        now += 60;
        assert_true(progress->report(progress->context, minute, 60));
    }
    progress_bar_end();
}

/* What the work prints on standard error; the caller frees it. */
static char *printed_by(void work(NoteLevel level), NoteLevel level) {
    const char *path = temporary_path("printed");
    const int before = dup(STDERR_FILENO);
    assert_non_null(freopen(path, "w", stderr));
    setvbuf(stderr, NULL, _IONBF, 0);
    work(level);
    note_set_level(NOTES_NORMAL);
    dup2(before, STDERR_FILENO);
    close(before);
    return text_of(path);
}

static void do_all(NoteLevel level) {
    note_set_level(level);
    work_for_an_hour();
    note_print("%d is a note", 1);
    note_verbose("%d is printed only with -v", 2);
    for (int i = 0; i < 3; i++) trace_line("%d comes from below", 3);
}

static char *print_all(NoteLevel level) { return printed_by(do_all, level); }

/* Two lines are at least 5 s apart; the end comes 1 s after one. */
static void end_soon(NoteLevel level) {
    now = 1000;
    const Progress *progress = progress_bar_begin("short work");
    (void)level;
    for (int second = 1; second <= 13; second++) {
        now += 1;
        progress->report(progress->context, second, 13);
    }
    progress->report(progress->context, 13, 13);
    progress_bar_end();
}

TEST(the_last_line_in_a_file_is_the_end) {
    FREED char *text = printed_by(end_soon, NOTES_NORMAL);
    const char *end = strstr(text, "short work: 100%\n");
    assert_non_null(end);
    assert_string_equal(end, "short work: 100%\n");
    assert_non_null(strstr(text, "short work: 85%"));
}

TEST(quiet_prints_nothing) {
    FREED char *text = print_all(NOTES_QUIET);
    assert_string_equal(text, "");
}

TEST(notes_and_progress_are_printed) {
    FREED char *text = print_all(NOTES_NORMAL);
    assert_non_null(strstr(text, "work: 100%"));
    assert_non_null(strstr(text, "\ntwinbox: note: 1 is a note\n"));
    assert_null(strstr(text, "only with -v"));
    assert_null(strstr(text, "from below"));
}

TEST(verbose_prints_all) {
    FREED char *text = print_all(NOTES_VERBOSE);
    assert_non_null(strstr(text, "work: 100%"));
    assert_non_null(strstr(text, "\ntwinbox: note: 1 is a note\ntwinbox: 2 is printed only with -v\n"
                                 "twinbox: 3 comes from below\n"));
    assert_string_equal(strstr(text, "twinbox: 3"), "twinbox: 3 comes from below\n");
}

RUN_TESTS(NULL, NULL)
