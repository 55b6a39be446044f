/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of the report: template, findings, tables, plots, illustrations. */
#pragma once
#include "base/base.h"
#include "base/csv.h"
#include "engine/engine.h"
#include "figures/sketch.h"
#include "methods/methods.h"
#include "methods/pair.h"
#include "paper/paper.h"
#include "paper/paper_internal.h"
#include "scenes/scenes.h"

#include <stddef.h>

/* A Markdown text as one HTML5 page that needs no other file, for phones, screens and paper. */

typedef struct HtmlPage {
    const char *markdown; /* CommonMark with GitHub's tables; raw HTML in it is left out */
    const char *style;    /* CSS */
    const char *folder;   /* that paths of images are relative to */
} HtmlPage;

/* The first heading becomes the page's title, those of level 2 its table of contents. A paragraph that is only an image
   becomes a figure with the PNG file embedded; the paragraph after it is its caption. ERROR_INPUT where an image is
   missing or damaged. */
bool html_page_write(const HtmlPage *page, FILE *out, Error *error);

/* report.md.in and report.css, built into the program (CMakeLists.txt). Each ends in a 0. */

extern const unsigned char paper_report_md_in[], paper_report_css[];

/* Fills a Markdown template with values from CSV files. Its tags:

     {{NAME}}            the value NAME, as text, cut to the length of a name
     {{NAME text}}       the same, not cut: a text of one line of UTF-8
     {{NAME FORMAT}}     as a number: number (three significant digits), percent (0.25 is 25.0%), score (six decimals);
                         NAME may be a ratio: test/constant, frames/60
     {{caption FILE}}    the text of a file of one line
     {{each FILE FILTER ...}} TEXT {{end}}
                         the text, once for every row of the CSV file that passes all filters. A filter is COLUMN=WORD,
                         COLUMN=WORD|WORD, or COLUMN, which must equal the value COLUMN outside of the text. A line end
                         directly after {{each ...}} or {{end}} is left out.

   NAME is a column of the innermost row that has it; outside of all rows, a key of the values file (key, value). Empty
   fields and NaN or infinite numbers are shown as a dash. No character of a value has a meaning to Markdown. */

/* Paths in the template and that of the values file are relative to the folder. ERROR_INPUT for files that are missing
   or damaged, with path:line:column for CSV files; for tags that are wrong; for names without a value. */
bool template_fill(const char *template, const char *folder, const char *values, FILE *out, Error *error);

/* What the illustrations have in common; each is in illustration_NAME.c. */

enum { CAPTION_SIZE = 800 };

typedef enum IllustrationScene { SCENE_SINGLE, SCENE_STACK, SCENE_PYRAMID, ILLUSTRATION_SCENES } IllustrationScene;

typedef struct Illustration {
    double width, height; /* mm */
    /* Draws into an empty sketch of that size, and writes a caption: one line of text. */
    bool (*draw)(Sketch *sketch, Scene *const scenes[ILLUSTRATION_SCENES], char caption[CAPTION_SIZE], Error *error);
} Illustration;

extern const Illustration illustration_loop, illustration_narrow_phase, illustration_data, illustration_scenes;

/* The plots of report.h, from their tables. The page's width stays 0 if a table has no rows to show. False with error
   set if memory is short. */
typedef bool PlotWrite(const CsvTable *table, PlotPage *page, Error *error);
PlotWrite plot_factors, plot_closed_loop, plot_transfer;

extern const char *const paper_scene_titles[PAPER_SCENES]; /* of paper_scene_names, for readers */

/* A run of the engine, step by step, for figures that need a step's contact problem. */

typedef struct EngineRun {
    const Scene *scene; /* with the launch; owned by the caller */
    World *world;
    Stepper *stepper;
    int frame; /* of the last step; 0: no step yet */
    PhaseTracker tracker;
} EngineRun;

/* On failure nothing is to be ended. */
bool engine_run_begin(EngineRun *run, const Scene *launched, Error *error);
bool engine_run_step(EngineRun *run, Error *error);
void engine_run_end(EngineRun *run);

/* Steps until the bomb first touches a movable box. ERROR_INPUT if it never does. */
bool engine_run_to_touch(EngineRun *run, Error *error);

/* The box of a body as collision detection used it in the last step. */
Box engine_run_box(const EngineRun *run, int body);

/* The first contact of the pair that follows the one with first contact `first`; -1 for the first pair. The number of
   contacts after the last pair. */
int next_pair(const ContactProblem *problem, int first);

/* What the report states beyond the study's tables: counts, extremes, medians and verdicts, as CSV files in
   folder/findings.

     summary.csv       key, value: counts and extremes over all networks and runs
     targets.csv       each target: the constant predictor's error, the best small network, scores beside the paper's
     paper_table1.csv  the paper's Table 1
     factors.csv       each factor: its best network beside the baseline
     definitions.csv   each definition of a right prediction: how often a cheaper predictor is right as often
     laws.csv          each case of laws in the loss: medians over the seeds
     transfer.csv      each number of launches: medians over the seeds, and how many launches transfer needs
     aims.csv          the study's aims: whether they are reached
     claims.csv        the paper's claims about factors: the lowest error with and without

   An empty field is a number that is not applicable. */

/* Reads the study's tables (paper/paper_internal.h) from the folder. ERROR_INPUT where one is missing or damaged,
   with path:line:column. */
bool findings_write(const char *folder, Error *error);

/* The tables that the study wrote into its folder, read again, and look-ups in them. */

enum { STUDY_TABLES = 6 };

typedef struct StudyTables {
    const ScoreRow *scores;
    const TrainedRow *networks;
    const RateRow *rates;
    const ClosedLoopRow *runs;
    const LawRow *laws;
    const TransferRow *transfers;
    int score_count, network_count, rate_count, run_count, law_count, transfer_count;
    CsvTable tables[STUDY_TABLES]; /* owns the rows */
} StudyTables;

/* On failure nothing is to be freed. */
bool study_tables_read(StudyTables *study, const char *folder, Error *error);
void study_tables_free(StudyTables *study);

/* NULL if no network has that name. */
const TrainedRow *study_network(const StudyTables *study, const char *name);

/* The baseline; NULL if the study has none, or none with a ratio. */
const TrainedRow *study_baseline(const StudyTables *study);

/* Whether the network was trained for this factor. */
bool study_has_factor(const StudyTables *study, const char *network, const char *factor);

/* The network for a target with the lowest ratio, of those with at most max_parameters. factor: NULL for all. NULL if
   there is none. *among: how many it was chosen from. */
const TrainedRow *study_best(const StudyTables *study, PairTarget target, const char *factor, double max_parameters,
                             int *among);

/* NAN unless b is positive. */
double ratio_of(double a, double b);

/* The paper's outlook, counted: what laws in the loss and transfer learning bring. */

/* Of the cases with a single law in the loss and a positive weight, beside the network without laws. */
typedef struct LawCounts {
    int cases, obeyed, better; /* obeyed: the median violation of that law is lower; better: the median test error is */
} LawCounts;

LawCounts law_counts(const StudyTables *study);

/* Of the numbers of launches above the lowest. */
typedef struct TransferCounts {
    int rows, saved;                    /* saved: fewer launches suffice with transfer */
    double constant, scratch, transfer; /* errors, m/s: of the constant predictor; the lowest medians; NAN if unknown */
} TransferCounts;

TransferCounts transfer_counts(const StudyTables *study);

/* The tables of findings, one function each. */

typedef struct FindingsFile FindingsFile;

/* False with error set for numbers that are infinite. */
bool findings_add(const FindingsFile *file, const void *row);

typedef struct FindingsTable {
    CsvLayout layout;
    /* Adds all rows. */
    bool (*write)(const FindingsFile *file, const StudyTables *study);
} FindingsTable;

/* A table that is being written. */
struct FindingsFile {
    const FindingsTable *table;
    const StudyTables *study;
    FILE *out;
    Error *error;
};

/* In findings_tables.c; the others are in findings.c. */
extern const FindingsTable findings_targets, findings_paper_table1, findings_definitions, findings_laws,
    findings_transfer, findings_loops;

/* Columns of a row with members of these names; a text, a count, a number that may be NAN. */
#define FINDINGS_TEXT(Row, member) CSV_MEMBER(Row, member, CSV_TEXT)
#define FINDINGS_COUNT(Row, member) CSV_MEMBER(Row, member, CSV_INTEGER)
#define FINDINGS_NUMBER(Row, member) CSV_MEMBER(Row, member, CSV_OPTIONAL, .digits = 9)

/* An initialiser of a FindingsTable. */
#define FINDINGS_TABLE(name, columns, Row, write) \
    { CSV_LAYOUT(name, columns, Row, .min_rows = 0), write }
