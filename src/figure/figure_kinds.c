/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "figure/figure_kinds.h"

#include <stdio.h>
#include <string.h>

static const FigureKind *const kinds[] = {
    &figure_strip, &figure_annotated, &figure_divergence, &figure_strobe, &figure_network, &figure_pair, NULL};

const FigureKind *const *figure_kinds(void) { return kinds; }

const FigureKind *figure_kind(const char *name, Error *error) {
    char names[256] = "";
    for (int i = 0; kinds[i] != NULL; i++) {
        if (strcmp(kinds[i]->name, name) == 0) return kinds[i];
        size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s%s", i > 0 ? ", " : "", kinds[i]->name);
    }
    error_input(error, "figure", "'%s' is not a kind of figure; the kinds are %s", name, names);
    return NULL;
}
