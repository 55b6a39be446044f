/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Texts of a figure that cannot be read: cut by the page, shortened, covered by another text, crossed by a line, too
   pale for what is behind them, or read with a line that ends at a number as its minus sign. Include testing.h
   first. */
#pragma once
#include "figures/sketch_writers.h"
#include "figures/sketch.h"
#include "pixels/png.h"
#include "pixels/type.h"

/* What counts as a fault. Lengths in mm. */
static const double touch = 0.08;         /* boxes and lines that meet by less are beside each other */
static const double least_contrast = 4.5; /* WCAG 2, of small text */
static const double least_points = 3.5;   /* size of text on paper */
static const double seen_contrast = 1.35; /* a line is seen on what is behind it; the pale guides of plots are not */
static const double minus_length = 4;     /* a longer line is not read as a minus sign */

/* The outline of a text's letters on the page: a rectangle, turned. */
typedef struct Letters {
    Point corners[4]; /* counter-clockwise, the first at the start of the base */
    double em;
    const char *words;
    const SketchMark *mark;
} Letters;

/* The ink of the letters, not their line. */
static inline Letters letters_of(const Sketch *sketch, const SketchMark *mark) {
    const TextPlace place = text_place(sketch, mark);
    double low = HUGE_VAL, high = -HUGE_VAL, left = HUGE_VAL, right = -HUGE_VAL, pen = 0;
    const char *words = sketch->texts + mark->text;
    for (const char *next = words; *next != '\0';) {
        const Glyph *glyph = type_next(&next);
        for (int i = 0; i < glyph->steps; i++) {
            const OutlineStep *step = &type_regular.steps[glyph->first + i];
            left = fmin(left, pen + step->x), right = fmax(right, pen + step->x);
            low = fmin(low, step->y), high = fmax(high, step->y);
        }
        pen += glyph->advance;
    }
    Letters letters = {.em = place.em, .words = words, .mark = mark};
    const double unit = place.em / type_units, x[] = {left, right, right, left}, y[] = {low, low, high, high};
    for (int i = 0; i < 4; i++)
        letters.corners[i] = (Point){place.from.x + unit * (x[i] * place.cosine - y[i] * place.sine),
                                     place.from.y + unit * (x[i] * place.sine + y[i] * place.cosine)};
    return letters;
}

/* By how much two convex shapes overlap along the axis of least overlap; below 0: apart. */
static inline double overlap_along(const Point *a, const Point *b, int b_count, Point axis) {
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    for (int i = 0; i < 4; i++) {
        const double at = a[i].x * axis.x + a[i].y * axis.y;
        low[0] = fmin(low[0], at), high[0] = fmax(high[0], at);
    }
    for (int i = 0; i < b_count; i++) {
        const double at = b[i].x * axis.x + b[i].y * axis.y;
        low[1] = fmin(low[1], at), high[1] = fmax(high[1], at);
    }
    return fmin(high[0] - low[1], high[1] - low[0]);
}

static inline Point unit_from(Point from, Point to) {
    const double length = hypot(to.x - from.x, to.y - from.y);
    return length > 0 ? (Point){(to.x - from.x) / length, (to.y - from.y) / length} : (Point){1, 0};
}

/* The separating axis theorem for a rectangle and a rectangle or a line (count 2). */
static inline double overlap_of(const Point rectangle[4], const Point *other, int count) {
    const Point along = unit_from(rectangle[0], rectangle[1]), own = unit_from(other[0], other[1]);
    const Point axes[] = {along, {-along.y, along.x}, {-own.y, own.x}, own};
    double least = HUGE_VAL;
    for (int i = 0; i < 4; i++) least = fmin(least, overlap_along(rectangle, other, count, axes[i]));
    return least;
}

static inline double channel_light(uint32_t channel) {
    const double share = channel / 255.0;
    return share <= 0.04045 ? share / 12.92 : pow((share + 0.055) / 1.055, 2.4);
}

static inline double luminance(uint32_t rgb) {
    return 0.2126 * channel_light(rgb >> 16 & 255) + 0.7152 * channel_light(rgb >> 8 & 255) +
           0.0722 * channel_light(rgb & 255);
}

static inline double contrast(uint32_t a, uint32_t b) {
    const double p = luminance(a) + 0.05, q = luminance(b) + 0.05;
    return fmax(p, q) / fmin(p, q);
}

static inline uint32_t blend(uint32_t below, uint32_t above, double opacity) {
    uint32_t mixed = 0;
    for (int shift = 0; shift < 24; shift += 8) {
        const double p = below >> shift & 255, q = above >> shift & 255;
        mixed |= (uint32_t)lrint(p + opacity * (q - p)) << shift;
    }
    return mixed;
}

/* Even-odd rule. */
static inline bool shape_holds(const Sketch *sketch, const SketchMark *mark, Point at) {
    bool inside = false;
    const Point *points = sketch->points + mark->first;
    for (size_t i = 0, k = mark->count - 1; i < mark->count; k = i++)
        if ((points[i].y > at.y) != (points[k].y > at.y) &&
            at.x < (points[k].x - points[i].x) * (at.y - points[i].y) / (points[k].y - points[i].y) + points[i].x)
            inside = !inside;
    return inside;
}

static inline uint32_t pixel_below(const SketchMark *mark, Point at, uint32_t below) {
    const Image *image = mark->image;
    const double dots = image->width / mark->width;
    const int x = (int)floor((at.x - mark->at.x) * dots),
              y = image->height - 1 - (int)floor((at.y - mark->at.y) * dots);
    if (x < 0 || y < 0 || x >= image->width || y >= image->height) return below;
    const uint8_t *pixel = image->pixels + 4 * ((size_t)y * (size_t)image->width + (size_t)x);
    return blend(below, (uint32_t)pixel[0] << 16 | (uint32_t)pixel[1] << 8 | pixel[2], pixel[3] / 255.0);
}

/* The colour of pictures and filled shapes at a point of the page, without lines. */
static inline uint32_t ground_at(const Sketch *sketch, Point at) {
    uint32_t colour = 0xFFFFFF;
    for (size_t i = 0; i < sketch->mark_count; i++)
        if (sketch->marks[i].kind == MARK_IMAGE) colour = pixel_below(&sketch->marks[i], at, colour);
    for (size_t i = 0; i < sketch->mark_count; i++) {
        const SketchMark *mark = &sketch->marks[i];
        if (mark->kind == MARK_PATH && mark->closed && mark->pen.fill != NO_COLOUR && shape_holds(sketch, mark, at))
            colour = blend(colour, mark->pen.fill, mark->pen.opacity);
    }
    return colour;
}

typedef struct Faults {
    char figure[256]; /* for messages */
    int count;
    char text[8192]; /* as far as there is room */
} Faults;

static inline void fault(Faults *faults, const char *format, ...) PRINTF_LIKE(2, 3);
static inline void fault(Faults *faults, const char *format, ...) {
    char message[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    faults->count++;
    text_add(faults->text, sizeof faults->text, "%s: %s\n", faults->figure, message);
}

/* Fails with all faults so far, and forgets them. */
static inline void assert_clear(Faults *faults) {
    const Faults found = *faults;
    *faults = (Faults){0};
    if (found.count > 0) fail_msg("%d faults:\n%s", found.count, found.text);
}

static inline void check_alone(const Sketch *sketch, const Letters *text, Faults *faults) {
    double worst = HUGE_VAL;
    for (int i = 0; i < 4; i++) {
        const Point at = text->corners[i];
        if (at.x > -touch && at.x < sketch->width + touch && at.y > -touch && at.y < sketch->height + touch) continue;
        fault(faults, "\"%s\" is cut by the page: (%.1f, %.1f) of %.1f x %.1f mm", text->words, at.x, at.y,
              sketch->width, sketch->height);
        return;
    }
    const char *dots = strstr(text->words, "..."), *ellipsis = strstr(text->words, "\xE2\x80\xA6");
    if (dots != NULL || ellipsis != NULL) fault(faults, "\"%s\" is shortened", text->words);
    if (text->mark->style.points < least_points)
        fault(faults, "\"%s\" has %.1f points", text->words, text->mark->style.points);
    for (int i = 0; i <= 8; i++)
        for (int k = 0; k <= 2; k++) {
            const Point *c = text->corners;
            const double u = i / 8.0, v = k / 2.0;
            const Point at = {c[0].x + u * (c[1].x - c[0].x) + v * (c[3].x - c[0].x),
                              c[0].y + u * (c[1].y - c[0].y) + v * (c[3].y - c[0].y)};
            worst = fmin(worst, contrast(text->mark->style.colour, ground_at(sketch, at)));
        }
    if (worst < least_contrast) fault(faults, "\"%s\" has a contrast of %.1f", text->words, worst);
}

static inline bool is_number(char first) { return (first >= '0' && first <= '9') || first == '.'; }

/* A short line along the text that ends at its first digit. */
static inline bool reads_as_minus(const Letters *text, const Point line[2]) {
    const Point *c = text->corners, along = unit_from(c[0], c[1]), way = unit_from(line[0], line[1]);
    if (!is_number(text->words[0]) || hypot(line[1].x - line[0].x, line[1].y - line[0].y) > minus_length) return false;
    if (fabs(along.x * way.x + along.y * way.y) < 0.9) return false;
    for (int i = 0; i < 2; i++) {
        const double x = (line[i].x - c[0].x) * along.x + (line[i].y - c[0].y) * along.y;
        const double y = (line[i].y - c[0].y) * along.x - (line[i].x - c[0].x) * along.y;
        const double height = hypot(c[3].x - c[0].x, c[3].y - c[0].y);
        if (x > -0.5 * text->em && x < 0.1 * text->em && y > 0.15 * height && y < 0.85 * height) return true;
    }
    return false;
}

static inline void check_line(const Sketch *sketch, const Letters *text, const SketchMark *mark, Faults *faults) {
    const Point *points = sketch->points + mark->first;
    const size_t count = mark->count - !mark->closed;
    for (size_t i = 0; i < count; i++) {
        const Point line[2] = {points[i], points[(i + 1) % mark->count]};
        const Point middle = {(line[0].x + line[1].x) / 2, (line[0].y + line[1].y) / 2};
        if (!mark->closed && mark->count == 2 && reads_as_minus(text, line)) {
            fault(faults, "\"%s\" is read with a minus sign, a line at (%.1f, %.1f)", text->words, middle.x, middle.y);
            return;
        }
        if (overlap_of(text->corners, line, 2) <= touch) continue;
        fault(faults, "\"%s\" is crossed by a line from (%.1f, %.1f) to (%.1f, %.1f)", text->words, line[0].x,
              line[0].y, line[1].x, line[1].y);
        return;
    }
}

/* Adds the faults of all texts. */
static inline void check_texts(const Sketch *sketch, Faults *faults) {
    Letters *texts = calloc(sketch->mark_count + 1, sizeof *texts);
    size_t count = 0;
    assert_non_null(texts);
    for (size_t i = 0; i < sketch->mark_count; i++)
        if (sketch->marks[i].kind == MARK_TEXT && sketch->texts[sketch->marks[i].text] != '\0')
            texts[count++] = letters_of(sketch, &sketch->marks[i]);
    for (size_t i = 0; i < count; i++) {
        check_alone(sketch, &texts[i], faults);
        for (size_t k = 0; k < i; k++)
            if (overlap_of(texts[i].corners, texts[k].corners, 4) > touch)
                fault(faults, "\"%s\" covers \"%s\"", texts[i].words, texts[k].words);
        for (size_t k = 0; k < sketch->mark_count; k++) {
            const SketchMark *mark = &sketch->marks[k];
            if (mark->kind == MARK_PATH && mark->pen.line != NO_COLOUR &&
                contrast(mark->pen.line, 0xFFFFFF) > seen_contrast)
                check_line(sketch, &texts[i], mark, faults);
        }
    }
    free(texts);
}
