/* SPDX-License-Identifier: GPL-3.0-or-later */
/* twinbox paper: the study of the paper, its figures and its report. */
#include "base/base.h"
#include "base/file.h"
#include "cli/cli.h"
#include "cli/common_options.h"
#include "cli/installed.h"
#include "cli/options.h"
#include "cli/output_checks.h"
#include "cli/progress_bar.h"
#include "paper/paper.h"
#include "paper/paper_report.h"
#include "runs/pieces.h"

typedef struct Options {
    PaperOptions study;
} Options;

static const Option option_table[] = {
    {"--output", 'o', "DIR", "Folder for tables, figures, networks and the report", OPTION_TEXT(Options, study.folder),
     .needed = "-o DIR is needed"},
    {"--scenes", 0, "DIR",
     "Folder with single.yaml, stack.yaml, pyramid.yaml and pyramid_settled.yaml (default: scenes, or the installed "
     "scenes)",
     OPTION_TEXT(Options, study.scenes)},
    {"--quick", 0, NULL, "Fewer networks, launches and iterations: under a minute", OPTION_FLAG(Options, study.quick)},
    {"--seed", 0, "N", "Seed of launches, splits and initial weights (default: 1)", OPTION_SEED(Options, study.seed)},
    {OPTION_SHARD(Options, study.shard)},
    {0}};

static const CommandSpec spec = {
    .options = option_table,
    .help =
        "Reproduce the paper (Avatavului, Ifrim, Voncila 2023) from seed to report: train its networks in every "
        "reading, one factor at a time, rate them, replace the solver by them, and try what the paper leaves to future "
        "work. Score the systems that it cites. Writes every table as CSV, every figure as PNG and SVG, and "
        "report.md, which shows them. Takes some six minutes on two cores. An interrupted run continues where "
        "it stopped.\v"
        "Example: twinbox paper -o out/paper\n"
        "         twinbox paper -o out/paper-quick --quick"};

static bool draw_and_report(const PaperOptions *study, Error *error) {
    enum { PATH_SIZE = 4096 };
    char figures[PATH_SIZE];
    if (!file_path(figures, sizeof figures, error, "%s/figures", study->folder)) return false;
    if (!file_make_directory(figures, error) || !illustrations_draw(study->scenes, figures, error) ||
        !plots_draw(study->folder, progress_bar_begin("figures"), error) || !paper_report_write(study->folder, error))
        return false;
    printf("tables, figures, networks -> %s\nreport -> %s/report.md\n", study->folder, study->folder);
    return true;
}

bool command_paper(int argc, char **argv, Error *error) {
    Options options = {.study = {.scenes = installed_path("scenes"), .seed = 1, .draw = draw_and_report}};
    Pieces pieces = {0};
    if (!options_parse(&spec, argc, argv, &options, error) || !output_check_folder(options.study.folder, error))
        return false;
    const bool ok = paper_run(&options.study, &pieces, progress_bar_begin("paper"), error);
    progress_bar_end();
    if (ok && options.study.shard.count > 0) shard_option_print(&pieces);
    return ok;
}
