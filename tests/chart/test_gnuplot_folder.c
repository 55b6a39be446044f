/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The folder in which gnuplot works: in TMPDIR, whatever its name, and none stays for long. */
#include "testing.h"

#include "chart/chart_plot.h"
#include "chart/gnuplot_folder.h"
#include "common/file.h"
#include "common/folder.h"

#include <signal.h>
#include <sys/wait.h>

#define SAMPLE SOURCE_DIR "/tests/chart/chart.csv"

static bool is_any(const char *name) { return name != NULL; }

static size_t count_files(const char *path) {
    Error error = {0};
    FolderList list;
    assert_ok(folder_list(&list, path, is_any, true, &error), error);
    const size_t count = list.count;
    folder_list_free(&list);
    return count;
}

static const char *fresh_folder(const char *name) {
    const char *path = temporary_path(name);
    Error error = {0};
    assert_ok(file_make_directory(path, &error), error);
    return path;
}

static void assert_same_drawing(const char *a, const char *b, const char *name) {
    char path[PATH_MAX];
    char *data[2];
    size_t size[2];
    Error error = {0};
    for (int i = 0; i < 2; i++) {
        snprintf(path, sizeof path, "%s/%s", i == 0 ? a : b, name);
        data[i] = file_read(path, 1 << 24, &size[i], &error);
        assert_ok(data[i] != NULL, error);
    }
    assert_int_equal(size[0], size[1]);
    assert_memory_equal(data[0], data[1], size[0]);
    free(data[0]);
    free(data[1]);
}

static void any_name_of_tmpdir_works(void **state) {
    (void)state;
    Error error = {0};
    const char *here = fresh_folder("here"), *there = fresh_folder("there"), *odd = fresh_folder("it's <&> \"odd\" %d");
    assert_ok(chart_plot(SAMPLE, "pyramid_settled", here, &error), error);
    assert_int_equal(setenv("TMPDIR", odd, 1), 0);
    assert_ok(chart_plot(SAMPLE, "pyramid_settled", there, &error), error);
    assert_same_drawing(here, there, "chart-pyramid_settled.png");
    assert_same_drawing(here, there, "chart-pyramid_settled.svg");
    assert_int_equal(count_files(odd), 0);
    assert_int_equal(rmdir(odd), 0);
    assert_false(chart_plot(SAMPLE, "pyramid_settled", there, &error));
    assert_error(error, ERROR_SYSTEM, odd);
    unsetenv("TMPDIR");
}

/* A process with such a folder and a file in it; it waits for its end. */
static pid_t start_process(const char *place) {
    int ends[2];
    char byte;
    assert_int_equal(pipe(ends), 0);
    const pid_t child = fork();
    if (child == 0) {
        GnuplotFolder folder;
        Error error = {0};
        char path[PATH_MAX + 8];
        if (!gnuplot_folder_make(&folder, &error)) _exit(1);
        snprintf(path, sizeof path, "%s/file", folder.path);
        write_bytes(path, "x", 1);
        if (write(ends[1], "x", 1) != 1) _exit(1);
        for (;;) pause();
    }
    close(ends[1]);
    assert_int_equal(read(ends[0], &byte, 1), 1);
    close(ends[0]);
    assert_true(count_files(place) > 0);
    return child;
}

static void kill_process(pid_t child) {
    kill(child, SIGKILL);
    assert_int_equal(waitpid(child, NULL, 0), child);
}

static void folders_of_killed_processes_go(void **state) {
    (void)state;
    Error error = {0};
    GnuplotFolder folder;
    const char *place = fresh_folder("place");
    assert_int_equal(setenv("TMPDIR", place, 1), 0);
    const pid_t alive = start_process(place), killed = start_process(place);
    kill_process(killed);
    assert_int_equal(count_files(place), 2);
    assert_ok(gnuplot_folder_make(&folder, &error), error);
    assert_int_equal(count_files(place), 1);
    assert_ok(gnuplot_folder_remove(&folder, &error), error);
    kill_process(alive);
    assert_ok(gnuplot_folder_make(&folder, &error) && gnuplot_folder_remove(&folder, &error), error);
    assert_int_equal(rmdir(place), 0);
    unsetenv("TMPDIR");
}

/* TMPDIR may be a folder that machines share, where an unlocked folder can be in use. */
static void folders_of_other_machines_stay(void **state) {
    (void)state;
    Error error = {0};
    GnuplotFolder folder;
    char path[PATH_MAX];
    const char *place = fresh_folder("shared");
    snprintf(path, sizeof path, "%s/twinbox-plot-00000000-99999999-abcdef", place);
    assert_ok(file_make_directory(path, &error), error);
    assert_int_equal(setenv("TMPDIR", place, 1), 0);
    assert_ok(gnuplot_folder_make(&folder, &error) && gnuplot_folder_remove(&folder, &error), error);
    assert_int_equal(rmdir(path), 0);
    unsetenv("TMPDIR");
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(any_name_of_tmpdir_works),
                                       cmocka_unit_test(folders_of_killed_processes_go),
                                       cmocka_unit_test(folders_of_other_machines_stay)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
