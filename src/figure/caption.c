/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "figure/caption.h"

#include "common/file.h"
#include "common/method_look.h"
#include "figure/latex.h"
#include "figure/run_view.h"
#include "simulate/method.h"

#include <string.h>

enum { TIMES_LISTED = 8 };

/* The sweeps that the method's text leaves to the scene, or NULL. */
static const char *sweeps_of_scene(Settings *all, const Trajectory *run) {
    Method method;
    Error ignored = {0};
    const bool known = method_parse(&method, run->method, &ignored) && settings_get(&method.settings, "k") == NULL;
    return known && method_all_settings(all, run->method, run->iterations) ? settings_get(all, "k") : NULL;
}

void caption_run(FILE *out, const FigureSpec *spec, const Trajectory *run) {
    const MethodDescription *method = method_describe(run->method);
    const RunName shown = run_name(spec, run);
    char name[TRAJECTORY_NAME_SIZE];
    Settings all;
    method_name(name, sizeof name, run->method);
    const bool own = strcmp(shown.text, name) != 0, described = method != NULL && method->caption != NULL;
    if (own) {
        latex_text(out, shown.text);
        fputs(" (", out);
    }
    latex_code(out, name);
    if (described) {
        fputs(own ? ", " : " (", out);
        latex_text(out, method->caption);
        const char *sweeps = sweeps_of_scene(&all, run);
        if (sweeps != NULL) fprintf(out, ", \\texttt{k=%s}", sweeps);
    }
    if (own || described) fputs(")", out);
}

void caption_runs(FILE *out, const FigureSpec *spec, int first) {
    for (int i = first; i < spec->run_count; i++) {
        fputs(latex_between(i - first, spec->run_count - first), out);
        caption_run(out, spec, spec->runs[i]);
    }
}

void caption_scene(FILE *out, const FigureSpec *spec) {
    fputs("scene ", out);
    latex_code(out, spec->runs[0]->scene);
}

/* To a millisecond, without zeros at the end. */
static void write_time(FILE *out, double seconds) {
    char text[64];
    int end = snprintf(text, sizeof text, "%.3f", seconds);
    while (text[end - 1] == '0') end--;
    if (text[end - 1] == '.') end--;
    fprintf(out, "%.*s", end, text);
}

void caption_times(FILE *out, const FigureSpec *spec) {
    const FigureFacts *facts = spec->facts;
    const double dt = (double)spec->runs[0]->dt;
    const int count = facts->frame_count;
    if (count > TIMES_LISTED) {
        fprintf(out, " at %d moments from ", count);
        write_time(out, facts->frames[0] * dt);
        fputs(" to ", out);
        write_time(out, facts->frames[count - 1] * dt);
    } else {
        fputs(" at ", out);
        for (int i = 0; i < count; i++) {
            fputs(latex_between(i, count), out);
            write_time(out, facts->frames[i] * dt);
        }
    }
    fputs("~s", out);
}

/* A kind, and what it has drawn. */
typedef struct Caption {
    const FigureKind *kind;
    const FigureSpec *spec;
} Caption;

static void print(FILE *out, const void *context) {
    const Caption *caption = context;
    fputs("\\caption{", out);
    caption->kind->caption(out, caption->spec);
    fputs(" Drawn with twinbox~", out);
    latex_text(out, TWINBOX_VERSION);
    fputs(".}\n", out);
}

bool figure_write_caption(const FigureKind *kind, const FigureSpec *spec, const char *path, Error *error) {
    return file_write_text(path, print, &(Caption){kind, spec}, error);
}
