/* SPDX-License-Identifier: GPL-3.0-or-later */
/* report.md: the tables and figures of the study, with what their columns are. What they mean is judged where it is
   stated, by golden/findings/write. */
#include "paper/paper_report.h"

#include "base/base.h"
#include "base/csv.h"
#include "base/file.h"
#include "paper/paper_tables.h"
#include "studies/study_page.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { REPORT_CAPTION_MAX = 4096, REPORT_TABLE_MAX = 1 << 24, ROWS_SHOWN = 250 };

static const struct {
    const char *title, *sentence, *table, *figure; /* table and figure may be NULL */
} parts[] = {
    {"The engine", "One step of the engine, stage by stage.", NULL, "loop"},
    {"The narrow phase", "How two boxes touch.", NULL, "narrow-phase"},
    {"Training data", "Each touching pair of each step is a row.", NULL, "data"},
    {"The scenes", "Networks are trained on the first two, and rated on all.", NULL, "scenes"},
    {"What was done",
     "Launches are ranges of the bomb's x, \"least:most:step\" in m, or how many. Each network is trained on so many "
     "splits of its launches, a fifth of which are held out. A quick study shows that all parts work; its numbers mean "
     "nothing.",
     "study", NULL},
    {"Loss over training",
     "Errors on test and training rows, of networks whose outputs are scaled to their range; constant: of always "
     "predicting the mean of the training rows. range2: means of squares, each output in its range over the training "
     "rows.",
     "table1", "loss"},
    {"One factor at a time",
     "Each network differs from the baseline in its factor; seed: of the split by launch and of the first weights; "
     "range2: as above; ratio: test error over that of the constant, so that 1 has learned nothing, on both scenes and "
     "on each; largest: share of the test error that its ten largest rows make; accuracy: share of test rows within 5% "
     "of the outputs' range.",
     "networks", "factors"},
    {"Always the mean", "Errors of the constant on all rows of the paper's launches, by split, and on each scene.",
     "constants", NULL},
    {"Rates of right predictions",
     "Shares of right predictions by three definitions, of the network, the constant, and the engine with 1, 4 and 10 "
     "sweeps; the network warm-start repeats the impulses of the step before.",
     "rates", "rates"},
    {"In place of the solver",
     "Frames until a body is 0.1 m from its place in the converged run with the same contacts, deepest penetration "
     "(m), momentum created per step (N s), highest energy over that put in, and time per step beside that of the "
     "engine; solvers are at the end.",
     "closed_loop", "closed-loop"},
    {"Laws in the loss",
     "Test error and mean violation of each law; the row engine has the violations of the labels themselves.", "laws",
     "laws"},
    {"Transfer",
     "RMS velocity errors (m/s) on held-out launches of the pyramid, from scratch and after the smaller scenes.",
     "transfer", "transfer"},
    {"The systems that the paper cites",
     "On held-out launches, each method on its own run: frames until a body is 0.1 m from its place in the engine's "
     "run and in the converged run with the same contacts, boxes that moved, deepest penetration (m), energy (J) and "
     "momentum (N s) created, share of steps solved by simpler means, and time per step beside that of the engine.",
     "system_scores", NULL},
};

/* No character of a field has a meaning to Markdown. */
static void put_field(FILE *out, const char *text) {
    fputs("| ", out);
    for (; *text != '\0'; text++) {
        if (strchr("\\`*_{}[]<>#|&$~", *text) != NULL) putc('\\', out);
        putc(*text, out);
    }
    putc(' ', out);
}

/* Longer tables are linked only. */
static bool put_table(FILE *out, const char *folder, const char *name, Error *error) {
    Csv csv;
    char path[PATH_MAX];
    if (!file_path(path, sizeof path, error, "%s/%s.csv", folder, name) ||
        !csv_read(&csv, path, REPORT_TABLE_MAX, 0, PAPER_MAX_ROWS, error))
        return false;
    const int rows = csv.rows - 1 <= ROWS_SHOWN ? csv.rows : 0;
    fprintf(out, "\n[%s.csv](%s.csv): %d rows\n\n", name, name, csv.rows - 1);
    for (int row = 0; row < rows; row++) {
        for (int field = 0; field < csv.width; field++) put_field(out, csv_text(&csv, row, field));
        fputs("|\n", out);
        for (int field = 0; row == 0 && field < csv.width; field++) fputs("|---", out);
        if (row == 0) fputs("|\n", out);
    }
    csv_free(&csv);
    return true;
}

static bool put_report(void *folder, FILE *out, Error *error) {
    fputs("# Can neural networks enhance physics simulations? The paper, reproduced\n\n"
          "Avatavului, Ifrim, Voncilă 2023, <https://doi.org/10.18662/brain/14.2/445>. Where the paper can be read in "
          "several ways, every reading was tried.\n",
          out);
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        const char *figure = parts[i].figure, *table = parts[i].table;
        fprintf(out, "\n## %s\n\n%s\n", parts[i].title, parts[i].sentence);
        if (figure != NULL) {
            char path[PATH_MAX];
            size_t size;
            if (!file_path(path, sizeof path, error, "%s/figures/%s.txt", (const char *)folder, figure)) return false;
            char *caption = file_read(path, REPORT_CAPTION_MAX, &size, error);
            if (caption == NULL) return false;
            caption[strcspn(caption, "\n")] = '\0';
            fprintf(out, "\n![%s](figures/%s.png)\n\n%s\n", figure, figure, caption);
            free(caption);
        }
        if (table != NULL && !put_table(out, folder, table, error)) return false;
    }
    return true;
}

bool paper_report_write(const char *folder, Error *error) {
    char path[PATH_MAX];
    return file_path(path, sizeof path, error, "%s/report.md", folder) &&
           text_write(path, put_report, (void *)folder, error);
}
