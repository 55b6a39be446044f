/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The few numbers that decide. */
#include "paper/report/paper_parts.h"

#include <math.h>
#include <string.h>

static void put_constant(Document *document, const PaperFiles *files, const PaperTarget *target) {
    double constant = paper_constant(files, target->name);
    if (isnan(constant)) return;
    int worse = 0;
    for (int i = 0; i < PAPER_ROWS; i++) worse += paper_scores[i].test > constant;
    document_item(
        document,
        "Target %s (%s): always saying the mean has a test error of %s on the paper's scale. %d of the %d rows of "
        "the paper's Table 1 are worse.",
        target->name, target->words, show_number(constant).text, worse, PAPER_ROWS);
}

static void put_best(Document *document, const PaperFiles *files, const PaperTarget *target) {
    int among;
    const NetworkRow *best = paper_best(files, target->name, &among);
    if (best == NULL) return;
    document_item(
        document,
        "Networks of at most %d parameters for the target %s: %d. The best, %s, has %s of the constant's error.",
        PAPER_SMALL_NETWORK, target->name, among, csv_show(best->network).text, show_percent(best->ratio).text);
}

static void put_gate(Document *document, const PaperFiles *files) {
    int known = 0, passed = 0, useless = 0;
    for (int i = 0; i < files->network_count; i++) {
        const NetworkRow *row = &files->networks[i];
        if (isnan(row->accuracy) || isnan(row->ratio)) continue;
        known++;
        passed += row->accuracy > PAPER_GATE;
        useless += row->accuracy > PAPER_GATE && row->ratio >= 1;
    }
    document_item(
        document,
        "The paper puts a network into the engine when it is right in over 90%% of cases. %d of %d networks "
        "pass that gate, read as \"within 5%% of the output's range\"; %d of those that pass are no better than "
        "the constant.",
        passed, known, useless);
}

static void put_rate(Document *document, const PaperFiles *files, const NetworkRow *baseline, const char *definition,
                     const char *words) {
    double least = INFINITY, most = -INFINITY;
    int count = 0, beaten = 0;
    for (int i = 0; i < files->rate_count; i++) {
        const RateRow *row = &files->rates[i];
        if (strcmp(row->network, baseline->network) != 0 || strcmp(row->definition, definition) != 0 ||
            strcmp(row->phase, "all") != 0 || isnan(row->rate))
            continue;
        least = fmin(least, row->rate);
        most = fmax(most, row->rate);
        beaten += row->rate <= row->constant;
        count++;
    }
    if (count == 0) return;
    document_item(
        document,
        "Counted as %s, the baseline is right in %s to %s of cases over %d scenes; in %d of them the constant is "
        "right at least as often. The paper reports 60%% to 91%% and does not define them.",
        words, show_percent(least).text, show_percent(most).text, count, beaten);
}

static void put_closed_loop(Document *document, const PaperFiles *files) {
    int runs = 0, together = 0;
    double shortest = PAPER_RUN_FRAMES;
    for (int i = 0; i < files->closed_loop_count; i++) {
        const ClosedLoopRow *row = &files->closed_loop[i];
        if (strcmp(row->network, "warm-start") == 0) continue;
        runs++;
        together += row->frames >= PAPER_RUN_FRAMES;
        shortest = fmin(shortest, row->frames);
    }
    if (runs == 0) return;
    if (together == runs) {
        document_item(
            document,
            "With a network in place of the solver, all %d runs stay within 0.1 m of the engine's for %d frames.", runs,
            PAPER_RUN_FRAMES);
        return;
    }
    document_item(
        document,
        "With a network in place of the solver, %d of %d runs stay within 0.1 m of the engine's for %d frames "
        "(10 s); the first leaves it after frame %s.",
        together, runs, PAPER_RUN_FRAMES, show_number(shortest).text);
}

static void put_contact_net(Document *document, const PaperFiles *files) {
    static const char *const scenes[] = {"single", "stack"};
    for (int i = 0; i < 2; i++) {
        const RateRow *row = paper_contact_net_rate(files, scenes[i]);
        const RateRow *warm = paper_rate(files, "warm-start", scenes[i], "absolute", "all");
        if (row == NULL) continue;
        document_item(
            document,
            "Beyond the paper, scene %s: a network that gives impulses, %s, is within 0.1 m/s in %s of cases; the "
            "impulses of the step before, unchanged, in %s.",
            scenes[i], csv_show(row->network).text, show_percent(row->rate).text,
            show_percent(warm != NULL ? warm->rate : NAN).text);
    }
}

void paper_put_summary(Document *document, const PaperFiles *files) {
    document_heading(document, 2, "Summary");
    for (int i = 0; i < PAPER_TARGETS; i++) {
        put_constant(document, files, &paper_targets[i]);
        put_best(document, files, &paper_targets[i]);
    }
    put_gate(document, files);
    const NetworkRow *baseline = paper_network_row(files, "baseline");
    if (baseline != NULL) {
        put_rate(document, files, baseline, "range", "right within 5% of the output's range");
        put_rate(document, files, baseline, "absolute", "right within 0.1 m/s");
    }
    put_closed_loop(document, files);
    put_contact_net(document, files);
}
