/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "figure/figure_kinds.h"

#include "common/names.h"

#include <stdio.h>
#include <string.h>

static const FigureKind *const kinds[] = {
    &figure_strip, &figure_annotated, &figure_divergence, &figure_strobe, &figure_network, &figure_pair, NULL};

const FigureKind *const *figure_kinds(void) { return kinds; }

const FigureKind *figure_kind(const char *name, Error *error) {
    NameList known = {0};
    for (int i = 0; kinds[i] != NULL; i++) {
        if (strcmp(kinds[i]->name, name) == 0) return kinds[i];
        name_list_add(&known, kinds[i]->name);
    }
    error_unknown(error, "figure", name, "a kind of figure", &known);
    return NULL;
}
