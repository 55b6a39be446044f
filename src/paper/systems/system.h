/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The systems that the paper cites, as parts of its study. Each system is one constant PaperSystem: the methods that are
   scored, the study that measures its claims, the rules that judge them, and its figure. To add a system NAME:

   1. Write NAME_study.c, NAME_claims.c and their header NAME_study.h in this folder, and define there

        static const CsvLayout table = CSV_LAYOUT("system_NAME", columns, NameRow, .min_rows = 1, .max_rows = 5000);
        static const SystemPart parts[] = {
            {"launches-stack", .weight = 20, .quick_weight = 0.3, .index = 1, .write = write_launches}, ..., {0}};

        const PaperSystem system_NAME = {.name = "NAME",
                                         .methods = SYSTEM_METHODS("NAME", "NAME:net=off"),
                                         .table = &table,
                                         .parts = parts,
                                         .claim = claim,
                                         .plot = plot_NAME};

      A part writes rows of the table with piece_tables_print(lines, &table, -1, &row, error) (study/piece_tables.h). It is kept
      when it is done, and done once: a study that was cut off continues with the next part. So a part should take some
      seconds. The whole study of one system takes at most 90 s on two idle cores, the quick one 2 s; the quick one measures
      everything that claims need, with less. A part may use all threads (common/parallel.h); times are measured on one
      (study/meter.h), by parts that say so (timed).
   2. Write figures/plot_NAME.c, which draws folder/system_NAME.csv (figures/plot_parts.h). It becomes
      figures/system-NAME.png and .svg.
   3. Add a line to SYSTEMS below; the room of its training to those that paper may include from (src/layers.txt), if the
      study trains; and to tests: tests/paper/figures/system_NAME.csv with all that the figure can show, its names to
      `tables` and `figures` in tests/paper/test_plots.c, tests/paper/test_NAME_study.c, the table's layout to the end of
      `layouts` in tests/fuzz/fuzz_csv.c (declared in NAME_study.h then).

   The rest follows from the list: scores (system_scores.h), the table of claims (system_claims.h), strips
   (system_strips.h) and the report. */
#pragma once
#include "paper/systems/system_claims.h"

#include "common/progress.h"
#include "sketch/plot_page.h"

#include <stdint.h>
#include <stdio.h>

/* What the parts of a study share. */
typedef struct SystemStudy {
    const char *scenes; /* folder of single.yaml, stack.yaml, pyramid.yaml, pyramid_settled.yaml */
    bool quick;
    uint64_t seed;
} SystemStudy;

typedef struct SystemPart {
    const char *name;            /* of the system's parts; NULL ends the list */
    double weight, quick_weight; /* about the seconds on two cores */
    int index;                   /* handed to write */
    /* Writes rows of the system's table. False with error set; ERROR_INTERRUPTED if progress_report() stops it. */
    bool (*write)(const SystemStudy *study, int index, FILE *lines, const Progress *progress, Error *error);
    bool timed; /* its rows have times */
} SystemPart;

typedef struct PaperSystem {
    const char *name; /* "sain": in tables, and of files */
    const char *const
        *methods;           /* to score, as on the command line, ended by NULL: first the system as it ships, which the
                                   strips show, then its ablations. In a scene without their network they have no row */
    const CsvLayout *table; /* of system_NAME.csv */
    const SystemPart *parts;
    /* Reads the system's table from claims->folder and states each claim by claim_state(). False with error set. */
    bool (*claim)(const Claims *claims, Error *error);
    bool (*plot)(const char *folder, PlotPage *page, Error *error);
} PaperSystem;

#define SYSTEM_METHODS(...) ((const char *const[]){__VA_ARGS__, NULL})

/* SYSTEM(x) is system_x of this folder. In the order of tables and of the report. */
#define SYSTEMS(SYSTEM) SYSTEM(sain) SYSTEM(hybrid) SYSTEM(gns) SYSTEM(subspace)

#define SYSTEM_DECLARED(name) extern const PaperSystem system_##name;
SYSTEMS(SYSTEM_DECLARED)
#undef SYSTEM_DECLARED

/* The list; ends with NULL. */
extern const PaperSystem *const paper_systems[];

/* A part of a system's study as a part of the whole (paper/study/paper_plan.h). context: a SystemWork. */
typedef struct SystemWork {
    const SystemStudy *study;
    const SystemPart *part;
} SystemWork;
bool system_part_write(void *context, FILE *lines, const Progress *progress, Error *error);
