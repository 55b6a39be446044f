/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Physical laws in the loss: medians over the seeds. */
#include "paper/report/paper_parts.h"
#include "study/statistics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LAWS_FIGURES = 6 }; /* test, ratio, four violations */

typedef struct LawsMedians {
    int seeds;
    double least_test, most_test;
    double medians[LAWS_FIGURES];
} LawsMedians;

static double figure_of(const LawsRow *row, int figure) {
    if (figure == 0) return row->test;
    return figure == 1 ? row->test / row->constant : row->violations[figure - 2];
}

/* An empty weight is a weight, too. */
static bool same_case(const LawsRow *a, const LawsRow *b) {
    return strcmp(a->laws, b->laws) == 0 && (a->weight == b->weight || (isnan(a->weight) && isnan(b->weight)));
}

static LawsMedians medians_of(const PaperFiles *files, const LawsRow *of, double *values) {
    LawsMedians medians = {0};
    for (int figure = 0; figure < LAWS_FIGURES; figure++) {
        int count = 0;
        medians.seeds = 0;
        for (int i = 0; i < files->law_count; i++) {
            if (!same_case(&files->laws[i], of)) continue;
            medians.seeds++;
            double value = figure_of(&files->laws[i], figure);
            if (isfinite(value)) values[count++] = value;
        }
        medians.medians[figure] = statistics_quantile(values, count, 0.5);
        if (figure > 0) continue;
        /* Now sorted. */
        medians.least_test = count > 0 ? values[0] : NAN;
        medians.most_test = count > 0 ? values[count - 1] : NAN;
    }
    return medians;
}

static void put_row(Document *document, const LawsRow *row, const LawsMedians *medians) {
    document_name(document, row->laws);
    document_number(document, row->weight);
    document_cell(document, "%d", medians->seeds);
    document_number(document, medians->medians[0]);
    if (isnan(medians->least_test))
        document_number(document, NAN);
    else
        document_cell(document, "%s to %s", show_number(medians->least_test).text,
                      show_number(medians->most_test).text);
    for (int i = 1; i < LAWS_FIGURES; i++) document_number(document, medians->medians[i]);
}

static bool is_first(const PaperFiles *files, int row) {
    for (int i = 0; i < row; i++)
        if (same_case(&files->laws[i], &files->laws[row])) return false;
    return true;
}

/* Which violation a law means; -1 for all, none and the engine. */
static int law_number(const char *laws) {
    static const char *const names[] = {"momentum", "energy", "approach", "cone"};
    for (int i = 0; i < 4; i++)
        if (strcmp(laws, names[i]) == 0) return i;
    return -1;
}

static void count_case(const LawsRow *row, const LawsMedians *medians, const LawsMedians *none,
                       PaperFindings *findings) {
    int law = law_number(row->laws);
    if (law < 0 || !(row->weight > 0)) return;
    findings->law_cases++;
    findings->laws_obeyed += medians->medians[law + 2] < none->medians[law + 2];
    findings->laws_better += medians->medians[0] < none->medians[0];
}

static const LawsRow *row_without(const PaperFiles *files) {
    for (int i = 0; i < files->law_count; i++)
        if (strcmp(files->laws[i].laws, "none") == 0) return &files->laws[i];
    return NULL;
}

static void put_table(Document *document, const PaperFiles *files, double *values, PaperFindings *findings) {
    document_table(
        document, "Laws in the loss, medians over seeds",
        "Laws|>Weight|>Seeds|>Test|>Least to most|>Test / constant|>Momentum (kg m/s)|>Energy (J)|>Approach (m/s)|"
        ">Cone (N s)");
    const LawsRow *without = row_without(files);
    LawsMedians none = {0};
    if (without != NULL) none = medians_of(files, without, values);
    for (int i = 0; i < files->law_count; i++) {
        if (!is_first(files, i)) continue;
        LawsMedians medians = medians_of(files, &files->laws[i], values);
        put_row(document, &files->laws[i], &medians);
        if (without != NULL) count_case(&files->laws[i], &medians, &none, findings);
    }
    if (findings->law_cases == 0) return;
    document_paragraph(
        document,
        "Of %d cases with a single law in the loss, %d break that law less than the network without, and %d "
        "have a lower test error.",
        findings->law_cases, findings->laws_obeyed, findings->laws_better);
}

void paper_put_laws(Document *document, const PaperFiles *files, PaperFindings *findings) {
    document_heading(document, 2, "Physical laws in the loss");
    document_paragraph(document,
                       "The paper's outlook: violations of physical laws are added to the loss. The table has "
                       "the mean violation of each law on the test rows. The row \"engine\" is what the labels "
                       "themselves violate: what is less than that was not learned from them.");
    double *values = malloc((size_t)files->law_count * sizeof *values);
    if (values == NULL)
        document->failed = true;
    else
        put_table(document, files, values, findings);
    free(values);
    document_figure(document, &files->figures[FIGURE_LAWS]);
}
