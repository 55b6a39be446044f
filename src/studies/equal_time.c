/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Errors at equal time: the curves of rivals, and the tables in which each method stands beside its best rival. */
#include "base/base.h"
#include "base/csv.h"
#include "methods/methods.h"
#include "methods/reference.h"
#include "scenes/scenes.h"
#include "studies/chart_table.h"
#include "studies/equal_time.h"
#include "studies/statistics.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Takes the rows of one scene; they must outlive their use. */
static void take_scene(RivalCurves *curves, const ChartRow *rows, int count) {
    curves->count = 0;
    for (int i = 0; i < count; i++) {
        const ChartRow *row = &rows[i];
        const MethodDescription *method = method_describe(row->method);
        char name[CHART_FAMILY_SIZE];
        int k = 0;
        if (row->protocol != PROTOCOL_CLOSED || row->phase == PHASE_REST || !(row->us_solver > 0) ||
            isnan(row->error_mean) || (method != NULL && method->role != METHOD_COMPETES))
            continue;
        chart_row_family(row, name);
        while (k < curves->family_count && strcmp(curves->families[k].name, name) != 0) k++;
        if (k == curves->family_count) {
            CurveFamily *family = &curves->families[curves->family_count++];
            strcpy(family->name, name);
            strcpy(family->method, row->method);
            family->description = method;
        }
        curves->rows[curves->count] = row;
        curves->family[curves->count] = k;
        curves->lost[curves->count++] = chart_row_lost(rows, count, row);
    }
}

static double curve_error(const ChartRow *row, CurveStatistic statistic) {
    const double errors[] = {row->error_mean, row->error_median, row->error_p95};
    return errors[statistic];
}

/* An error that has a logarithm. */
static double positive(double error) { return fmax(error, REFERENCE_TOLERANCE); }

/* The error of a family at a time, as error_curve_at(); NAN and CURVE_BEFORE too for a family without a curve. */
static double error_at(const RivalCurves *curves, int family, Phase phase, CurveStatistic statistic, double us,
                       CurveReach *reach) {
    int count = 0;
    for (int i = 0; i < curves->count; i++) {
        const ChartRow *row = curves->rows[i];
        if (curves->family[i] != family || curves->lost[i] || row->phase != phase) continue;
        curves->points[count++] = (CurvePoint){row->us_solver, positive(curve_error(row, statistic))};
    }
    *reach = CURVE_BEFORE;
    return count == 0 ? NAN : error_curve_at(curves->points, error_curve_front(curves->points, count), us, reach);
}

static BestRival find_best(const RivalCurves *curves, int family, Phase phase, CurveStatistic statistic, double us) {
    BestRival best = {-1, NAN, CURVE_BEFORE};
    for (int i = 0; i < curves->family_count; i++) {
        const CurveFamily *other = &curves->families[i];
        CurveReach reach;
        if (strcmp(curves->families[family].method, other->method) == 0) continue;
        if (other->description != NULL && other->description->twin != NULL) continue; /* it learned */
        const double error = error_at(curves, i, phase, statistic, us, &reach);
        if (reach != CURVE_BEFORE && !(best.error <= error)) best = (BestRival){i, error, reach};
    }
    return best;
}

static const char *const phase_words[] = {"impact", "after", NULL};
static const char *const statistic_words[] = {"mean", "median", "p95", NULL};
static const char *const below_words[] = {"none", "method", "rival", "both", NULL};
static const char *const reach_words[] = {"before", "within", "beyond", NULL};

#define NUMBER(Row, member) CSV_MEMBER(Row, member, CSV_OPTIONAL, .maximum = INFINITY)
#define TEXT(Row, member, size, is_key) CSV_MEMBER(Row, member, CSV_TEXT, .maximum = (size)-1, .key = (is_key))
#define WORD(Row, member, list, is_key) CSV_MEMBER(Row, member, CSV_WORD, .words = (list), .key = (is_key))

static const CsvColumn columns[] = {
    TEXT(EqualTimeRow, scene, CHART_NAME_SIZE, true),
    TEXT(EqualTimeRow, method, CHART_NAME_SIZE, true),
    TEXT(EqualTimeRow, setting, CHART_SETTING_SIZE, true),
    WORD(EqualTimeRow, phase, phase_words, true),
    WORD(EqualTimeRow, statistic, statistic_words, true),
    CSV_MEMBER(EqualTimeRow, launches, CSV_INTEGER, .maximum = INT_MAX),
    NUMBER(EqualTimeRow, us_solver),
    NUMBER(EqualTimeRow, error),
    TEXT(EqualTimeRow, rival, CHART_FAMILY_SIZE, false),
    WORD(EqualTimeRow, reach, reach_words, false),
    NUMBER(EqualTimeRow, rival_error),
    NUMBER(EqualTimeRow, ratio),
    WORD(EqualTimeRow, below, below_words, false),
    NUMBER(EqualTimeRow, time_momentum_20),
    NUMBER(EqualTimeRow, error_scene_net),
    NUMBER(EqualTimeRow, time_scene_net),
};

static const CsvColumn method_columns[] = {
    TEXT(EqualMethodRow, scene, CHART_NAME_SIZE, true),
    TEXT(EqualMethodRow, method, CHART_FAMILY_SIZE, true),
    NUMBER(EqualMethodRow, us_solver),
    WORD(EqualMethodRow, reach, reach_words, false),
    NUMBER(EqualMethodRow, error),
    TEXT(EqualMethodRow, rival, CHART_FAMILY_SIZE, false),
    NUMBER(EqualMethodRow, rival_error),
    NUMBER(EqualMethodRow, ratio),
    WORD(EqualMethodRow, below, below_words, false),
};

const CsvLayout equal_time_layout = CSV_LAYOUT("equal_time", columns, EqualTimeRow, .min_rows = 0,
                                               .max_rows = CURVE_STATISTICS * CHART_MAX_ROWS, .header = CSV_EXACT);
const CsvLayout equal_methods_layout = CSV_LAYOUT("equal_time_methods", method_columns, EqualMethodRow, .min_rows = 0,
                                                  .max_rows = CHART_MAX_ROWS, .header = CSV_EXACT);

/* Comparisons with NaN are false. */
static ErrorsBelow which_below(double error, double rival_error, double resolution) {
    const bool method = error < resolution, rival = rival_error < resolution;
    return method && rival ? BELOW_BOTH : method ? BELOW_METHOD : rival ? BELOW_RIVAL : BELOW_NONE;
}

static const char *name_rival(const RivalCurves *curves, const BestRival *rival) {
    return rival->family < 0 ? "" : curves->families[rival->family].name;
}

/* The row of a method with a setting in a phase of the scene, or NULL. */
static const ChartRow *find_run(const RivalCurves *curves, Phase phase, const char *method, const char *setting) {
    for (int i = 0; i < curves->count; i++) {
        const ChartRow *row = curves->rows[i];
        if (row->phase == phase && strcmp(row->method, method) == 0 && strcmp(row->setting, setting) == 0) return row;
    }
    return NULL;
}

static EqualTimeRow compare_setting(const RivalCurves *curves, int i, CurveStatistic statistic) {
    const ChartRow *row = curves->rows[i];
    const double error = curve_error(row, statistic);
    const BestRival rival = find_best(curves, curves->family[i], row->phase, statistic, row->us_solver);
    const ChartRow *momentum = find_run(curves, row->phase, "momentum", "k=20");
    const ChartRow *net = find_run(curves, row->phase, "scene-net", "");
    return (EqualTimeRow){.scene = row->scene,
                          .method = row->method,
                          .setting = row->setting,
                          .phase = row->phase,
                          .statistic = statistic,
                          .launches = row->launches,
                          .us_solver = row->us_solver,
                          .error = error,
                          .rival = name_rival(curves, &rival),
                          .reach = rival.reach,
                          .rival_error = rival.error,
                          .ratio = curves->lost[i] ? NAN : positive(error) / rival.error,
                          .below = which_below(error, rival.error, chart_row_resolution(row)),
                          .time_momentum_20 = momentum == NULL ? NAN : row->us_solver / momentum->us_solver,
                          .error_scene_net =
                              net == NULL ? NAN : positive(error) / positive(curve_error(net, statistic)),
                          .time_scene_net = net == NULL ? NAN : row->us_solver / net->us_solver};
}

/* The rows of a scene, and those of its methods in the time of momentum. */
static void compare_scene(EqualTime *table, const ChartRow *rows, int count) {
    RivalCurves *curves = &table->curves;
    take_scene(curves, rows, count);
    for (int i = 0; i < curves->count; i++)
        for (int statistic = 0; statistic < CURVE_STATISTICS; statistic++)
            table->rows[table->count++] = compare_setting(curves, i, (CurveStatistic)statistic);
    const ChartRow *time = find_run(curves, PHASE_IMPACT, "momentum", table->time);
    for (int family = 0; time != NULL && family < curves->family_count; family++) {
        bool ran = false;
        for (int i = 0; i < curves->count; i++)
            ran |= curves->family[i] == family && curves->rows[i]->phase == PHASE_IMPACT;
        if (!ran) continue;
        EqualMethodRow *row = &table->methods[table->method_count++];
        *row = (EqualMethodRow){.scene = rows->scene,
                                .method = curves->families[family].name,
                                .us_solver = time->us_solver,
                                .family = family};
        const BestRival rival = find_best(curves, family, PHASE_IMPACT, CURVE_MEAN, row->us_solver);
        row->error = error_at(curves, family, PHASE_IMPACT, CURVE_MEAN, row->us_solver, &row->reach);
        row->rival = name_rival(curves, &rival);
        row->rival_error = rival.error;
        row->ratio = row->error / rival.error;
        row->below = which_below(row->error, rival.error, chart_row_resolution(time));
    }
}

bool equal_time_make(EqualTime *table, const ChartRow *rows, int count, Error *error) {
    /* The most sweeps of momentum, of these, that were run somewhere. */
    static const char *const times[] = {"k=100", "k=50"};
    const size_t most = (size_t)count + 1;
    *table = (EqualTime){.rows = malloc(CURVE_STATISTICS * most * sizeof *table->rows),
                         .methods = malloc(most * sizeof *table->methods),
                         .time = "k=20"};
    for (int k = 1; k >= 0; k--)
        for (int i = 0; i < count; i++)
            if (strcmp(rows[i].method, "momentum") == 0 && strcmp(rows[i].setting, times[k]) == 0)
                table->time = times[k];
    RivalCurves *curves = &table->curves;
    *curves = (RivalCurves){.families = malloc(most * sizeof *curves->families),
                            .rows = malloc(most * sizeof *curves->rows),
                            .family = malloc(most * sizeof *curves->family),
                            .lost = malloc(most * sizeof *curves->lost),
                            .points = malloc(most * sizeof *curves->points)};
    const bool ok =
        (table->rows != NULL && table->methods != NULL && curves->families != NULL && curves->rows != NULL &&
         curves->family != NULL && curves->lost != NULL && curves->points != NULL) ||
        error_memory(error, "equal_time");
    for (int begin = 0, end; ok && begin < count; begin = end) {
        for (end = begin; end < count && strcmp(rows[end].scene, rows[begin].scene) == 0;) end++;
        compare_scene(table, rows + begin, end - begin);
    }
    if (!ok) equal_time_free(table);
    return ok;
}

void equal_time_free(EqualTime *table) {
    RivalCurves *curves = &table->curves;
    free(curves->families);
    free(curves->rows);
    free(curves->family);
    free(curves->lost);
    free(curves->points);
    free(table->rows);
    free(table->methods);
    *table = (EqualTime){0};
}
