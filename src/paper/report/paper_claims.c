/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The paper's claims, each beside what was measured; and what the study was. */
#include "paper/report/paper_parts.h"

#include <math.h>
#include <string.h>

typedef enum Side { WITHOUT, WITH, NEITHER } Side;

/* A claim that a choice of the paper's lowers the error, and which side a network of the factor is on. */
typedef struct FactorClaim {
    const char *claim, *factor;
    Side (*side)(const NetworkRow *row);
} FactorClaim;

static Side side_of_word(const char *word, const char *with, const char *without) {
    if (strcmp(word, with) == 0) return WITH;
    return strncmp(word, without, strlen(without)) == 0 ? WITHOUT : NEITHER;
}

/* raw, or raw-unturned. */
static Side by_inputs(const NetworkRow *row) { return side_of_word(row->inputs, "relative", "raw"); }
static Side by_labels(const NetworkRow *row) { return side_of_word(row->labels, "reference", "engine"); }
/* Each with the scale that goes with it. */
static Side by_output(const NetworkRow *row) {
    Side side = side_of_word(row->output, "linear", "sigmoid");
    return strcmp(row->scale, side == WITH ? "standard" : "minmax") == 0 ? side : NEITHER;
}

static Side by_data(const NetworkRow *row) { return side_of_word(row->data, "swept", "random"); }

/* 10-10-10-2 has two hidden layers. */
static Side by_layers(const NetworkRow *row) {
    int dashes = 0;
    for (const char *c = row->layers; *c != '\0'; c++) dashes += *c == '-';
    return dashes == 3 ? WITH : dashes == 2 ? WITHOUT : NEITHER;
}

static const FactorClaim claims[] = {
    {"Relative inputs make learning easier than raw ones (3.1)", "inputs", by_inputs},
    {"Linear outputs, standardised, raise the accuracy (3.1)", "scaling", by_output},
    {"Launches swept in even steps are better than random ones (3.3)", "data", by_data},
    {"A second hidden layer helps (3.3)", "layers", by_layers},
    {"A more accurate source of data pays (2)", "labels", by_labels},
};

enum { CLAIMS = sizeof claims / sizeof *claims };

/* Least ratio among the rows of the factor and the baseline with and without the choice; NAN where there are none. */
static void compare(const PaperFiles *files, const FactorClaim *claim, double least[NEITHER]) {
    least[WITHOUT] = least[WITH] = NAN;
    for (int i = 0; i < files->network_count; i++) {
        const NetworkRow *row = &files->networks[i];
        if (strcmp(row->factor, claim->factor) != 0 && strcmp(row->factor, "baseline") != 0) continue;
        Side side = claim->side(row);
        if (side != NEITHER) least[side] = fmin(least[side], row->ratio); /* of a number and NAN, the number */
    }
}

static void put_claim(Document *document, const PaperFiles *files, const FactorClaim *claim) {
    double least[NEITHER];
    compare(files, claim, least);
    if (isnan(least[WITHOUT]) || isnan(least[WITH])) return;
    const char *verdict = least[WITH] >= 1 && least[WITHOUT] >= 1 ? "Neither is better than the constant"
                          : least[WITH] < least[WITHOUT]          ? "Holds here"
                                                                  : "Does not hold here";
    document_item(document, "%s. Least error over the constant's: %s with it, %s without. %s.", claim->claim,
                  show_number(least[WITH]).text, show_number(least[WITHOUT]).text, verdict);
}

static void put_rates(Document *document, const PaperFiles *files) {
    int rows = 0, beaten = 0;
    for (int i = 0; i < files->rate_count; i++) {
        const RateRow *row = &files->rates[i];
        if (strcmp(row->network, "warm-start") == 0 || isnan(row->rate) || isnan(row->constant)) continue;
        rows++;
        beaten += row->rate <= row->constant;
    }
    if (rows == 0) return;
    document_item(
        document,
        "A network can replicate the engine with acceptable accuracy (5). In %d of %d rates, over all networks, "
        "scenes, definitions and phases, it is not right more often than the constant.",
        beaten, rows);
}

static void put_runs(Document *document, const PaperFiles *files) {
    int stacks = 0, stand = 0, dearer = 0, costs = 0;
    for (int i = 0; i < files->closed_loop_count; i++) {
        const ClosedLoopRow *row = &files->closed_loop[i];
        if (strcmp(row->network, "warm-start") == 0) continue;
        bool stack = strcmp(row->scene, "stack") == 0;
        stacks += stack;
        stand += stack && row->frames >= PAPER_RUN_FRAMES;
        costs += !isnan(row->us_step) && !isnan(row->us_engine);
        dearer += row->us_step > row->us_engine;
    }
    if (stacks > 0)
        document_item(
            document,
            "It cannot completely replace the engine (5). In %d of %d runs of the stack the network keeps it as the "
            "engine does.",
            stand, stacks);
    if (costs > 0)
        document_item(document, "It slows the engine down (4). A step takes longer than the engine's in %d of %d runs.",
                      dearer, costs);
}

static void put_outlook(Document *document, const PaperFindings *findings) {
    if (findings->law_cases > 0)
        document_item(
            document,
            "Physical laws in the loss could improve the accuracy (5). They lower the test error in %d of %d cases, "
            "and the violations of the law in question in %d.",
            findings->laws_better, findings->law_cases, findings->laws_obeyed);
    if (findings->transfer_rows > 0)
        document_item(
            document,
            "Transfer learning could help (5). It needs fewer launches than training from scratch in %d of %d "
            "comparisons.",
            findings->transfer_saved, findings->transfer_rows);
}

void paper_put_claims(Document *document, const PaperFiles *files, const PaperFindings *findings) {
    document_heading(document, 2, "The paper's claims, and what was found");
    document_paragraph(document,
                       "In brackets: the paper's section. Compared are the baseline and the networks that differ "
                       "from it in that one thing.");
    for (int i = 0; i < CLAIMS; i++) put_claim(document, files, &claims[i]);
    put_rates(document, files);
    put_runs(document, files);
    put_outlook(document, findings);
}

void paper_put_study(Document *document, const PaperFiles *files) {
    document_heading(document, 2, "How this was made");
    document_paragraph(document,
                       "By twinbox paper, from seed to report; every table is there as CSV beside this file.");
    document_table(document, "The study", "Key|Value");
    for (int i = 0; i < files->study_count; i++) {
        document_name(document, files->study[i].key);
        document_name(document, files->study[i].value);
    }
}
