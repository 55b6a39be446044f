/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "picture/card.h"

#include "picture/body.h"
#include "picture/caption.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* In units of the picture's shorter side, as in layout.c. */
static const double HEAD = 0.075, HEAD_LINE = 0.095, SUBHEAD = 0.036, ROW = 0.036, CELL = 0.030, LINE = 0.072;
static const double WIDTH = 0.78; /* relative to the picture's width */

typedef struct Card {
    const Picture *picture;
    Drawing *drawing;
    Font head, subhead, row, cell;
    double unit;
    int left, right;
} Card;

static Card begin(const Picture *picture, Drawing *drawing) {
    const Layout *layout = &picture->layout;
    double unit = fmin(layout->height, 0.75 * layout->width);
    int margin = (int)rint((1 - WIDTH) / 2 * layout->width);
    return (Card){picture,
                  drawing,
                  font_pick(FONT_SEMIBOLD, HEAD * unit),
                  font_pick(FONT_REGULAR, SUBHEAD * unit),
                  font_pick(FONT_SEMIBOLD, ROW * unit),
                  font_pick(FONT_REGULAR, CELL * unit),
                  unit,
                  margin,
                  layout->width - margin};
}

/* The last of this many lines of the title; the card is centred slightly above the middle. */
static int head_baseline(const Card *card, int lines, int rows) {
    double height = (0.16 + LINE * rows - HEAD_LINE * (lines - 1)) * card->unit;
    return (int)rint(0.46 * card->picture->layout.height - height / 2 + 0.07 * card->unit);
}

static void add(const Card *card, const Font *font, const char *text, int x, int baseline, int right, uint32_t color) {
    font_add_fitting(card->drawing, font, text, x, baseline, right - x, color);
}

static void add_right(const Card *card, const Font *font, const char *text, int right, int baseline, uint32_t color) {
    font_add(card->drawing, font, text, right - font_width(font, text), baseline, color);
}

static int row_baseline(const Card *card, int first, int row) {
    return first + (int)rint((0.125 + LINE * row) * card->unit);
}

/* The rule below the head. */
static void draw_rule(const Card *card, int baseline) {
    int thickness = 2 * card->picture->layout.hairline;
    drawing_add_rect(card->drawing, (Rect){card->left, baseline, card->right, baseline + thickness},
                     card->picture->theme->grid_strong);
}

/* Adds swatch and name; returns the x where the name ends. */
static int add_method(const Card *card, int run, int baseline, int right, char note[CAPTION_SIZE]) {
    char title[CAPTION_SIZE];
    bool hollow = card->picture->look.compare == LOOK_OVERLAY && run > 0;
    caption_method(card->picture, run, title, note);
    int pixels = card->row.glyphs != NULL ? card->row.pixels : (int)(ROW * card->unit) + 4;
    int x = body_draw_swatch(card->picture, run, hollow, card->left, baseline, pixels, card->drawing);
    x += card->row.pixels / 2;
    return font_add_fitting(card->drawing, &card->row, title, x, baseline, right - x, card->picture->theme->ink);
}

TextLines card_head(const Picture *picture, MomentKind kind) {
    const Card card = begin(picture, NULL);
    char title[CAPTION_SIZE];
    caption_title(picture, title);
    const char *text = kind == MOMENT_END && picture->look.end != NULL ? picture->look.end : title;
    return text_lines(&card.head, text, card.right - card.left, card.right - card.left);
}

/* Draws the title and returns the baseline of its last line. */
static int draw_head(const Card *card, MomentKind kind) {
    const TextLines head = card_head(card->picture, kind);
    const int lines = head.count < TEXT_LINES_MAX ? head.count : TEXT_LINES_MAX;
    const int last = head_baseline(card, lines, card->picture->count);
    for (int i = 0; i < lines; i++) {
        const int baseline = last - (int)rint((lines - 1 - i) * HEAD_LINE * card->unit);
        add(card, &card->head, head.lines[i], card->left, baseline, card->right, card->picture->theme->ink);
    }
    return last;
}

static void draw_title(const Card *card) {
    const Picture *picture = card->picture;
    const Theme *theme = picture->theme;
    char note[CAPTION_SIZE], text[4 * CAPTION_SIZE];
    const int first = draw_head(card, MOMENT_TITLE);
    snprintf(text, sizeof text, "scene %s, %.3g s", picture->runs[0]->scene,
             (picture->frames - 1) * (double)picture->runs[0]->dt);
    add(card, &card->subhead, text, card->left, first + (int)rint(0.055 * card->unit), card->right, theme->ink_soft);
    for (int run = 0; run < picture->count; run++) {
        int baseline = row_baseline(card, first, run) + (int)rint(0.03 * card->unit);
        int x = add_method(card, run, baseline, card->right, note) + card->row.pixels / 2;
        caption_notes(picture, run, note, text, sizeof text);
        add(card, &card->cell, text, x, baseline, card->right, theme->ink_soft);
    }
}

/* The time of the first divergence from the first run, or a dash. */
static void format_divergence_time(const Picture *picture, int run, char *text, size_t size) {
    int frame = 0;
    while (frame < picture->frames &&
           !(picture_run_distance(picture, run, moment_stored(frame)) > EVENTS_VISIBLE_DISTANCE))
        frame++;
    if (frame < picture->frames)
        snprintf(text, size, "%.2f s", frame * (double)picture->runs[0]->dt);
    else
        snprintf(text, size, "\xE2\x80\x93");
}

/* The distance in the last frame that both this run and the first have. */
static double last_distance(const Picture *picture, int run) {
    int frames = picture->runs[0]->frames, own = picture->runs[run]->frames;
    return picture_run_distance(picture, run, moment_stored((own < frames ? own : frames) - 1));
}

static void format_metres(char *text, size_t size, double metres) {
    char number[32];
    caption_distance(number, sizeof number, metres);
    snprintf(text, size, "%s m", number);
}

static void draw_distances(const Card *card, int run, int baseline, const int columns[3]) {
    const Theme *theme = card->picture->theme;
    char text[64];
    format_metres(text, sizeof text, last_distance(card->picture, run));
    add_right(card, &card->cell, text, columns[0], baseline, theme->ink);
    format_metres(text, sizeof text, card->picture->run_largest[run]);
    add_right(card, &card->cell, text, columns[1], baseline, theme->ink);
    format_divergence_time(card->picture, run, text, sizeof text);
    add_right(card, &card->cell, text, columns[2], baseline, theme->ink);
}

static void draw_end(const Card *card) {
    static const char *const heads[] = {"at the end", "largest", "> 1 mm at"};
    const Picture *picture = card->picture;
    const Theme *theme = picture->theme;
    char title[CAPTION_SIZE], note[CAPTION_SIZE], text[2 * CAPTION_SIZE];
    const int first = draw_head(card, MOMENT_END), column = (int)rint(0.17 * (card->right - card->left));
    const int columns[3] = {card->right - 2 * column, card->right - column, card->right};
    caption_method(picture, 0, title, note);
    snprintf(text, sizeof text, picture->count > 1 ? "distance from %s" : "%s", title);
    int baseline = first + (int)rint(0.065 * card->unit);
    add(card, &card->cell, text, card->left, baseline, columns[0] - column, theme->ink_soft);
    for (int i = 0; i < 3 && picture->count > 1; i++)
        add_right(card, &card->cell, heads[i], columns[i], baseline, theme->ink_soft);
    draw_rule(card, baseline + (int)rint(0.02 * card->unit));
    for (int run = 0; run < picture->count; run++) {
        baseline = row_baseline(card, first, run) + (int)rint(0.02 * card->unit);
        add_method(card, run, baseline, run > 0 ? columns[0] - column : card->right, note);
        if (run > 0) draw_distances(card, run, baseline, columns);
    }
}

void card_draw(const Picture *picture, Moment moment, Drawing *drawing) {
    Card card = begin(picture, drawing);
    drawing->static_shapes = 0;
    if (moment.kind == MOMENT_TITLE)
        draw_title(&card);
    else
        draw_end(&card);
}
