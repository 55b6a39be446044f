/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/stability_print.h"

#include "common/csv.h"
#include "stability/verdict.h"

#include <stdio.h>
#include <string.h>

enum { PATH_SIZE = 4096, MAX_SIZE = 1 << 24, MAX_ROWS = 100000, LABEL_SIZE = 512, LINE_WIDTH = 79, LABEL_WIDTH = 24 };

/* Columns of stability.csv; rest.csv begins with the same. */
enum { STUDY, METHOD, SETTING, PARAMETER, UNIT, HOLDS_AT, FAILS_AT, VERDICT };
enum { REST_VALUE = UNIT + 1, REST_VERDICT, REST_STEPS, REST_DRIFT, REST_ENERGY };

static bool same(const Csv *csv, int row, int other, int first, int last) {
    for (int field = first; field <= last; field++)
        if (strcmp(csv_text(csv, row, field), csv_text(csv, other, field)) != 0) return false;
    return true;
}

/* "14 | 15 falls"; nothing on the other side: "40 | - sways". */
static void describe(const Csv *csv, int row, char text[LABEL_SIZE]) {
    const char *holds = csv_text(csv, row, HOLDS_AT), *fails = csv_text(csv, row, FAILS_AT);
    const char *verdict = csv_text(csv, row, VERDICT);
    if (holds[0] == '\0' && fails[0] == '\0')
        snprintf(text, LABEL_SIZE, "%s", verdict);
    else
        snprintf(text, LABEL_SIZE, "%s | %s %s", holds[0] != '\0' ? holds : "-", fails[0] != '\0' ? fails : "-",
                 verdict);
}

static void write_label(char label[LABEL_SIZE], const Csv *csv, int row) {
    const char *setting = csv_text(csv, row, SETTING);
    snprintf(label, LABEL_SIZE, "%s%s%s", csv_text(csv, row, METHOD), setting[0] != '\0' ? ":" : "", setting);
}

/* The borders of one method, from a row on, over as many lines as it takes. Returns the row after them. */
static int print_method(const Csv *csv, int row) {
    char label[LABEL_SIZE], border[LABEL_SIZE];
    write_label(label, csv, row);
    int next = row, width = printf("  %-*s", LABEL_WIDTH, label);
    do {
        describe(csv, next, border);
        if (next > row) width += printf(";");
        if (next > row && width + (int)strlen(border) + 2 > LINE_WIDTH) width = printf("\n  %-*s", LABEL_WIDTH, "") - 1;
        width += printf(" %s", border);
        next++;
    } while (next < csv->rows && same(csv, next, row, STUDY, SETTING));
    printf("\n");
    return next;
}

static void print_borders(const Csv *csv) {
    for (int row = 1; row < csv->rows;) {
        const char *unit = csv_text(csv, row, UNIT);
        if (row == 1 || !same(csv, row, row - 1, STUDY, STUDY))
            printf("%s: %s%s%s, holds | fails\n", csv_text(csv, row, STUDY), csv_text(csv, row, PARAMETER),
                   unit[0] != '\0' ? " in " : "", unit);
        row = print_method(csv, row);
    }
}

static bool holds(const Csv *csv, int row) {
    for (int verdict = 0; verdict_holds((Verdict)verdict); verdict++)
        if (strcmp(csv_text(csv, row, REST_VERDICT), verdict_name((Verdict)verdict)) == 0) return true;
    return false;
}

/* "11 creeps, 0.154 m, -0.217 J" of the last value at which the method holds, else of the first. */
static int print_method_at_rest(const Csv *csv, int row) {
    char label[LABEL_SIZE];
    int next = row, shown = row;
    for (; next < csv->rows && same(csv, next, row, STUDY, SETTING); next++)
        if (holds(csv, next)) shown = next;
    const char *drift = csv_text(csv, shown, REST_DRIFT), *energy = csv_text(csv, shown, REST_ENERGY);
    write_label(label, csv, row);
    printf("  %-*s %s %s", LABEL_WIDTH, label, csv_text(csv, shown, REST_VALUE), csv_text(csv, shown, REST_VERDICT));
    if (drift[0] != '\0') printf(", %s m", drift);
    if (energy[0] != '\0') printf(", %s J", energy);
    printf("\n");
    return next;
}

static void print_rest(const Csv *csv) {
    for (int row = 1; row < csv->rows;) {
        if (row == 1 || !same(csv, row, row - 1, STUDY, STUDY))
            printf("%s: the last %s that holds, drift and energy from %d s on\n", csv_text(csv, row, STUDY),
                   csv_text(csv, row, PARAMETER), VERDICT_CREEP_FROM);
        row = print_method_at_rest(csv, row);
    }
}

static bool print_table(const char *folder, const char *name, void (*print)(const Csv *csv), Error *error) {
    char path[PATH_SIZE];
    Csv csv;
    if (snprintf(path, sizeof path, "%s/%s.csv", folder, name) >= (int)sizeof path)
        return error_input(error, folder, "the name is too long");
    if (csv_is_bare(path)) return true;
    if (!csv_read(&csv, path, MAX_SIZE, 1, MAX_ROWS, error)) return false;
    print(&csv);
    csv_free(&csv);
    return true;
}

bool stability_print(const char *folder, Error *error) {
    if (!print_table(folder, "stability", print_borders, error) || !print_table(folder, "rest", print_rest, error))
        return false;
    printf("borders -> %s/stability.csv; maps -> %s/maps.csv\n", folder, folder);
    printf("their figures -> %s/borders.png, %s/map-NAME.png\n", folder, folder);
    printf("why methods do not apply -> %s/refusals.csv\n", folder);
    printf("what networks said and was not done -> %s/fallbacks.csv\n", folder);
    printf("drift and energy of what is left alone -> %s/rest.csv\n", folder);
    return true;
}
