/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kinds of figures. */
#include "figures/figure.h"

#include "base/base.h"
#include "base/file.h"
#include "figures/figures_internal.h"
#include "figures/sketch.h"
#include "runs/trajectory.h"

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
