/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The paper's Table 1, one table a target. */
#include "paper/report/paper_parts.h"

#include <math.h>
#include <string.h>

static double paper_test(double iteration) {
    for (int i = 0; i < PAPER_ROWS; i++)
        if (paper_scores[i].iteration == iteration) return paper_scores[i].test;
    return NAN;
}

/* As many digits as the paper gives. */
static void put_score(Document *document, double score) {
    if (isnan(score) || score >= 10)
        document_number(document, score);
    else
        document_cell(document, "%.6f", score);
}

typedef struct Tally {
    int rows, above_constant, compared, below_paper, useful; /* useful: below the paper and below the constant */
} Tally;

static void put_row(Document *document, const PaperFiles *files, const Table1Row *row, Tally *tally) {
    double paper = paper_comparable(files, row->network, row->target) ? paper_test(row->iteration) : NAN;
    document_name(document, row->network);
    document_name(document, row->optimizer);
    document_cell(document, "%.0f", row->iteration);
    put_score(document, row->test);
    put_score(document, row->train);
    put_score(document, row->constant);
    document_number(document, row->constant > 0 ? row->test / row->constant : NAN);
    put_score(document, paper);
    tally->rows++;
    tally->above_constant += row->test >= row->constant;
    tally->compared += !isnan(paper);
    tally->below_paper += row->test < paper;
    tally->useful += row->test < paper && row->test < row->constant;
}

static void put_target(Document *document, const PaperFiles *files, const char *target) {
    char caption[128];
    snprintf(caption, sizeof caption, "Table 1 of the paper, target %s", csv_show(target).text);
    document_table(document, caption,
                   "Network|Optimiser|>Iteration|>Test|>Train|>Constant|>Test / constant|>The paper's test");
    Tally tally = {0};
    for (int i = 0; i < files->table1_count; i++)
        if (strcmp(files->table1[i].target, target) == 0) put_row(document, files, &files->table1[i], &tally);
    document_paragraph(document, "Of these %d rows, %d are no better than the constant.", tally.rows,
                       tally.above_constant);
    if (tally.compared == 0) return;
    document_paragraph(
        document,
        "%d of the %d rows with a counterpart are below the paper's score; %d of them are below the constant "
        "too, and only those count.",
        tally.below_paper, tally.compared, tally.useful);
}

static bool is_first(const PaperFiles *files, int row) {
    for (int i = 0; i < row; i++)
        if (strcmp(files->table1[i].target, files->table1[row].target) == 0) return false;
    return true;
}

static void put_paper(Document *document) {
    document_table(document, "Table 1 as the paper prints it", ">Iteration|>Test|>Train");
    for (int i = 0; i < PAPER_ROWS; i++) {
        document_cell(document, "%.0f", paper_scores[i].iteration);
        document_cell(document, "%.6f", paper_scores[i].test);
        document_cell(document, "%.6f", paper_scores[i].train);
    }
}

void paper_put_table1(Document *document, const PaperFiles *files) {
    document_heading(document, 2, "Table 1: loss over training");
    document_paragraph(document,
                       "Mean squared error of the normalised outputs; an iteration is one step on all training "
                       "rows. Launches, not rows, are divided into training and test, or nearly the same rows "
                       "would lie on both sides. The paper's scores stand only beside its own targets with outputs "
                       "scaled as it scales them, to [0, 1].");
    put_paper(document);
    for (int i = 0; i < files->table1_count; i++)
        if (is_first(files, i)) put_target(document, files, files->table1[i].target);
    document_figure(document, &files->figures[FIGURE_LOSS]);
}
