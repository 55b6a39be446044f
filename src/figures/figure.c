/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kinds of figures, and captions for LaTeX. */
#include "figures/figure.h"

#include "base/base.h"
#include "base/file.h"
#include "figures/figures_internal.h"
#include "figures/sketch.h"
#include "methods/methods.h"
#include "methods/names.h"
#include "runs/trajectory.h"

#include <stdio.h>
#include <string.h>

static const FigureKind *const kinds[] = {&figure_strip, &figure_annotated, &figure_divergence, &figure_strobe, NULL};

const FigureKind *const *figure_kinds(void) { return kinds; }

bool figure_draw(const FigureKind *kind, Sketch *sketch, const FigureSpec *spec, Error *error) {
    for (int i = 0; kind->needs_contacts && i < spec->run_count; i++)
        if (spec->runs[i]->no_contacts)
            return error_input(error, spec->paths[i], "the run has no contacts, which the kind %s shows", kind->name);
    if (!kind->draw(sketch, spec, error)) return false;
    snprintf(sketch->title, sizeof sketch->title, "%s of %s", kind->name, spec->runs[0]->scene);
    for (int i = 0; i < spec->run_count; i++)
        text_add(sketch->title, sizeof sketch->title, "%s%s", i == 0 ? ": " : ", ", run_name(spec, spec->runs[i]).text);
    return true;
}

const FigureKind *figure_kind(const char *name, Error *error) {
    NameList known = {0};
    for (int i = 0; kinds[i] != NULL; i++) {
        if (strcmp(kinds[i]->name, name) == 0) return kinds[i];
        name_list_add(&known, kinds[i]->name);
    }
    if (file_name_ends_with(name, ".npz"))
        error_input(error, "figure", "the kind is missing before '%s'; known: %s", name, known.text);
    else
        error_unknown(error, "figure", name, "a kind of figure", &known);
    return NULL;
}

/* A text for LaTeX in which every character stands for itself, in any font encoding: those with a meaning, and those
   that OT1 has only in some fonts, are commands; bytes beyond ASCII stay as they are (UTF-8). */
static void latex_text(FILE *out, const char *text) {
    static const char *const commands[] = {
        ['\\'] = "\\textbackslash{}", ['~'] = "\\textasciitilde{}", ['^'] = "\\textasciicircum{}",
        ['<'] = "\\textless{}",       ['>'] = "\\textgreater{}",    ['|'] = "\\textbar{}"};
    for (char before = '\0'; *text != '\0'; before = *text++) {
        const size_t code = (unsigned char)*text;
        if (code < sizeof commands / sizeof *commands && commands[code] != NULL) {
            fputs(commands[code], out);
            continue;
        }
        if (strchr("#$%&_{}", *text) != NULL) putc('\\', out);
        /* Fonts join "--", "''", "``", ",,", "?`" and "!`" to one sign. */
        if (before != '\0' &&
            ((before == *text && strchr("-'`,", *text) != NULL) || (*text == '`' && (before == '?' || before == '!'))))
            fputs("{}", out);
        putc(*text, out);
    }
}

static void latex_code(FILE *out, const char *text) {
    fputs("\\texttt{", out);
    latex_text(out, text);
    fputs("}", out);
}

/* What stands before item `index` of a list of `count`: nothing, a comma or "and". */
static const char *latex_between(int index, int count) {
    if (index == 0) return "";
    return index < count - 1 ? ", " : " and ";
}

enum { TIMES_LISTED = 8 };

void caption_run(FILE *out, const FigureSpec *spec, const Trajectory *run) {
    const MethodDescription *method = method_describe(run->method);
    const RunName shown = run_name(spec, run), name = run_method_name(spec, run);
    Settings all;
    const bool own = strcmp(shown.text, name.text) != 0, described = method != NULL && method->caption != NULL;
    if (own) {
        latex_text(out, shown.text);
        fputs(" (", out);
    }
    latex_code(out, name.text);
    if (described) {
        fputs(own ? ", " : " (", out);
        latex_text(out, method->caption);
        if (run->program[0] != '\0') fputs(": ", out);
        latex_text(out, run->program);
        /* The sweeps that the method's text leaves to the scene. */
        Method known;
        const bool left = method_parse(&known, run->method, &(Error){0}) && settings_get(&known.settings, "k") == NULL;
        const char *sweeps =
            left && method_all_settings(&all, run->method, run->iterations) ? settings_get(&all, "k") : NULL;
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

static void figure_print(FILE *out, const void *context) {
    const Caption *caption = context;
    fputs("\\caption{", out);
    caption->kind->caption(out, caption->spec);
    fputs(" Drawn with twinbox~", out);
    latex_text(out, TWINBOX_VERSION);
    fputs(".}\n", out);
}

bool figure_write_caption(const FigureKind *kind, const FigureSpec *spec, const char *path, Error *error) {
    return file_write_text(path, figure_print, &(Caption){kind, spec}, error);
}
