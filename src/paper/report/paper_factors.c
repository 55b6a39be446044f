/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Networks that differ from the baseline in one thing, and the search over hidden layers. */
#include "paper/report/paper_parts.h"

#include <math.h>
#include <string.h>

static const char columns[] =
    "Value|Target|Layers|Hidden, output|>Parameters|>Test|>Constant|>Test / constant|>Accuracy|Gate";

static void put_row(Document *document, const NetworkRow *row) {
    document_name(document, row->value[0] != '\0' ? row->value : row->network);
    document_name(document, row->target);
    document_name(document, row->layers);
    document_cell(document, "%.24s, %.24s", csv_show(row->hidden).text, csv_show(row->output).text);
    document_cell(document, "%.0f", row->parameters);
    document_number(document, row->test);
    document_number(document, row->constant);
    document_number(document, row->ratio);
    document_percent(document, row->accuracy);
    document_cell(document, "%s", isnan(row->accuracy) ? "–" : row->accuracy > PAPER_GATE ? "passes" : "fails");
}

/* Only networks asked for the same can be better or worse. */
static const NetworkRow *best_of(const PaperFiles *files, const char *factor, const char *target) {
    const NetworkRow *best = NULL;
    for (int i = 0; i < files->network_count; i++) {
        const NetworkRow *row = &files->networks[i];
        if (strcmp(row->factor, factor) != 0 || strcmp(row->target, target) != 0 || isnan(row->ratio)) continue;
        if (best == NULL || row->ratio < best->ratio) best = row;
    }
    return best;
}

/* The least error of the factor's values, beside the baseline's. */
static void put_best(Document *document, const PaperFiles *files, const NetworkRow *baseline, const char *factor) {
    if (baseline == NULL || isnan(baseline->ratio)) return;
    const NetworkRow *best = best_of(files, factor, baseline->target);
    if (best == NULL || best == baseline) return;
    const char *verdict = best->ratio < 1       ? best->ratio < baseline->ratio ? "better than" : "not better than"
                          : baseline->ratio < 1 ? "no better than the constant, and worse than"
                                                : "no better than the constant, beside";
    document_paragraph(document, "Least for the target %s: %s, %s of the constant's error; %s the baseline with %s.",
                       csv_show(best->target).text, csv_show(best->value[0] != '\0' ? best->value : best->network).text,
                       show_percent(best->ratio).text, verdict, show_percent(baseline->ratio).text);
}

static void put_factor(Document *document, const PaperFiles *files, const char *factor) {
    const NetworkRow *baseline = paper_network_row(files, "baseline");
    char caption[128];
    snprintf(caption, sizeof caption, "Factor: %s", csv_show(factor).text);
    document_table(document, caption, columns);
    if (baseline != NULL && strcmp(factor, "baseline") != 0) {
        NetworkRow row = *baseline;
        row.value = "(baseline)";
        put_row(document, &row);
    }
    for (int i = 0; i < files->network_count; i++)
        if (strcmp(files->networks[i].factor, factor) == 0) put_row(document, &files->networks[i]);
    put_best(document, files, baseline, factor);
}

static bool is_search(const char *factor) { return strcmp(factor, "layers") == 0; }

/* Whether the factor is named here for the first time, and has its table in this part. */
static bool begins_factor(const PaperFiles *files, int row) {
    for (int i = 0; i < row; i++)
        if (strcmp(files->networks[i].factor, files->networks[row].factor) == 0) return false;
    return !is_search(files->networks[row].factor);
}

static void put_search(Document *document, const PaperFiles *files) {
    if (paper_network_row(files, "layers") == NULL) return;
    int networks = 0, passed = 0;
    for (int i = 0; i < files->network_count; i++) {
        if (!is_search(files->networks[i].factor)) continue;
        networks++;
        passed += files->networks[i].accuracy > PAPER_GATE;
    }
    document_heading(document, 2, "The search over hidden layers");
    document_paragraph(
        document,
        "The paper tried one to four hidden layers, each about as wide as the mean of inputs and outputs, and "
        "put what passed the gate into the engine. Here %d of %d pass it.",
        passed, networks);
    put_factor(document, files, "layers");
}

void paper_put_factors(Document *document, const PaperFiles *files) {
    document_heading(document, 2, "One factor at a time");
    document_paragraph(document,
                       "Each network differs from the baseline in one thing. The ratio to the constant can be compared "
                       "across targets and scales; the error alone cannot. Accuracy is the share of test predictions "
                       "within 5%% of the output's range, which the paper's gate asks to be over 90%%. A ratio of 1 or "
                       "more with a passed gate means that the gate lets through what has learned nothing.");
    for (int i = 0; i < files->network_count; i++)
        if (begins_factor(files, i)) put_factor(document, files, files->networks[i].factor);
    document_figure(document, &files->figures[FIGURE_FACTORS]);
    put_search(document, files);
}
