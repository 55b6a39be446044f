/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of the chart study and of its drawings. */
#pragma once
#include "base/base.h"
#include "base/csv.h"
#include "base/machine.h"
#include "figures/sketch.h"
#include "methods/methods.h"
#include "scenes/scenes.h"
#include "studies/chart.h"

#include <stdio.h>

/* The scores of the methods on the launches of a scene. Those of one launch are stored as bytes of this machine: the number of
   methods, the frozen steps that were left out, where each method's part ends, then the parts; so one method's is found at once. */

/* A method on one launch. Zero-initialise. */
typedef struct LaunchScores {
    StepScores steps[PROTOCOLS][PHASES];
    RunMeasures measures;
    int unconverged; /* steps in closed loop, as in Rollout */
} LaunchScores;

void launch_scores_free(LaunchScores *scores);

/* Writes those of all methods, scores[count]. unconverged: frozen steps, as in SnapshotList. run_unconverged: as in RunLog, of the
   converged run. */
void launch_scores_write(FILE *results, const LaunchScores *scores, int count, int unconverged, int run_unconverged);

/* What is stored of a launch. */
typedef struct StoredScores {
    const char *path; /* for messages */
    const char *bytes;
    size_t size;
    int count;               /* methods */
    int64_t unconverged;     /* frozen steps */
    int64_t run_unconverged; /* steps of the converged run */
} StoredScores;

/* Looks at stored results with so many methods. ERROR_INPUT if they are damaged. The bytes must outlive *stored. */
bool stored_scores_open(StoredScores *stored, const char *path, const char *bytes, size_t size, int count,
                        Error *error);

typedef struct PhaseScores {
    int count;
    double *error, *share; /* [count], as in StepScores */
    CriteriaSum criteria;
    size_t error_capacity, share_capacity;
} PhaseScores;

/* A method on several launches. Zero-initialise. */
typedef struct MethodScores {
    PhaseScores steps[PROTOCOLS][PHASES];
    double worst[PHASES];  /* m/s: largest mean error of a launch in closed loop; NaN without a scored step */
    RunMeasures *measures; /* [launches] */
    int launches;
    int64_t unconverged; /* steps in closed loop, as in Rollout */
    size_t measure_capacity;
} MethodScores;

/* Adds a launch. ERROR_INPUT if its part is damaged. */
bool method_scores_add(MethodScores *scores, const StoredScores *stored, int method, Error *error);
void method_scores_free(MethodScores *scores);

/* Rows of chart.csv from the results of a scene's launches. */

/* A row with names but without results. The names must outlive the row. */
ChartRow scene_row(const char *scene, int launches, const Contender *contender, int protocol, int phase);

/* Sets mean, quantiles, share and criteria over all steps of the row's phase; sorts the scores. */
void scene_row_errors(ChartRow *row, const PhaseScores *scores);

/* Largest penetration and means of the other measures over measures[count], one per launch. */
void scene_row_measures(ChartRow *row, const RunMeasures *measures, int count);

/* cpu: that it was measured on; must outlive the row. */
void scene_row_cost(ChartRow *row, const StepCost *cost, const char *cpu);

/* The error of a method over its time, from runs with several settings. */

typedef struct CurvePoint {
    double us, error; /* microseconds; m/s; both greater than 0 */
} CurvePoint;

/* Where a time lies on a curve: before its first point, between its points, or beyond the last. */
typedef enum CurveReach { CURVE_BEFORE, CURVE_WITHIN, CURVE_BEYOND } CurveReach;

/* Sorts the points and keeps those that no other beats in both: rising times, falling errors. Returns their number. */
int error_curve_front(CurvePoint *points, int count);

/* The error of such a front at a time: a straight line in log error over log time between neighbours. NaN before
   the first point, as no setting is that quick. Beyond the last point it is the last point's error. count >= 1. */
double error_curve_at(const CurvePoint *front, int count, double us, CurveReach *reach);

/* The families of a chart, each with its curve of error over time in one scene.

   A family is a method with the words of its setting ("engine:warm=off"); its settings differ in numbers. The rivals of a
   method are the families of other methods that learn nothing; a learned method's silenced twin is no rival of it. The
   best rival at a time is the one with the least error in that time. Closed loop only. Baselines, the reference and rows
   without time or error are left out; a setting that lost the scene is on no curve. Errors below REFERENCE_TOLERANCE
   count as that. */

typedef enum CurveStatistic { CURVE_MEAN, CURVE_MEDIAN, CURVE_P95 } CurveStatistic;

enum { CURVE_STATISTICS = CURVE_P95 + 1 };

typedef struct CurveFamily {
    char name[CHART_FAMILY_SIZE], method[CHART_NAME_SIZE];
    const MethodDescription *description; /* NULL: an unknown method */
} CurveFamily;

typedef struct RivalCurves {
    int family_count;
    CurveFamily *families; /* [family_count], in the order of their first rows; grows from scene to scene */
    int count;             /* rows of the scene that count, */
    const ChartRow **rows; /* [count] */
    int *family;           /* [count] index into families */
    bool *lost;            /* [count] */
    CurvePoint *points;    /* scratch, [count] */
} RivalCurves;

typedef struct BestRival {
    int family;       /* -1: no rival has a setting as quick */
    double error;     /* m/s; NAN without a rival */
    CurveReach reach; /* CURVE_BEFORE without a rival */
} BestRival;

/* Every method's error next to the error that its best rival has in the same time: equal_time.csv for
   each setting at the time that it takes, equal_time_methods.csv for each method at one time for all in a scene. */

/* m/s: smaller errors count as equal. */
#define PARETO_RESOLUTION 1e-4

/* Whose error is below PARETO_RESOLUTION. Where both are, their ratio says nothing about what a run looks like. */
typedef enum ErrorsBelow { BELOW_NONE, BELOW_METHOD, BELOW_RIVAL, BELOW_BOTH } ErrorsBelow;

typedef struct EqualTimeRow {
    const char *scene, *method, *setting;
    Phase phase; /* PHASE_IMPACT or PHASE_AFTER */
    CurveStatistic statistic;
    int launches;
    double us_solver, error; /* microseconds, m/s; over all scored steps of all launches */
    const char *rival;       /* family of the best rival; "": none */
    CurveReach reach;        /* where the time lies on the rival's curve; before: there is no rival */
    double rival_error;      /* m/s, at that time */
    double ratio;            /* error / rival_error; NaN without a rival, or if the method lost the scene */
    ErrorsBelow below;
    double time_momentum_20; /* us_solver / that of momentum:k=20; NaN if it was not run */
    double error_scene_net;  /* error / that of scene-net in this scene; likewise */
    double time_scene_net;   /* us_solver / that of scene-net in this scene; likewise */
} EqualTimeRow;

/* Mean errors at the impact, in the time of momentum with 100 sweeps, or with 50 or 20 in a chart without that. */
typedef struct EqualMethodRow {
    const char *scene, *method; /* method: its family */
    double us_solver;           /* the time, microseconds */
    CurveReach reach;  /* where the time lies on the method's curve; before: it takes longer, or lost the scene */
    double error;      /* m/s, at that time; NaN before */
    const char *rival; /* "": none */
    double rival_error, ratio;
    ErrorsBelow below;
    int family; /* index into families */
} EqualMethodRow;

extern const CsvLayout equal_time_layout, equal_methods_layout;

typedef struct EqualTime {
    int count, method_count;
    EqualTimeRow *rows;      /* [count]; texts point into the chart's rows and into curves */
    EqualMethodRow *methods; /* [method_count], scene by scene; none for scenes without such a run of momentum */
    const char *time;        /* the setting of momentum whose time all methods have: "k=100", "k=50" or "k=20" */
    RivalCurves curves;
} EqualTime;

/* The tables of a chart's rows, which must outlive them; the rows of a scene must follow each other. False with error set
   if out of memory. */
bool equal_time_make(EqualTime *table, const ChartRow *rows, int count, Error *error);
void equal_time_free(EqualTime *table);

/* A piece of the speed-accuracy study: a launch of a scene with all methods, which share its converged run and its frozen
   steps. */

/* Scores all contenders of the study on the launch, in parallel, and writes the scores. Called from
   several threads at once, it uses one thread each. */
bool launch_piece_write(SceneStudy *study, int launch, FILE *results, const Progress *progress, Error *error);

/* A piece of the speed-accuracy study: the times of all methods in a scene, measured in turns by one process. */

/* Of a method. */
typedef struct MethodTimes {
    StepCost costs[PROTOCOLS][PHASES];
} MethodTimes;

/* Measures the contenders of the study on some of its launches, and writes their times. */
bool scene_times_write(const SceneStudy *study, FILE *results, const Progress *progress, Error *error);

/* The stored times of the contenders, to be freed. ERROR_INPUT if they are damaged. path: for messages. */
MethodTimes *scene_times_read(const SceneStudy *study, const char *path, const char *bytes, size_t size, Error *error);

/* The data of a chart of one scene: marks joined to lines, in two panels. */

enum {
    CHART_MAX_LINES = 32,
    CHART_TEXT_SIZE = 128,
    CHART_PANELS = 2,
    CHART_LOUD = 6 /* lines in colour, at most */
};

/* How a line is drawn. */
typedef enum ChartRank {
    CHART_GREY,   /* thin and grey, its name in grey */
    CHART_HIDDEN, /* not: the silenced twin of a grey method, unless it is on the front */
    CHART_COLOURED
} ChartRank;

/* A method with its non-numeric settings ("engine:warm=off"). */
typedef struct ChartLine {
    char key[CHART_FAMILY_SIZE];          /* as in the table; identifies the line */
    char name[CHART_TEXT_SIZE];           /* plain, truncated */
    const char *method;                   /* as in the table, which outlives it */
    const MethodDescription *description; /* NULL: an unknown method */
    ChartRank rank;
    RunColours colours;
    bool asked;                        /* named by the reader */
    int marks[CHART_PANELS], left_out; /* numbers of marks drawn and left out */
    int varying;                       /* number of marks drawn whose time varies (ChartRow.us_varies) */
    int lost;                          /* number of marks left out because the method lost the scene (chart_gather) */
    bool competes;                     /* or unknown; baselines and the reference do not */
    int beyond;                        /* number of marks left out because they are far from the coloured ones, and */
    double beyond_us[2], beyond_error[2]; /* their ranges, from least to most */
} ChartLine;

typedef struct ChartMark {
    int line;
    double us, us_q1,
        us_q3;    /* solver time per step: median and quartiles, microseconds; of a program what it reports */
    double error; /* mean velocity error, m/s; at least PARETO_RESOLUTION */
    bool floored; /* it was less */
    bool varies;  /* ChartRow.us_varies */
    bool on_front;
    bool beaten;  /* another setting of its line beats it in both time and error */
    bool lost;    /* the method lost the scene; only of lines that are asked for */
    bool shipped; /* the setting that the method's description calls shipped */
    char
        label[CHART_TEXT_SIZE]; /* "k=20"; of several numeric settings those in which marks with the same keys differ */
    const char *method, *setting; /* as in the table, which outlives them */
} ChartMark;

typedef struct ChartPanel {
    int count;
    ChartMark *marks; /* [count], sorted by line, then by time; marks that are not drawn are not among them */
} ChartPanel;

typedef struct Chart {
    int line_count, launches;
    int floored; /* number of marks drawn at PARETO_RESOLUTION */
    ChartLine lines[CHART_MAX_LINES];
    ChartPanel panels[CHART_PANELS]; /* impact frames and the frames after; closed loop */
    CurvePoint *front
        [CHART_PANELS]; /* [front_count] the Pareto front by rising time, of all methods that compete and the reference */
    int front_count[CHART_PANELS];
    double us_least, us_most, error_least, error_most; /* ranges of all marks */
    char times[CHART_TIMES_SIZE];                      /* chart_times_note(), of the whole table; plain */
} Chart;

/* Gathers a scene's rows. Lines keep their order in the table. Texts are restricted to
   letters, digits, spaces and -_.,:=+/()*[]; other characters become '?'.
   Left out and counted: rows without time or error, and rows of a method that let the boxes drift half a metre
   before the bomb came, as they were scored on another scene; of a line that `highlight` names these are marks, too.
   Errors below PARETO_RESOLUTION are drawn there. The axes show the coloured lines: other marks more than a decade away from
   them are left out, and counted in their line. highlight: names of lines or methods, separated by commas; NULL: none; others
   are ignored. False with error set if nothing remains, or for more than CHART_MAX_LINES lines. */
bool chart_gather(Chart *chart, const CsvTable *table, const char *scene, const char *path, const char *highlight,
                  Error *error);
/* Colours the lines of a gathered chart again, with what was chosen. */
bool chart_colour(Chart *chart, const ColourChoices *choices, Error *error);
void chart_free(Chart *chart);

/* Whether a program of others takes its steps, by its own clock. */
bool chart_is_program(const ChartLine *line);

/* The word in its setting that switches its learned part off, "net=off"; NULL: it has none. */
const char *chart_twin_word(const ChartLine *line);

/* Whether each number in its setting is what the key's help calls the default. */
bool chart_mark_is_default(const ChartMark *mark);

/* Sets the rank of each line, given all its marks. At most CHART_LOUD are coloured: what the reader asks for (`highlight`,
   programs of others), the engine, interior, the strongest rival that learns nothing, and scene-net; then the silenced twins of
   these. The strongest rival is the one with most corners in the front of such methods, both panels together. False with error
   set if out of memory. */
bool chart_rank(Chart *chart, const char *highlight, const char *path, Error *error);

/* What a picture calls a line: its key, plain and truncated, without the folders of a network; of a program its setting
   `name`. */
void chart_line_name(const char *key, char name[CHART_TEXT_SIZE]);

/* Writes what the picture shows and what it leaves out. named[line]: whether the picture had room for its name. */
void chart_caption(const Chart *chart, const char *title, const bool *named, char *text, size_t size);

/* Replaces characters that names do not have (csv_plain_length), or that the font lacks, by '?'. */
void chart_make_plain(char *text);

/* Copies a text, made plain and truncated to fit. */
void chart_plain(char out[CHART_TEXT_SIZE], const char *text);

/* A panel of a chart in progress. */

#define CHART_NAME_POINTS 8.0
#define CHART_SMALL_POINTS 6.5
#define CHART_RING_RADIUS 1.9  /* mm: around the engine as shipped */
#define CHART_GREY_RADIUS 0.42 /* mm: of grey marks */
#define CHART_GREY_INK 0x666E78u

typedef struct ChartDrawing {
    const Chart *chart;
    const ChartPanel *panel;
    const PlotPanel *plot;
    Sketch *sketch;
    LabelField field;                       /* its first two segments are the lines through the engine as shipped */
    int marks;                              /* the field's boxes of marks; those of labels follow */
    bool *named;                            /* [line] */
    const ChartMark *told[CHART_MAX_LINES]; /* in this panel: the mark that a line's name tells of, or NULL */
} ChartDrawing;

static inline const ChartLine *chart_line_of(const ChartDrawing *drawing, const ChartMark *mark) {
    return &drawing->chart->lines[mark->line];
}

static inline bool chart_is_coloured(const ChartDrawing *drawing, const ChartMark *mark) {
    return chart_line_of(drawing, mark)->rank == CHART_COLOURED;
}

static inline Point chart_place(const ChartDrawing *drawing, const ChartMark *mark) {
    return plot_place(drawing->plot, mark->us, mark->error);
}

PlotStyle chart_line_style(const ChartLine *line);

/* The setting as shipped of the method that has one; NULL: not in the panel. */
const ChartMark *chart_find_shipped(const ChartPanel *panel);

/* Begins the field with the lines through the engine as shipped. */
void chart_find_cross(ChartDrawing *drawing);

/* Draws the names of all lines for which there is room beside marks and curves, settings of coloured ones, and the lines
   through the engine as shipped. */
void chart_draw_names(ChartDrawing *drawing, int panel);

/* A drawn chart. */
typedef struct ChartPicture {
    const Chart *chart;
    ChartSize size;
    double width, height; /* mm */
    PlotPanel panels[CHART_PANELS];
    bool named[CHART_MAX_LINES]; /* in a panel */
    Sketch sketch;
    char caption[PLOT_CAPTION_SIZE];
} ChartPicture;

/* Free with chart_picture_free(). The chart must outlive it. False with error set if out of memory. */
bool chart_picture_make(ChartPicture *picture, const Chart *chart, const char *scene, const ChartLook *look,
                        Error *error);
void chart_picture_free(ChartPicture *picture);

/* Where a mark is drawn: shares of the page's width and height, from its upper left corner. */
void chart_mark_place(const ChartPicture *picture, int panel, const ChartMark *mark, double *left, double *top);

extern const char *const chart_panel_titles[CHART_PANELS];

/* What the words of a figure mean, for its caption: each method by what frames call it, each key of a setting by its help,
   "nncg: conjugate gradients over sweeps". Zero-initialise. */

enum { WORDS_MAX = 48, WORD_SIZE = 160 };

typedef struct WordList {
    int count;
    char items[WORDS_MAX][WORD_SIZE];
} WordList;

/* Add what is not there yet; unknown methods and keys have no meaning. The name may have settings, which are ignored. */
void words_add(WordList *words, const char *word, const char *meaning);
void words_add_method(WordList *words, const char *name);
void words_add_settings(WordList *words, const char *name, const char *setting);

/* Ends a caption of `size` bytes with all of them, as far as there is room, and a line end. */
void words_join(const WordList *words, char *caption, size_t size);

/* The parts of pages of studies. */

void study_page_begin(FILE *out, const char *title, const char *style);

/* Begins a part of the page with its heading, without the heading's end. */
void study_page_section(FILE *out, const char *name);

/* A region that can be scrolled, also by the keyboard. */
void study_page_region(FILE *out, const char *style, const char *label, const char *of);

/* How many rows have no page; page: at this place in each row of the table. */
void study_page_left_out(FILE *out, const CsvTable *table, size_t page, size_t row_size, const char *what);

/* failed: set by `put`, with the error. */
bool study_page_write(const char *path, void (*put)(FILE *out, const void *html), const void *html, const bool *failed,
                      Error *error);
