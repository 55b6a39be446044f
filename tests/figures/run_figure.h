/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shared by tests of figures of runs. Include testing.h first. */
#pragma once
#include "figures/figure.h"
#include "pictures/runs.h"

static inline FigureSpec spec_of(Trajectory *const *runs, int count) {
    static const char *const paths[] = {"a.npz", "b.npz", "c.npz"};
    FigureSpec spec = {.width = FIGURE_PAGE_WIDTH, .points = FIGURE_POINTS, .dpi = 100, .run_count = count};
    for (int i = 0; i < count; i++) spec.runs[i] = runs[i], spec.paths[i] = paths[i];
    return spec;
}

static inline void draw_kind(Sketch *sketch, const char *name, const FigureSpec *spec) {
    Error error = {0};
    const FigureKind *kind = figure_kind(name, &error);
    *sketch = (Sketch){0};
    assert_ok(kind != NULL && kind->draw(sketch, spec, &error) && !sketch->failed, error);
}

static inline void expect_kind_refused(const char *name, const FigureSpec *spec, const char *message) {
    Error error = {0};
    Sketch sketch = {0};
    const FigureKind *kind = figure_kind(name, &error);
    assert_ok(kind != NULL, error);
    assert_refused(kind->draw(&sketch, spec, &error), message);
    sketch_free(&sketch);
}

/* Number of the sketch's texts equal to this one. */
static inline int count_texts(const Sketch *sketch, const char *words) {
    int count = 0;
    for (size_t i = 0; i < sketch->mark_count; i++)
        count += sketch->marks[i].kind == MARK_TEXT && strcmp(sketch->texts + sketch->marks[i].text, words) == 0;
    return count;
}

/* The sketch has each of these texts once. */
#define assert_texts(sketch, ...)                                                                             \
    do {                                                                                                      \
        const char *const texts_[] = {__VA_ARGS__};                                                           \
        for (size_t text_ = 0; text_ < sizeof texts_ / sizeof *texts_; text_++)                               \
            if (count_texts(sketch, texts_[text_]) != 1) fail_msg("\"%s\" is not there once", texts_[text_]); \
    } while (0)

static inline void free_drawn(Sketch *sketch, Trajectory *const *runs, int count) {
    sketch_free(sketch);
    for (int i = 0; i < count; i++) trajectory_destroy(runs[i]);
}

static inline int count_marks(const Sketch *sketch, SketchMarkKind kind) {
    int count = 0;
    for (size_t i = 0; i < sketch->mark_count; i++) count += sketch->marks[i].kind == kind;
    return count;
}

static inline const SketchMark *nth_mark(const Sketch *sketch, SketchMarkKind kind, int n) {
    for (size_t i = 0; i < sketch->mark_count; i++)
        if (sketch->marks[i].kind == kind && n-- == 0) return &sketch->marks[i];
    fail_msg("the sketch has no such mark");
    return NULL;
}
