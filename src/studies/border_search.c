/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The search for borders along a parameter: a coarse scan, bisection, and the seeds on both sides. */
#include "base/base.h"
#include "runs/verdict.h"
#include "studies/stability.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef enum Side { SIDE_HOLDS, SIDE_FAILS, SIDE_UNDECIDED } Side;

typedef struct Sample {
    double value;
    Side side;
    Verdict verdict; /* the worst of the evaluated seeds */
    bool checked;    /* all seeds were evaluated */
} Sample;

typedef struct Search {
    const BorderScan *scan;
    const BorderProbe *probe;
    Sample *samples; /* [count] ascending */
    size_t capacity;
    int count;
} Search;

static double rounded(const BorderScan *scan, double value) {
    char text[32];
    if (scan->whole) return round(value);
    snprintf(text, sizeof text, "%.4g", value);
    return strtod(text, NULL);
}

int border_scan_values(const BorderScan *scan, double values[BORDER_POINTS_MAX]) {
    int count = 0;
    for (int i = 0; i < scan->points; i++) {
        double share = (double)i / (scan->points - 1);
        double value = scan->logarithmic ? scan->from * pow(scan->to / scan->from, share)
                                         : scan->from + share * (scan->to - scan->from);
        value = rounded(scan, value);
        if (count == 0 || value > values[count - 1]) values[count++] = value;
    }
    return count;
}

static bool resolved(const BorderScan *scan, double low, double high) {
    if (scan->whole && high - low <= 1) return true;
    return scan->logarithmic ? high <= 1.05 * low : high - low <= (scan->to - scan->from) / 100;
}

/* The value one resolution further in the direction. */
static double beside(const BorderScan *scan, double value, int direction) {
    double step = scan->logarithmic ? 0.05 * value : (scan->to - scan->from) / 100;
    if (scan->whole && step < 1) step = 1;
    return rounded(scan, value + direction * step);
}

static double middle(const BorderScan *scan, double low, double high) {
    return rounded(scan, scan->logarithmic ? sqrt(low * high) : 0.5 * (low + high));
}

/* Evaluates the seeds first .. last - 1. */
static bool evaluate(const Search *search, Sample *sample, int first, int last, Error *error) {
    for (int seed = first; seed < last; seed++) {
        Verdict verdict;
        if (!search->probe->evaluate(search->probe->context, sample->value, seed, &verdict, error)) return false;
        Side side = verdict_holds(verdict) ? SIDE_HOLDS : verdict == VERDICT_UNDECIDED ? SIDE_UNDECIDED : SIDE_FAILS;
        if (seed > 0 && side != sample->side) side = SIDE_UNDECIDED;
        if (seed == 0 || verdict > sample->verdict) sample->verdict = verdict;
        sample->side = side;
    }
    sample->checked = last == search->probe->seeds;
    return true;
}

static bool check(const Search *search, Sample *sample, Error *error) {
    return sample->checked || evaluate(search, sample, 1, search->probe->seeds, error);
}

/* Evaluates a value and inserts it at an index. checked: with all seeds, else with seed 0 only. */
static bool insert(Search *search, int place, double value, bool checked, Error *error) {
    Sample sample = {.value = value};
    if (!evaluate(search, &sample, 0, checked ? search->probe->seeds : 1, error)) return false;
    if (!array_reserve((void **)&search->samples, &search->capacity, (size_t)search->count + 1, sizeof sample))
        return error_memory(error, "border");
    memmove(&search->samples[place + 1], &search->samples[place], (size_t)(search->count - place) * sizeof sample);
    search->samples[place] = sample;
    search->count++;
    return true;
}

/* Evaluates the value beside a side of a border, away from the border, unless it is known. */
static bool check_beside(Search *search, int i, int direction, bool *found, Error *error) {
    const int next = i + direction;
    if (search->samples[i].side == SIDE_UNDECIDED || next < 0 || next >= search->count) return true;
    const double value = search->samples[i].value, limit = search->samples[next].value;
    const double outward = beside(search->scan, value, direction);
    if (direction * (limit - outward) <= 0) return true;
    *found = true;
    return insert(search, direction > 0 ? next : i, outward, true, error);
}

/* Refines until differing neighbours are within the resolution and they and the values beside them have been evaluated
   with all seeds. */
static bool refine(Search *search, Error *error) {
    for (int i = 0; i + 1 < search->count;) {
        Sample *low = &search->samples[i], *high = low + 1;
        double between = middle(search->scan, low->value, high->value);
        if (low->side == high->side) {
            i++;
        } else if (!resolved(search->scan, low->value, high->value) && between > low->value && between < high->value) {
            if (!insert(search, i + 1, between, low->side == SIDE_UNDECIDED || high->side == SIDE_UNDECIDED, error))
                return false;
        } else if (!low->checked || !high->checked) {
            if (!check(search, low, error) || !check(search, high, error)) return false;
            /* The lower one may now differ from its predecessor. */
            if (i > 0) i--;
        } else {
            bool found = false;
            if (!check_beside(search, i + 1, 1, &found, error) || !check_beside(search, i, -1, &found, error))
                return false;
            if (!found)
                i++;
            else if (i > 0)
                i--;
        }
    }
    return true;
}

/* Samples in the order of the list. */
static const Sample *sample_at(const Search *search, int i) {
    return &search->samples[search->scan->fails_low ? search->count - 1 - i : i];
}

static bool add_border(BorderList *list, const Sample *holds, const Sample *fails, Verdict verdict, Error *error) {
    if (list->count == BORDERS_MAX) return error_input(error, "border", "more than %d borders found", BORDERS_MAX);
    list->items[list->count++] =
        (Border){holds != NULL ? holds->value : NAN, fails != NULL ? fails->value : NAN, verdict};
    return true;
}

static bool list_borders(const Search *search, BorderList *list, Error *error) {
    const Sample *before = NULL; /* the last decided one */
    Verdict worst = VERDICT_SETTLES;
    for (int i = 0; i < search->count; i++) {
        const Sample *now = sample_at(search, i);
        if (now->side == SIDE_UNDECIDED) {
            if (now->verdict > worst) worst = now->verdict;
            continue;
        }
        const Sample *holds = now->side == SIDE_HOLDS ? now : before, *fails = now->side == SIDE_HOLDS ? before : now;
        if (before != NULL && before->side != now->side && !add_border(list, holds, fails, fails->verdict, error))
            return false;
        before = now;
        worst = VERDICT_SETTLES;
    }
    if (list->count == 0) {                       /* all decided values hold, or all fail */
        const Sample *last = NULL, *first = NULL; /* that holds, before any that is undecided; that fails */
        bool decided = true;
        worst = VERDICT_SETTLES;
        for (int i = 0; i < search->count; i++) {
            const Sample *sample = sample_at(search, i);
            if (sample->verdict > worst) worst = sample->verdict;
            decided = decided && sample->side != SIDE_UNDECIDED;
            if (sample->side == SIDE_HOLDS && decided) last = sample;
            if (sample->side == SIDE_FAILS && first == NULL) first = sample;
        }
        return add_border(list, last, first, first != NULL ? first->verdict : worst, error);
    }
    if (worst > VERDICT_SETTLES && before->side == SIDE_HOLDS) return add_border(list, before, NULL, worst, error);
    return true;
}

bool border_search(BorderList *list, const BorderScan *scan, const BorderProbe *probe, Error *error) {
    BorderScan turned = *scan;
    Search search = {.scan = &turned, .probe = probe};
    list->count = 0;
    double values[BORDER_POINTS_MAX];
    const int count = border_scan_values(scan, values);
    bool ok = true;
    for (int i = 0; ok && i < count; i++) ok = insert(&search, i, values[i], false, error);
    const Sample *first = search.samples;
    if (ok && scan->either && first != NULL)
        turned.fails_low = first->side == SIDE_FAILS && first[search.count - 1].side == SIDE_HOLDS;
    ok = ok && refine(&search, error) && list_borders(&search, list, error);
    free(search.samples);
    return ok;
}
