/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "methods/methods.h"
#include "pictures/internal.h"
#include "pictures/picture.h"
#include "pixels/gl.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* In units of the picture's shorter side, as in pictures/picture.c. */
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
static int add_method(const Card *card, int run, int baseline, int right, char note[CAPTION_TEXT_SIZE]) {
    char title[CAPTION_TEXT_SIZE];
    bool hollow = card->picture->look.compare == LOOK_OVERLAY && run > 0;
    caption_method(card->picture, run, title, note);
    int pixels = card->row.glyphs != NULL ? card->row.pixels : (int)(ROW * card->unit) + 4;
    int x = body_draw_swatch(card->picture, run, hollow, card->left, baseline, pixels, card->drawing);
    x += card->row.pixels / 2;
    return font_add_fitting(card->drawing, &card->row, title, x, baseline, right - x, card->picture->theme->ink);
}

TextLines card_head(const Picture *picture, MomentKind kind) {
    const Card card = begin(picture, NULL);
    char title[CAPTION_TEXT_SIZE];
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
    char note[CAPTION_TEXT_SIZE], text[4 * CAPTION_TEXT_SIZE];
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
    char title[CAPTION_TEXT_SIZE], note[CAPTION_TEXT_SIZE], text[2 * CAPTION_TEXT_SIZE];
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

/* The line above a panel. */

enum { NOTE_EMS = 5 }; /* a description with less room says nothing */

/* What a panel does not show, in full and in short. */
typedef struct State {
    char full[64], brief[64];
} State;

static State describe_state(const Picture *picture, int panel, Moment moment) {
    const bool ended = moment.frame >= picture->runs[picture_run(picture, panel)]->frames;
    const int unseen = panel_count_out_of_view(picture, panel, moment);
    State state = {"", ""};
    if (unseen > 0) {
        snprintf(state.full, sizeof state.full, "%d out of view%s", unseen, ended ? ", ended" : "");
        snprintf(state.brief, sizeof state.brief, "%d out%s", unseen, ended ? ", ended" : "");
    } else if (ended)
        snprintf(state.full, sizeof state.full, "ended"), snprintf(state.brief, sizeof state.brief, "ended");
    return state;
}

static bool is_hollow(const Picture *picture, int run) { return picture->look.compare == LOOK_OVERLAY && run > 0; }

/* The swatch and the space after it. Boxes coloured by their distance show their run's colour only in the timeline. */
static int swatch_width(const Picture *picture, int run) {
    const int pixels = picture->layout.title.pixels;
    const bool none =
        picture_colors_distance(picture, run) && !is_hollow(picture, run) && (picture->look.show & LOOK_TIMELINE) == 0;
    return none ? 0 : pixels * 3 / 4 + pixels / 2;
}

static int name_width(const Picture *picture, int run) {
    char name[CAPTION_TEXT_SIZE], note[CAPTION_TEXT_SIZE];
    caption_method(picture, run, name, note);
    return swatch_width(picture, run) + font_width(&picture->layout.title, name);
}

int caption_least_width(const Picture *picture, bool whole) {
    const Layout *layout = &picture->layout;
    const CaptionItem distance = caption_distance_item("", 0);
    int least = 0;
    for (int run = 0; run < picture->count; run++) {
        char name[CAPTION_TEXT_SIZE], note[CAPTION_TEXT_SIZE];
        caption_method(picture, run, name, note);
        snprintf(name + method_name_head(name), 4, "\xE2\x80\xA6");
        const int width = whole ? name_width(picture, run) + layout->title.pixels / 2 +
                                      (run > 0 ? caption_item_width(&layout->method, &distance) : 0)
                                : swatch_width(picture, run) + font_width(&layout->axis, name);
        if (width > least) least = width;
    }
    return least;
}

/* Room that a name keeps whatever stands beside it: all that it needs; but of very long settings only a part. */
static int kept_width(const Picture *picture, int run) {
    const Rect *panel = &picture->layout.panels[0];
    const int most = (panel->right - panel->left) * 3 / 5, whole = name_width(picture, run);
    char name[CAPTION_TEXT_SIZE], note[CAPTION_TEXT_SIZE];
    caption_method(picture, run, name, note);
    snprintf(name + method_name_head(name), 4, "\xE2\x80\xA6"); /* an ellipsis */
    const int head = swatch_width(picture, run) + font_width(&picture->layout.title, name);
    return whole < most ? whole : most > head ? most : head < whole ? head : whole;
}

/* Swatch and name in at most `room` pixels; returns the x where the name ends. */
static int draw_name(const Picture *picture, int run, int x, int baseline, int room, Drawing *drawing) {
    const Layout *layout = &picture->layout;
    const int swatch = swatch_width(picture, run);
    char name[CAPTION_TEXT_SIZE], note[CAPTION_TEXT_SIZE];
    caption_method(picture, run, name, note);
    if (swatch > 0) body_draw_swatch(picture, run, is_hollow(picture, run), x, baseline, layout->title.pixels, drawing);
    return caption_name_draw(picture, &layout->title, name, x + swatch, baseline, room - swatch, drawing);
}

static void notes_of(const Picture *picture, int run, char text[4 * CAPTION_TEXT_SIZE]) {
    char name[CAPTION_TEXT_SIZE], note[CAPTION_TEXT_SIZE];
    caption_method(picture, run, name, note);
    caption_notes(picture, run, note, text, 4 * CAPTION_TEXT_SIZE);
}

static void draw_notes(const Picture *picture, int run, int left, int right, int baseline, Drawing *drawing) {
    const Font *font = &picture->layout.method;
    char text[4 * CAPTION_TEXT_SIZE];
    notes_of(picture, run, text);
    if (right - left >= NOTE_EMS * font->pixels || font_width(font, text) <= right - left)
        font_add_fitting(drawing, font, text, left, baseline, right - left, picture->theme->ink_soft);
}

/* How the runs of an overlay share the line above it, in pixels. */
typedef struct Shares {
    int names[RENDER_PANELS_MAX], notes[RENDER_PANELS_MAX]; /* of each run, with the space before */
    int distance;                                           /* of each run but the first; 0: no room for them */
    int spare;                                              /* what is left for each run */
} Shares;

/* Shares room by need: widths that are too large are cut to the same one. Returns what is left. */
static int share(int *widths, int count, int room) {
    const int most = caption_fair_width(widths, count, room > 0 ? room : 0);
    for (int i = 0; i < count; i++) room -= widths[i] = widths[i] < most ? widths[i] : most;
    return room > 0 ? room : 0;
}

/* Names first, then distances, all or none, then descriptions. */
static Shares share_line(const Picture *picture, int room) {
    const Font *font = &picture->layout.method;
    const CaptionItem any = caption_distance_item("", 0);
    const int count = picture->count, gap = picture->layout.title.pixels / 2;
    Shares shares = {.distance = caption_item_width(font, &any) + gap};
    for (int run = 0; run < count; run++) {
        char text[4 * CAPTION_TEXT_SIZE];
        notes_of(picture, run, text);
        shares.names[run] = name_width(picture, run);
        shares.notes[run] = text[0] != '\0' ? font_width(font, text) + gap : 0;
    }
    int left = share(shares.names, count, room);
    if (left < (count - 1) * shares.distance) shares.distance = 0;
    left = share(shares.notes, count, left - (count - 1) * shares.distance);
    shares.spare = left / count;
    return shares;
}

/* All runs of an overlay on one line. */
static void draw_overlay(const Picture *picture, Moment moment, int left, int right, int baseline, Drawing *drawing) {
    const int between = picture->layout.title.pixels, gap = between / 2;
    const Shares shares = share_line(picture, right - left - (picture->count - 1) * between);
    for (int run = 0, x = left; run < picture->count; run++) {
        draw_name(picture, run, x, baseline, shares.names[run], drawing);
        x += shares.names[run];
        if (run > 0 && shares.distance > 0) {
            const CaptionItem distance = caption_distance_item("", picture_run_distance(picture, run, moment));
            caption_item_draw(picture, &picture->layout.method, &distance, x + gap, baseline, drawing);
            x += shares.distance;
        }
        draw_notes(picture, run, x + gap, x + shares.notes[run], baseline, drawing);
        x += shares.notes[run] + shares.spare + between;
    }
}

static bool has_distance(const Picture *picture, int panel) {
    return picture_run(picture, panel) > 0 && !caption_is_pair(picture);
}

/* "distance " if it fits above every panel, also beside a number of bodies out of view: it must not come and go. */
static const char *distance_label(const Picture *picture) {
    const Layout *layout = &picture->layout;
    const CaptionItem item = caption_distance_item("distance ", 0);
    const int needed = caption_item_width(&layout->method, &item) + font_width(&layout->method, "00 out") +
                       layout->method.pixels + 2 * layout->title.pixels;
    for (int panel = 0; panel < picture->panel_count; panel++)
        if (has_distance(picture, panel) && kept_width(picture, picture_run(picture, panel)) + needed >
                                                layout->panels[0].right - layout->panels[0].left)
            return "";
    return "distance ";
}

/* In the panel's upper right corner, where the line above it has no room: what cannot be seen must be stated. */
static void draw_state_inside(const Picture *picture, const Rect *panel, const char *text, Drawing *drawing) {
    const Font *font = &picture->layout.axis;
    const int inset = font->pixels / 2;
    font_add(drawing, font, text, panel->right - inset - font_width(font, text), panel->top + inset + font->pixels,
             picture->theme->ink_soft);
}

void caption_panel(const Picture *picture, int panel, Moment moment, Drawing *drawing) {
    const Layout *layout = &picture->layout;
    const Rect *rect = &layout->panels[panel];
    const Font *font = &layout->method;
    const int baseline = rect->top - layout->title_rise, gap = layout->title.pixels / 2;
    const int run = picture_run(picture, panel);
    if (layout->title.glyphs == NULL) return;
    if (picture->look.compare == LOOK_OVERLAY) {
        draw_overlay(picture, moment, rect->left, rect->right, baseline, drawing);
        return;
    }
    const int name_end = rect->left + kept_width(picture, run) + gap;
    int right = rect->right;
    if (has_distance(picture, panel)) {
        const CaptionItem item =
            caption_distance_item(distance_label(picture), picture_run_distance(picture, run, moment));
        const int left = right - caption_item_width(font, &item);
        if (left >= name_end) {
            caption_item_draw(picture, font, &item, left, baseline, drawing);
            right = left - font->pixels;
        }
    }
    const State state = describe_state(picture, panel, moment);
    const char *text = font_width(font, state.full) <= right - name_end ? state.full : state.brief;
    if (font_width(font, text) <= right - name_end && text[0] != '\0') {
        right -= font_width(font, text);
        font_add(drawing, font, text, right, baseline, picture->theme->ink_soft);
        right -= gap;
    } else if (text[0] != '\0')
        draw_state_inside(picture, rect, text, drawing);
    const int end = draw_name(picture, run, rect->left, baseline, right - rect->left, drawing);
    draw_notes(picture, run, end + gap, right, baseline, drawing);
}
