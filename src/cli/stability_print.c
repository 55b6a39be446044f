/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/stability_print.h"

#include "stability/stability_table.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { LABEL_SIZE = 512, VALUE_SIZE = 32, LINE_WIDTH = 79, LABEL_WIDTH = 24 };

/* A number as the tables have it. */
typedef struct Value {
    char text[VALUE_SIZE];
} Value;

static Value show(double number) {
    Value value = {"-"};
    if (!isnan(number)) snprintf(value.text, sizeof value.text, "%.9g", number);
    return value;
}

/* "14 | 15 falls"; without a value on one side: "40 | - sways". */
static void describe(const BorderRow *row, char text[LABEL_SIZE]) {
    const char *verdict = verdict_words[row->verdict];
    if (isnan(row->holds_at) && isnan(row->fails_at))
        snprintf(text, LABEL_SIZE, "%s", verdict);
    else
        snprintf(text, LABEL_SIZE, "%s | %s %s", show(row->holds_at).text, show(row->fails_at).text, verdict);
}

static void write_label(char label[LABEL_SIZE], const char *method, const char *setting) {
    snprintf(label, LABEL_SIZE, "%s%s%s", method, setting[0] != '\0' ? ":" : "", setting);
}

/* The borders of one method, from row i on, in as many lines as needed. Returns the row after them. */
static int print_method(const BorderTable *table, int i) {
    const BorderRow *row = &table->rows[i];
    char label[LABEL_SIZE], border[LABEL_SIZE];
    write_label(label, row->method, row->setting);
    int next = i, width = printf("  %-*s", LABEL_WIDTH, label);
    do {
        describe(&table->rows[next], border);
        if (next > i) width += printf(";");
        if (next > i && width + (int)strlen(border) + 2 > LINE_WIDTH) width = printf("\n  %-*s", LABEL_WIDTH, "") - 1;
        width += printf(" %s", border);
        next++;
    } while (next < table->count && border_same_study(&table->rows[next], row) &&
             border_same_method(&table->rows[next], row));
    printf("\n");
    return next;
}

static bool print_borders(const char *folder, Error *error) {
    BorderTable table;
    if (!border_table_read(&table, folder, error)) return false;
    for (int i = 0; i < table.count;) {
        const BorderRow *row = &table.rows[i];
        if (i == 0 || !border_same_study(row, row - 1))
            printf("%s: %s%s%s, holds | fails\n", row->study, row->parameter, row->unit[0] != '\0' ? " in " : "",
                   row->unit);
        i = print_method(&table, i);
    }
    border_table_free(&table);
    return true;
}

static bool same_study(const RunRow *a, const RunRow *b) { return strcmp(a->study, b->study) == 0; }

static bool same_method(const RunRow *a, const RunRow *b) {
    return same_study(a, b) && strcmp(a->method, b->method) == 0 && strcmp(a->setting, b->setting) == 0;
}

/* "11 creeps, 0.154 m, -0.217 J": the last value at which the method holds, or else the first. */
static int print_method_at_rest(const RunRow *rows, int count, int i) {
    char label[LABEL_SIZE];
    int next = i, shown = i;
    for (; next < count && same_method(&rows[next], &rows[i]); next++)
        if (rows[next].verdict < VERDICTS && verdict_holds((Verdict)rows[next].verdict)) shown = next;
    const RunRow *row = &rows[shown];
    write_label(label, row->method, row->setting);
    printf("  %-*s %s %s", LABEL_WIDTH, label, show(row->value).text, verdict_words[row->verdict]);
    if (!isnan(row->drift)) printf(", %s m", show(row->drift).text);
    if (!isnan(row->energy)) printf(", %s J", show(row->energy).text);
    printf("\n");
    return next;
}

static bool print_rest(const char *folder, Error *error) {
    CsvTable table;
    if (!csv_table_read_from(&table, folder, &rest_layout, error)) return false;
    const RunRow *rows = table.rows;
    for (int i = 0; i < table.count;) {
        if (i == 0 || !same_study(&rows[i], &rows[i - 1]))
            printf("%s: the last %s that holds, drift and energy after %d s\n", rows[i].study, rows[i].parameter,
                   VERDICT_CREEP_FROM);
        i = print_method_at_rest(rows, table.count, i);
    }
    csv_table_free(&table);
    return true;
}

bool stability_print(const char *folder, Error *error) {
    if (!print_borders(folder, error) || !print_rest(folder, error)) return false;
    printf("borders -> %s/stability.csv; maps -> %s/maps.csv\n", folder, folder);
    printf("their figures -> %s/borders.png, %s/map-NAME.png\n", folder, folder);
    printf("why methods do not apply -> %s/refusals.csv\n", folder);
    printf("discarded outputs of networks, steps that fell back -> %s/fallbacks.csv\n", folder);
    printf("drift and energy at rest -> %s/rest.csv\n", folder);
    return true;
}
