/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "figure/figure_kinds.h"

#include "common/file.h"
#include "common/names.h"
#include "figure/run_view.h"

#include <stdio.h>
#include <string.h>

static const FigureKind *const kinds[] = {
    &figure_strip, &figure_annotated, &figure_divergence, &figure_strobe, &figure_network, &figure_pair, NULL};

const FigureKind *const *figure_kinds(void) { return kinds; }

/* Truncated at its end. */
static void append(char title[SKETCH_TEXT_SIZE], const char *before, const char *part) {
    const size_t used = strlen(title);
    snprintf(title + used, SKETCH_TEXT_SIZE - used, "%s%s", before, part);
}

static bool check_contacts(const FigureKind *kind, const FigureSpec *spec, Error *error) {
    for (int i = 0; kind->needs_contacts && i < spec->run_count; i++)
        if (spec->runs[i]->no_contacts)
            return error_input(error, spec->paths[i], "the run has no contacts, which the kind %s shows", kind->name);
    return true;
}

bool figure_draw(const FigureKind *kind, Sketch *sketch, const FigureSpec *spec, Error *error) {
    if (!check_contacts(kind, spec, error) || !kind->draw(sketch, spec, error)) return false;
    append(sketch->title, "", kind->name);
    if (spec->network != NULL)
        append(sketch->title, " of ", spec->network + file_folder_length(spec->network));
    else
        append(sketch->title, " of ", spec->runs[0]->scene);
    for (int i = 0; i < spec->run_count; i++)
        append(sketch->title, i == 0 ? ": " : ", ", run_name(spec, spec->runs[i]).text);
    return true;
}

const FigureKind *figure_kind(const char *name, Error *error) {
    NameList known = {0};
    for (int i = 0; kinds[i] != NULL; i++) {
        if (strcmp(kinds[i]->name, name) == 0) return kinds[i];
        name_list_add(&known, kinds[i]->name);
    }
    error_unknown(error, "figure", name, "a kind of figure", &known);
    return NULL;
}
