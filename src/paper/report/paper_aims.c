/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the study set out to reach. */
#include "paper/report/paper_parts.h"

#include <math.h>

/* Rates are to be at least the aim, ratios at most. What costs nothing may reach it, too. */
static void put_verdict(Document *document, double value, double for_nothing, double aim, bool at_least) {
    double missed = at_least ? aim - value : value - aim;
    if (isnan(value))
        document_cell(document, "not measured");
    else if (missed <= 0)
        document_cell(document, "reached%s", at_least && for_nothing >= aim ? ", also for nothing" : "");
    else if (at_least)
        document_cell(document, "missed by %.1f points", 100 * missed);
    else
        document_cell(document, "missed by %s", show_number(missed).text);
}

static void put_ratio(Document *document, const PaperFiles *files, const PaperTarget *target) {
    int among;
    const NetworkRow *best = paper_best(files, target->name, &among);
    document_cell(document, "Test / constant, target %s", target->name);
    document_cell(document, "at most %g", target->aim);
    document_name(document, best != NULL ? best->network : "none");
    document_number(document, best != NULL ? best->ratio : NAN);
    document_cell(document, "1");
    put_verdict(document, best != NULL ? best->ratio : NAN, 1, target->aim, false);
}

static void put_rate(Document *document, const PaperFiles *files, const char *scene, double aim) {
    const RateRow *row = paper_contact_net_rate(files, scene);
    const RateRow *warm = paper_rate(files, "warm-start", scene, "absolute", "all");
    document_cell(document, "contact-net within 0.1 m/s, %s", scene);
    document_cell(document, "at least %.0f%%", 100 * aim);
    document_name(document, row != NULL ? row->network : "none");
    document_percent(document, row != NULL ? row->rate : NAN);
    document_percent(document, warm != NULL ? warm->rate : NAN);
    put_verdict(document, row != NULL ? row->rate : NAN, warm != NULL ? warm->rate : NAN, aim, true);
}

void paper_put_aims(Document *document, const PaperFiles *files) {
    document_heading(document, 2, "Aims");
    document_paragraph(
        document,
        "Ratios are those of the best network with at most %d parameters, chosen by that very score. Beside "
        "them stands what costs nothing: the constant for ratios, the warm start for rates.",
        PAPER_SMALL_NETWORK);
    document_table(document, "Aims", "Figure|Aim|Network|>Measured|>For nothing|Verdict");
    for (int i = 0; i < PAPER_TARGETS; i++) put_ratio(document, files, &paper_targets[i]);
    put_rate(document, files, "single", 0.95);
    put_rate(document, files, "stack", 0.75);
}
