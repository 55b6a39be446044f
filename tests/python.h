/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Python programs within tests: NumPy has the last word on what an .npz is. One Python runs all programs of a test,
   because NumPy takes longer to load than most programs to run. */
#pragma once
#include "testing.h"

#include <sys/wait.h>

/* Runs the programs whose paths it reads, and answers each by a line: empty, or how the program failed. */
static const char python_loop[] =
    "import contextlib, io, sys, traceback\n"
    "for line in sys.stdin:\n"
    "    script, sys.argv[1:] = line.rstrip('\\n').split('\\t')[0], line.rstrip('\\n').split('\\t')[1:]\n"
    "    printed, failure = io.StringIO(), ''\n"
    "    try:\n"
    "        with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):\n"
    "            exec(compile(open(script).read(), script, 'exec'), {'__name__': '__main__'})\n"
    "    except BaseException:\n"
    "        failure = printed.getvalue() + traceback.format_exc()\n"
    "    sys.stdout.write(failure.replace('\\n', '\\r') + '\\n')\n"
    "    sys.stdout.flush()\n";

static FILE *python_input, *python_output;

static inline void start_python(void) {
    int in[2], out[2];
    assert_true(pipe(in) == 0 && pipe(out) == 0);
    if (fork() == 0) {
        /* By its whole path: Python looks for its modules beside the first python3 of PATH otherwise. */
        dup2(in[0], 0), dup2(out[1], 1);
        close(in[0]), close(in[1]), close(out[0]), close(out[1]);
        execl("/usr/bin/python3", "/usr/bin/python3", "-c", python_loop, (char *)NULL);
        _exit(127);
    }
    close(in[0]), close(out[1]);
    python_input = fdopen(in[1], "w");
    python_output = fdopen(out[0], "r");
    assert_true(python_input != NULL && python_output != NULL);
}

/* Runs a program with a path as its argument by Debian's Python, and fails with its output where it fails.
   Needs python3-numpy. */
static inline void run_python(const char *program, const char *path) {
    static char answer[8192];
    if (python_input == NULL) start_python();
    const char *script = temporary_path("script.py");
    FILE *out = fopen(script, "w");
    assert_non_null(out);
    fputs(program, out);
    fclose(out);
    fprintf(python_input, "%s\t%s\n", script, path);
    fflush(python_input);
    if (fgets(answer, sizeof answer, python_output) == NULL) fail_msg("Python ended: %s", script);
    for (char *end = answer; (end = strchr(end, '\r')) != NULL;) *end = '\n';
    if (answer[0] != '\n') fail_msg("%s", answer);
}
