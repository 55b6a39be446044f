/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of the stability figures. */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "figures/plot.h"
#include "figures/sketch.h"
#include "methods/methods.h"
#include "runs/verdict.h"
#include "scenes/scenes.h"
#include "studies/contenders.h"
#include "studies/stability.h"
#include "studies/study_page.h"

#include <stdio.h>

/* How verdicts are drawn: a tile with a symbol. Worse is darker, readable in grey and for the colour-blind; holding is
   light and round, failing dark and angular, readable in black and white. */

typedef struct VerdictLook {
    const char *name;
    uint32_t fill; /* of the tile; NO_COLOUR: none */
    uint32_t ink;  /* of the symbol */
    int symbol;    /* of a PlotStyle; VERDICT_STROKE: a stroke across; VERDICT_BARE: none */
    bool open;
    double size; /* of the symbol, relative */
} VerdictLook;

enum { VERDICT_STROKE = PLOT_SYMBOLS, VERDICT_BARE };

extern const VerdictLook verdict_looks[VERDICT_LOOKS];

/* mm: the size of tiles. */
typedef struct TileSize {
    double width, height;
    double symbol_room; /* what a symbol may take; 0: its tile */
} TileSize;

typedef struct Tile {
    Point at; /* centre */
    int look;
    bool bare;    /* without its symbol */
    bool hatched; /* not as the reference */
    int fell;     /* the number of boxes instead of the symbol; 0: the symbol */
} Tile;

/* The tile's symbol alone, `width` mm wide. */
void verdict_draw_symbol(Sketch *sketch, const Tile *tile, double width);

/* The grid of a legend's items, row by row; rows are LEGEND_ROW apart. */
typedef struct LegendPlace {
    double left, top, width; /* mm: left edge and centre height of the first item; column width */
    int columns;
} LegendPlace;

/* Strokes over a part in which a method does something else than the reference: stands, falls, collapses, or is not
   sound. Of what is undecided, or has no verdict, nothing is known. */
void verdict_hatch(Sketch *sketch, Point low, Point high, uint32_t ink);
bool verdict_differs(int look, int reference);

#define HATCHED_WORDS "not as the reference"

/* Draws tiles and names of the used looks. Returns their number. */
int verdict_draw_legend(Sketch *sketch, const bool used[VERDICT_LOOKS], const LegendPlace *place);

/* What a figure leaves out, with the reason: named at its foot and in its caption. Zero-initialise. */

enum { LEFT_OUT_SIZE = 8192 };

typedef struct LeftOut {
    int count;
    char lines[4][LEFT_OUT_SIZE];
} LeftOut;

/* Methods of one reason follow each other; at most three reasons, "Left out, as not applicable: ", */
void left_out_add(LeftOut *left_out, const char *why, const char *method, const char *setting);

/* and then where the reference did not converge. */
void left_out_add_unconverged(LeftOut *left_out, const CsvTable *unconverged, const char *study);

#define NOTE_ROW 3.4 /* mm */
#define NOTE_POINTS 6.5

/* From `left` to the edge of the page, in rows that are NOTE_ROW high; and the number of these rows on `width` mm. */
void left_out_draw(const LeftOut *left_out, PlotPage *page, double left);
int left_out_rows(const LeftOut *left_out, double width);

/* Which parts of a study's range hold. */

/* From the end where most methods hold to the end where most fail. */
typedef struct BorderRange {
    double easy, hard;
    bool logarithmic, whole;
} BorderRange;

/* A part of a range, in shares, that holds or fails. */
typedef struct BorderSpan {
    double from, to;
    bool holds;
    int look; /* of what fails */
} BorderSpan;

/* What a method does over the range of a study. */
typedef struct BorderCell {
    const BorderRow *row; /* of its first border; NULL: the method is not in the study */
    int count;
    BorderSpan spans[2 * BORDERS_MAX]; /* from easy to hard; what is between them is undecided */
    double held;                       /* their share that holds */
} BorderCell;

/* The study of the row, of `own` or, if it is NULL, of the table of studies; NULL: another program's. */
const StabilityStudy *border_study(const StabilityOwn *own, const BorderRow *row);

/* The range of the study of row `first`: as it is scanned or, of another program's, that of its borders. */
BorderRange border_range(const CsvTable *table, int first, const StabilityStudy *study);

/* Where a value is in the range: 0 at the easy end, 1 at the hard one. */
double border_range_share(const BorderRange *range, double value);

BorderCell border_cell(const CsvTable *table, const BorderRow *study, const BorderRow *method,
                       const BorderRange *range);

/* The method holds over the whole range. */
bool border_holds_throughout(const BorderCell *cell);

/* The borders figure: how far each method holds in each study. */

enum { BORDERS_MAX_METHODS = 24, BORDERS_MAX_STUDIES = 32 };

/* Writes the figure and its caption: a row for each study, struck ones last, and a column for each method that applies
   to one of them; the caption names the others. Of up to three studies the methods are rows. A cell is the range of the
   study, with the parts that hold and those that fail, each in the colour of its verdict. Columns and rows are sorted
   by what holds, the reference first. The foot names where the reference did not converge, by unconverged.csv.
   ERROR_INPUT, with path:line:column: more than BORDERS_MAX_METHODS methods or BORDERS_MAX_STUDIES studies. */
bool stability_borders_write(const CsvTable *table, const CsvTable *unconverged, const StabilityOwn *own,
                             PlotPage *page, Error *error);

/* stability.html: borders and maps as tables. */

/* A study or map, and the live page of its scene. */
typedef struct StudyPlace {
    const char *name;
    const SceneSetting *fixed; /* set beside what varies; NULL: nothing */
    char path[STABILITY_PATH_SIZE];
    StudyPage page;
} StudyPlace;

/* Writes folder/stability.html of stability.csv and maps.csv there, whose studies and maps are among the places. */
bool stability_html_write(const char *folder, const StudyPlace *places, Error *error);

/* Writes the run's row of the table "unconverged", if a step of the converged runs beside it did not converge; fills it
   in. */
bool unconverged_print(FILE *results, int section, MapCell *row, const ConvergedRun *beside, Error *error);

/* One stability map: the verdict of every method in every cell of a grid. */

typedef struct StabilityGrid {
    const StabilityMap *map;
    const char *scenes; /* the folder that contains stability/ */
    const ContenderList *methods;
    bool quick; /* the smaller grid */
} StabilityGrid;

/* What the pieces of a map have in common. */
typedef struct GridContext {
    const StabilityGrid *grid;
    Scene *typical; /* with default parameters */
    int x_count, y_count;
    double x[BORDER_POINTS_MAX], y[BORDER_POINTS_MAX];
    int method_count;
    const Contender **methods; /* [method_count] that apply to the scene */
} GridContext;

/* The number of cells. */
int stability_grid_cells(const StabilityMap *map, bool quick);

/* stability_grid_end() also after a failure. */
bool stability_grid_begin(GridContext *context, const StabilityGrid *grid, Error *error);
void stability_grid_end(GridContext *context);

/* Judges the cells first .. end - 1, row by row from the least y, and writes their rows of the tables "maps" and
   "unconverged", with a section for each of grid->methods (studies/contenders.h). Omits methods that do not apply to
   the scene, methods that set their own number of sweeps if the map scans it, and the reference, by which runs are
   judged, unless the scene is struck. */
bool stability_grid_write(const GridContext *context, int first, int end, FILE *results, const Progress *progress,
                          Error *error);

/* One stability study: the borders of every method along a parameter. */

typedef struct StabilityScan {
    const StabilityStudy *study;
    const char *scenes; /* the folder that contains stability/ */
    const ContenderList *methods;
} StabilityScan;

/* What the pieces of a scan have in common. */
typedef struct ScanContext {
    const StabilityScan *scan;
    Scene *typical; /* with default parameters */
    ConvergedRuns converged;
} ScanContext;

/* stability_scan_end() also after a failure. */
bool stability_scan_begin(ScanContext *context, const StabilityScan *scan, Error *error);
void stability_scan_end(ScanContext *context);

/* Does the methods first .. end - 1 and writes their rows (studies/piece_tables.h) of the tables "stability",
   "refusals", "fallbacks" (every unshifted run of a method that may fall back), "rest" (every unshifted run, if
   study.rests) and "unconverged" (every unshifted run whose converged runs did not converge throughout), ordered by
   method. Omits methods that set their own number of sweeps if the study scans it. */
bool stability_scan_write(ScanContext *context, int first, int end, FILE *results, const Progress *progress,
                          Error *error);

/* The verdict on one run of a study; seed: stability_shift(). False with error set if the method does not apply to the
   scene or memory is short. *beside: as of stability_judge(). */
bool stability_scan_run(const StabilityScan *scan, const Method *method, double value, int seed,
                        ConvergedRuns *converged, VerdictReading *reading, const ConvergedRun **beside, Error *error);
