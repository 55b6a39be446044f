/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The title card before a run, and the end card with its results. */
#include "methods/methods.h"
#include "pictures/pictures_internal.h"
#include "pictures/picture.h"
#include "pixels/gl.h"
#include "runs/compare_runs.h"
#include "runs/trajectory.h"
#include "runs/verdict.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* In units of the picture's shorter side, as in picture.c. */
static const double HEAD = 0.075, HEAD_LINE = 0.095, SUBHEAD = 0.036, ROW = 0.036, CELL = 0.030, LINE = 0.072,
                    NOTES_DROP = 0.034;
static const double WIDTH = 0.78; /* relative to the picture's width */

typedef struct Card {
    const Picture *picture;
    Drawing *drawing;
    Font head, subhead, row, cell;
    double unit;
    int left, right, names; /* the names of runs begin beside their swatches */
} Card;

static Card begin(const Picture *picture, Drawing *drawing) {
    const Layout *layout = &picture->layout;
    const double unit = fmin(layout->height, UNIT_WIDTH * layout->width);
    const int margin = (int)rint((1 - WIDTH) / 2 * layout->width);
    Card card = {.picture = picture, .drawing = drawing, .unit = unit, .left = margin};
    card.head = font_pick(FONT_SEMIBOLD, HEAD * unit), card.subhead = font_pick(FONT_REGULAR, SUBHEAD * unit);
    card.row = font_pick(FONT_SEMIBOLD, ROW * unit), card.cell = font_pick(FONT_REGULAR, CELL * unit);
    card.right = layout->width - margin;
    card.names = margin + card.row.pixels * 3 / 4 + card.row.pixels / 2;
    return card;
}

static int scaled(const Card *card, double share) { return (int)rint(share * card->unit); }

static void add_left(const Card *card, const Font *font, const char *text, int x, int baseline, int right) {
    font_add_fitting(card->drawing, font, text, x, baseline, right - x, card->picture->theme->ink_soft);
}

static void add_right(const Card *card, const char *text, int right, int baseline, uint32_t color) {
    font_add(card->drawing, &card->cell, text, right - font_width(&card->cell, text), baseline, color);
}

static int row_baseline(const Card *card, int first, int row) { return first + scaled(card, 0.125 + LINE * row); }

/* Adds swatch and name of a run: on one line in the larger font, or in the smaller one on as many as it needs, around
   the baseline. Returns the x where its longest line ends. */
static int add_run(const Card *card, int run, const char *name, int baseline, int right) {
    const Picture *picture = card->picture;
    const Font *small = &picture->layout.axis;
    const uint32_t ink = picture->theme->ink;
    const int room = right - card->names;
    body_draw_swatch(picture, run, picture->look.compare == LOOK_OVERLAY && run > 0, card->left, baseline,
                     card->row.glyphs != NULL ? card->row.pixels : (int)(ROW * card->unit) + 4, card->drawing);
    if (font_width(&card->row, name) <= room)
        return font_add(card->drawing, &card->row, name, card->names, baseline, ink);
    const TextLines text = text_lines(small, name, room, room);
    const int lines = text.count < TEXT_LINES_MAX ? text.count : TEXT_LINES_MAX, pitch = small->pixels * 5 / 4;
    int end = card->names;
    for (int i = 0; i < lines; i++) {
        const int line = baseline - (lines - 1) * pitch / 2 + i * pitch;
        const int line_end = font_add_fitting(card->drawing, small, text.lines[i], card->names, line, room, ink);
        if (line_end > end) end = line_end;
    }
    return end;
}

TextLines card_head(const Picture *picture, MomentKind kind) {
    const Card card = begin(picture, NULL);
    char title[CAPTION_TEXT_SIZE];
    caption_title(picture, title);
    const char *text = kind == MOMENT_END && picture->look.end != NULL ? picture->look.end : title;
    return text_lines(&card.head, text, card.right - card.left, card.right - card.left);
}

/* Draws the title, with the card centred slightly above the middle, and returns the baseline of its last line. */
static int draw_head(const Card *card, MomentKind kind) {
    const Picture *picture = card->picture;
    const TextLines head = card_head(picture, kind);
    const int lines = head.count < TEXT_LINES_MAX ? head.count : TEXT_LINES_MAX;
    const int rows = picture->count;
    const double height = (0.16 + LINE * rows - HEAD_LINE * (lines - 1)) * card->unit;
    const int last = (int)rint(0.46 * picture->layout.height - height / 2 + 0.07 * card->unit);
    for (int i = 0; i < lines; i++)
        font_add_fitting(card->drawing, &card->head, head.lines[i], card->left,
                         last - scaled(card, (lines - 1 - i) * HEAD_LINE), card->right - card->left,
                         picture->theme->ink);
    return last;
}

static void draw_title(const Card *card) {
    const Picture *picture = card->picture;
    const Font *small = &picture->layout.axis;
    char name[CAPTION_TEXT_SIZE], note[CAPTION_TEXT_SIZE], text[4 * CAPTION_TEXT_SIZE];
    const int first = draw_head(card, MOMENT_TITLE);
    snprintf(text, sizeof text, "scene %s, %.3g s", picture->runs[0]->scene,
             (picture->frames - 1) * (double)picture->runs[0]->dt);
    add_left(card, &card->subhead, text, card->left, first + scaled(card, 0.055), card->right);
    for (int run = 0; run < picture->count; run++) {
        int baseline = row_baseline(card, first, run) + scaled(card, 0.03);
        caption_method(picture, run, name, note);
        caption_notes(picture, run, note, text, sizeof text);
        const int beside = card->names + font_width(&card->row, name) + card->row.pixels / 2;
        const bool below = font_width(small, text) > card->right - beside; /* no room for notes beside the name */
        if (below) baseline -= scaled(card, NOTES_DROP / 2);
        int x = add_run(card, run, name, baseline, card->right) + card->row.pixels / 2;
        if (below) x = card->names, baseline += scaled(card, NOTES_DROP);
        const bool fits = font_width(&card->cell, text) <= card->right - x;
        add_left(card, fits ? &card->cell : small, text, x, baseline, card->right);
    }
}

/* How bad the verdict of a run is; -1: unknown. */
static int badness(const Trajectory *run) {
    for (int verdict = VERDICT_SETTLES; verdict < VERDICTS; verdict++) {
        const char *name = verdict_name((Verdict)verdict);
        const char after = strncmp(run->verdict, name, strlen(name)) == 0 ? run->verdict[strlen(name)] : 'x';
        if (after == '\0' || after == ' ' || after == ';') return verdict;
    }
    return -1;
}

/* The table compares with the reference; else with the first run, unless another has a better verdict. What burst says
   nothing of the others. */
void card_plan(Picture *picture) {
    int best = 0, reference = -1;
    bool known = true;
    for (int run = picture->count - 1; run >= 0; run--) {
        if (picture->methods[run] != NULL && picture->methods[run]->role == METHOD_REFERENCE) reference = run;
        known &= badness(picture->runs[run]) >= 0;
    }
    for (int run = 1; run < picture->count; run++)
        if (badness(picture->runs[run]) < badness(picture->runs[best])) best = run;
    picture->card_base = reference >= 0 ? reference : known ? best : 0;

    const Trajectory *base = picture->runs[picture->card_base];
    for (int i = 0; i < picture->count; i++) {
        const Trajectory *run = picture->runs[i];
        CardRow *row = &picture->card_rows[i];
        *row = (CardRow){.frame = -1};
        for (int frame = 0; frame < run->frames && frame < base->frames; frame++) {
            row->last = trajectory_distance(base, run, frame);
            row->largest = fmax(row->largest, row->last);
            if (row->frame < 0 && row->last > EVENTS_VISIBLE_DISTANCE) row->frame = frame;
        }
    }
}

/* The verdict of a run without figures behind what happened, as in pages (player/time.js): up to " (", or to "; "
   unless a count of boxes follows. */
static void short_verdict(const Trajectory *run, char *text, size_t size) {
    size_t length = 0;
    for (const char *at; *(at = run->verdict + length) != '\0' && strncmp(at, " (", 2) != 0; length++)
        if (strncmp(at, "; ", 2) == 0 && strncmp(at + 2 + strspn(at + 2, "0123456789"), " of ", 4) != 0 &&
            strncmp(at + 2 + strspn(at + 2, "0123456789"), " moved ", 7) != 0)
            break;
    snprintf(text, size, "%.*s", (int)length, run->verdict);
}

static void draw_end(const Card *card) {
    static const char *const heads[] = {"at the end", "largest", "> 1 mm at"};
    const Picture *picture = card->picture;
    const Theme *theme = picture->theme;
    char title[CAPTION_TEXT_SIZE], note[CAPTION_TEXT_SIZE], text[2 * CAPTION_TEXT_SIZE];
    const int base = picture->card_base;
    const int first = draw_head(card, MOMENT_END), column = (int)rint(0.17 * (card->right - card->left));
    const int columns[3] = {card->right - 2 * column, card->right - column, card->right};
    caption_method(picture, base, title, note);
    snprintf(text, sizeof text, picture->count > 1 ? "distance from %s" : "%s", title);
    int baseline = first + scaled(card, 0.065);
    add_left(card, &card->cell, text, card->left, baseline, columns[0] - column);
    for (int i = 0; i < 3 && picture->count > 1; i++) add_right(card, heads[i], columns[i], baseline, theme->ink_soft);
    const int rule = baseline + scaled(card, 0.02);
    drawing_add_rect(card->drawing, (Rect){card->left, rule, card->right, rule + 2 * picture->layout.hairline},
                     theme->grid_strong);
    for (int run = 0; run < picture->count; run++) {
        baseline = row_baseline(card, first, run) + scaled(card, 0.02);
        caption_method(picture, run, title, note);
        short_verdict(picture->runs[run], text, sizeof text);
        const int right = run != base && picture->count > 1 ? columns[0] - column : card->right,
                  up = text[0] != '\0' ? scaled(card, NOTES_DROP / 2) : 0;
        add_run(card, run, title, baseline - up, right);
        if (up > 0) add_left(card, &picture->layout.axis, text, card->names, baseline + 2 * up / 3, right);
        if (run == base) continue;
        const CardRow *row = &picture->card_rows[run];
        const double distances[] = {row->last, row->largest};
        for (int i = 0; i < 2; i++) {
            char number[32];
            caption_distance(number, sizeof number, distances[i]);
            snprintf(text, sizeof text, "%s m", number);
            add_right(card, text, columns[i], baseline, theme->ink);
        }
        snprintf(text, sizeof text, "%.2f s", row->frame * (double)picture->runs[0]->dt);
        if (row->frame < 0) snprintf(text, sizeof text, "\xE2\x80\x93");
        add_right(card, text, columns[2], baseline, theme->ink);
    }
}

void card_draw(const Picture *picture, Moment moment, Drawing *drawing) {
    const Card card = begin(picture, drawing);
    drawing->static_shapes = 0;
    if (moment.kind == MOMENT_TITLE)
        draw_title(&card);
    else
        draw_end(&card);
}
