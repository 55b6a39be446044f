/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The line above a panel, and the cards before and after a run. */
#include "methods/methods.h"
#include "methods/names.h"
#include "pictures/pictures_internal.h"
#include "pictures/picture.h"
#include "pixels/gl.h"
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
    int left, right;
} Card;

static Card caption_panel_begin(const Picture *picture, Drawing *drawing) {
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

static void caption_panel_add(const Card *card, const Font *font, const char *text, int x, int baseline, int right,
                              uint32_t color) {
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

/* A name is on one line in the larger font, or in the smaller one on as many as it needs, around the baseline. Returns
   the x where its longest line ends. */
static int add_name(const Card *card, const char *name, int x, int baseline, int right) {
    const Font *small = &card->picture->layout.axis;
    const uint32_t ink = card->picture->theme->ink;
    if (font_width(&card->row, name) <= right - x) return font_add(card->drawing, &card->row, name, x, baseline, ink);
    const TextLines text = text_lines(small, name, right - x, right - x);
    const int lines = text.count < TEXT_LINES_MAX ? text.count : TEXT_LINES_MAX, pitch = small->pixels * 5 / 4;
    int end = x;
    for (int i = 0; i < lines; i++) {
        const int line = baseline - (lines - 1) * pitch / 2 + i * pitch;
        const int line_end = font_add_fitting(card->drawing, small, text.lines[i], x, line, right - x, ink);
        if (line_end > end) end = line_end;
    }
    return end;
}

static int names_left(const Card *card) { return card->left + card->row.pixels * 3 / 4 + card->row.pixels / 2; }

/* Adds swatch and name; returns the x where the name ends. */
static int add_method(const Card *card, int run, const char *name, int baseline, int right) {
    const bool hollow = card->picture->look.compare == LOOK_OVERLAY && run > 0;
    const int pixels = card->row.glyphs != NULL ? card->row.pixels : (int)(ROW * card->unit) + 4;
    body_draw_swatch(card->picture, run, hollow, card->left, baseline, pixels, card->drawing);
    return add_name(card, name, names_left(card), baseline, right);
}

TextLines card_head(const Picture *picture, MomentKind kind) {
    const Card card = caption_panel_begin(picture, NULL);
    char title[CAPTION_TEXT_SIZE];
    caption_title(picture, title);
    const char *text = kind == MOMENT_END && picture->look.end != NULL ? picture->look.end : title;
    return text_lines(&card.head, text, card.right - card.left, card.right - card.left);
}

/* Draws the title and returns the baseline of its last line. */
static int draw_head(const Card *card, MomentKind kind) {
    const TextLines head = card_head(card->picture, kind);
    const int lines = head.count < TEXT_LINES_MAX ? head.count : TEXT_LINES_MAX;
    const bool bare = kind == MOMENT_END && card->picture->look.end_bare;
    const int last = head_baseline(card, lines, bare ? 0 : card->picture->count);
    for (int i = 0; i < lines; i++) {
        const int baseline = last - (int)rint((lines - 1 - i) * HEAD_LINE * card->unit);
        caption_panel_add(card, &card->head, head.lines[i], card->left, baseline, card->right,
                          card->picture->theme->ink);
    }
    return last;
}

/* Whether there is no room for a run's notes beside its name. */
static bool notes_below(const Card *card, const char *name, const char *notes) {
    const int x = names_left(card) + font_width(&card->row, name) + card->row.pixels / 2;
    return font_width(&card->picture->layout.axis, notes) > card->right - x;
}

static void draw_title(const Card *card) {
    const Picture *picture = card->picture;
    const Theme *theme = picture->theme;
    char name[CAPTION_TEXT_SIZE], note[CAPTION_TEXT_SIZE], text[4 * CAPTION_TEXT_SIZE];
    const int first = draw_head(card, MOMENT_TITLE);
    snprintf(text, sizeof text, "scene %s, %.3g s", picture->runs[0]->scene,
             (picture->frames - 1) * (double)picture->runs[0]->dt);
    caption_panel_add(card, &card->subhead, text, card->left, first + (int)rint(0.055 * card->unit), card->right,
                      theme->ink_soft);
    for (int run = 0; run < picture->count; run++) {
        int baseline = row_baseline(card, first, run) + (int)rint(0.03 * card->unit);
        caption_method(picture, run, name, note);
        caption_notes(picture, run, note, text, sizeof text);
        const bool below = notes_below(card, name, text);
        if (below) baseline -= (int)rint(NOTES_DROP * card->unit / 2);
        int x = add_method(card, run, name, baseline, card->right) + card->row.pixels / 2;
        if (below) x = names_left(card), baseline += (int)rint(NOTES_DROP * card->unit);
        const bool fits = font_width(&card->cell, text) <= card->right - x;
        caption_panel_add(card, fits ? &card->cell : &picture->layout.axis, text, x, baseline, card->right,
                          theme->ink_soft);
    }
}

/* How bad the verdict of a run is; -1: unknown. */
static int badness(const Trajectory *run) {
    for (int verdict = VERDICT_SETTLES; verdict < VERDICTS; verdict++) {
        const char *name = verdict_name((Verdict)verdict);
        const char after = strncmp(run->verdict, name, strlen(name)) == 0 ? run->verdict[strlen(name)] : 'x';
        if (after == '\0' || after == ' ' || after == ':') return verdict;
    }
    return -1;
}

static bool is_reference(const Picture *picture, int run) {
    return picture->methods[run] != NULL && picture->methods[run]->role == METHOD_REFERENCE;
}

/* The run that the table compares with: the reference; else the first, unless another has a better verdict. What burst
   says nothing of the others. */
static int choose_base(const Picture *picture) {
    int base = 0;
    bool known = true;
    for (int run = 0; run < picture->count; run++) {
        if (is_reference(picture, run)) return run;
        known &= badness(picture->runs[run]) >= 0;
        if (badness(picture->runs[run]) < badness(picture->runs[base])) base = run;
    }
    return known ? base : 0;
}

static CardRow distances_from(const Trajectory *base, const Trajectory *run) {
    const int frames = run->frames < base->frames ? run->frames : base->frames;
    CardRow row = {.frame = -1};
    for (int frame = 0; frame < frames; frame++) {
        row.last = trajectory_distance(base, run, frame);
        row.largest = fmax(row.largest, row.last);
        if (row.frame < 0 && row.last > EVENTS_VISIBLE_DISTANCE) row.frame = frame;
    }
    return row;
}

void card_plan(Picture *picture) {
    picture->card_base = choose_base(picture);
    for (int run = 0; run < picture->count; run++)
        picture->card_rows[run] = distances_from(picture->runs[picture->card_base], picture->runs[run]);
}

static void format_metres(char *text, size_t size, double metres) {
    char number[32];
    caption_distance(number, sizeof number, metres);
    snprintf(text, size, "%s m", number);
}

static void draw_distances(const Card *card, int run, int baseline, const int columns[3]) {
    const uint32_t ink = card->picture->theme->ink;
    const CardRow *row = &card->picture->card_rows[run];
    char text[64];
    format_metres(text, sizeof text, row->last);
    add_right(card, &card->cell, text, columns[0], baseline, ink);
    format_metres(text, sizeof text, row->largest);
    add_right(card, &card->cell, text, columns[1], baseline, ink);
    if (row->frame >= 0)
        snprintf(text, sizeof text, "%.2f s", row->frame * (double)card->picture->runs[0]->dt);
    else
        snprintf(text, sizeof text, "\xE2\x80\x93");
    add_right(card, &card->cell, text, columns[2], baseline, ink);
}

static void draw_end(const Card *card) {
    static const char *const heads[] = {"at the end", "largest", "> 1 mm at"};
    const Picture *picture = card->picture;
    const Theme *theme = picture->theme;
    char title[CAPTION_TEXT_SIZE], note[CAPTION_TEXT_SIZE], text[2 * CAPTION_TEXT_SIZE];
    const int base = picture->card_base;
    const int first = draw_head(card, MOMENT_END), column = (int)rint(0.17 * (card->right - card->left));
    const int columns[3] = {card->right - 2 * column, card->right - column, card->right};
    if (picture->look.end_bare) return;
    caption_method(picture, base, title, note);
    snprintf(text, sizeof text, picture->count > 1 ? "distance from %s" : "%s", title);
    int baseline = first + (int)rint(0.065 * card->unit);
    caption_panel_add(card, &card->cell, text, card->left, baseline, columns[0] - column, theme->ink_soft);
    for (int i = 0; i < 3 && picture->count > 1; i++)
        add_right(card, &card->cell, heads[i], columns[i], baseline, theme->ink_soft);
    draw_rule(card, baseline + (int)rint(0.02 * card->unit));
    for (int run = 0; run < picture->count; run++) {
        baseline = row_baseline(card, first, run) + (int)rint(0.02 * card->unit);
        caption_method(picture, run, title, note);
        add_method(card, run, title, baseline, run != base ? columns[0] - column : card->right);
        if (run != base) draw_distances(card, run, baseline, columns);
    }
}

void card_draw(const Picture *picture, Moment moment, Drawing *drawing) {
    Card card = caption_panel_begin(picture, drawing);
    drawing->static_shapes = 0;
    if (moment.kind == MOMENT_TITLE)
        draw_title(&card);
    else
        draw_end(&card);
}

/* Above a panel. */

enum { OVERLAY_LINES = 6 }; /* with more, an overlay has names only */

/* What a panel does not show; empty: nothing. */
typedef struct State {
    char text[64];
} State;

static State describe_state(const Picture *picture, int panel, Moment moment) {
    const bool ended = moment.frame >= picture->runs[picture_run(picture, panel)]->frames;
    const int unseen = panel_count_out_of_view(picture, panel, moment);
    State state = {""};
    if (unseen > 0)
        snprintf(state.text, sizeof state.text, "%d out of view%s", unseen, ended ? ", ended" : "");
    else if (ended)
        snprintf(state.text, sizeof state.text, "ended");
    return state;
}

static bool is_hollow(const Picture *picture, int run) { return picture->look.compare == LOOK_OVERLAY && run > 0; }

/* Of the swatch and the space after it. */
static int swatch_room(const Picture *picture) {
    const int pixels = picture->layout.title.pixels;
    return pixels * 3 / 4 + pixels / 2;
}

/* Boxes coloured by their distance show their run's colour only in the timeline. */
static int swatch_width(const Picture *picture, int run) {
    const bool none =
        picture_colors_distance(picture, run) && !is_hollow(picture, run) && (picture->look.show & SHOW_TIMELINE) == 0;
    return none ? 0 : swatch_room(picture);
}

static int panel_width(const Picture *picture) {
    return picture->layout.panels[0].right - picture->layout.panels[0].left;
}

static bool has_distance(const Picture *picture, int run) { return run > 0 && !caption_is_pair(picture); }

/* Of a run's distance, with its word, and the space before it. */
static int distance_width(const Picture *picture, int run) {
    const CaptionItem distance = caption_distance_item("distance ", 0);
    const Font *font = &picture->layout.method;
    return has_distance(picture, run) ? caption_item_width(font, &distance) + font->pixels : 0;
}

/* Whether distances have a line of their own, nearest to the panels: beside the name of some run there is no room. */
static bool distances_below(const Picture *picture) {
    if (picture->look.compare == LOOK_OVERLAY) return false;
    for (int panel = 0; panel < picture->panel_count; panel++) {
        const int run = picture_run(picture, panel);
        char name[CAPTION_TEXT_SIZE], note[CAPTION_TEXT_SIZE];
        caption_method(picture, run, name, note);
        if (has_distance(picture, run) &&
            swatch_room(picture) + font_width(&picture->layout.title, name) + distance_width(picture, run) >
                panel_width(picture))
            return true;
    }
    return false;
}

static int distance_beside(const Picture *picture, int run) {
    return distances_below(picture) ? 0 : distance_width(picture, run);
}

int caption_least_width(const Picture *picture, bool whole) {
    const Layout *layout = &picture->layout;
    int least = 0;
    for (int run = 0; run < picture->count; run++) {
        char name[CAPTION_TEXT_SIZE], note[CAPTION_TEXT_SIZE];
        caption_method(picture, run, name, note);
        if (!whole) snprintf(name + method_name_head(name), 4, "\xE2\x80\xA6"); /* an ellipsis */
        const int width = swatch_room(picture) + font_width(whole ? &layout->title : &layout->axis, name) +
                          (whole && has_distance(picture, run) ? font_width(&layout->method, "0.00 m") : 0);
        if (width > least) least = width;
    }
    return least;
}

/* The name of a run, on one line in the larger font, or in the smaller one on as many as it needs. */
typedef struct Name {
    const Font *font;
    TextLines text;
} Name;

static Name lay_out_name(const Picture *picture, int run) {
    const Layout *layout = &picture->layout;
    const int room = panel_width(picture) - swatch_width(picture, run), first = room - distance_beside(picture, run);
    char name[CAPTION_TEXT_SIZE], note[CAPTION_TEXT_SIZE];
    caption_method(picture, run, name, note);
    const TextLines lines = text_lines(&layout->title, name, first, room);
    if (lines.count == 1) return (Name){&layout->title, lines};
    return (Name){&layout->axis, text_lines(&layout->axis, name, first, room)};
}

static void notes_of(const Picture *picture, int run, char text[4 * CAPTION_TEXT_SIZE]) {
    char name[CAPTION_TEXT_SIZE], note[CAPTION_TEXT_SIZE];
    caption_method(picture, run, name, note);
    caption_notes(picture, run, note, text, 4 * CAPTION_TEXT_SIZE);
}

/* From the left of a panel to the end of the first line of a name, and a space. */
static int name_width(const Picture *picture, int run, const Name *name) {
    return swatch_width(picture, run) + font_width(name->font, name->text.lines[0]) + picture->layout.title.pixels / 2;
}

/* Where the notes of all panels are: beside the names or on a line below, in this font; NULL: no panel has notes. */
typedef struct Notes {
    const Font *font;
    bool beside;
} Notes;

/* With room for a swatch, which a page always has. Beside a name, there is also room for a number of bodies out of
   view: nothing depends on the frame, so that no text moves. */
static bool has_room(const Picture *picture, int run, Notes notes) {
    const Layout *layout = &picture->layout;
    const Name name = lay_out_name(picture, run);
    const int swatch = swatch_room(picture), beside = swatch - swatch_width(picture, run) +
                                                      name_width(picture, run, &name) + distance_beside(picture, run) +
                                                      font_width(&layout->method, "00 out of view") +
                                                      layout->title.pixels / 2;
    char text[4 * CAPTION_TEXT_SIZE];
    notes_of(picture, run, text);
    if (text[0] == '\0') return true;
    return (!notes.beside || name.text.count == 1) &&
           font_width(notes.font, text) + (notes.beside ? beside : swatch) <= panel_width(picture);
}

static Notes place_notes(const Picture *picture) {
    const Font *const fonts[] = {&picture->layout.method, &picture->layout.axis};
    for (int i = 0; i < 4; i++) {
        const Notes notes = {fonts[i % 2], i < 2};
        int fit = 0;
        while (fit < picture->panel_count && has_room(picture, picture_run(picture, fit), notes)) fit++;
        if (fit == picture->panel_count) return notes;
    }
    return (Notes){NULL, false};
}

/* Where the runs of an overlay are in the lines above it, from the left; with or without notes. Returns the number of
   lines. */
static int place_runs(const Picture *picture, bool notes, int lefts[RENDER_PANELS_MAX], int lines[RENDER_PANELS_MAX]) {
    const Layout *layout = &picture->layout;
    const int gap = layout->title.pixels / 2;
    int x = 0, line = 0;
    for (int run = 0; run < picture->count; run++) {
        char name[CAPTION_TEXT_SIZE], note[CAPTION_TEXT_SIZE], text[4 * CAPTION_TEXT_SIZE];
        caption_method(picture, run, name, note);
        notes_of(picture, run, text);
        const int width = swatch_width(picture, run) + font_width(&layout->title, name) + distance_width(picture, run) +
                          (notes && text[0] != '\0' ? gap + font_width(&layout->method, text) : 0);
        if (x > 0 && x + width > panel_width(picture)) x = 0, line++;
        lefts[run] = x, lines[run] = line;
        x += width + 3 * gap;
    }
    return line + 1;
}

int caption_lines(const Picture *picture) {
    int most = 1, lefts[RENDER_PANELS_MAX], lines[RENDER_PANELS_MAX];
    if (picture->layout.title.glyphs == NULL) return 1;
    if (picture->look.compare == LOOK_OVERLAY) {
        most = place_runs(picture, true, lefts, lines);
        return most <= OVERLAY_LINES ? most : place_runs(picture, false, lefts, lines);
    }
    const Notes notes = place_notes(picture);
    for (int panel = 0; panel < picture->panel_count; panel++) {
        const int names = lay_out_name(picture, picture_run(picture, panel)).text.count;
        if (names > most) most = names < TEXT_LINES_MAX ? names : TEXT_LINES_MAX;
    }
    return most + (notes.font != NULL && !notes.beside) + distances_below(picture);
}

bool captions_fit(const Picture *picture, Error *error) {
    for (int run = 0; run < picture->count && picture->layout.title.glyphs != NULL; run++) {
        const int lines = lay_out_name(picture, run).text.count;
        if (picture->captions[run] != NULL && lines > TEXT_LINES_MAX)
            return error_input(error, "--caption",
                               "the text needs %d lines in panels of this size, but at most %d fit: %s", lines,
                               TEXT_LINES_MAX, picture->captions[run]);
    }
    return true;
}

static int draw_swatch(const Picture *picture, int run, int x, int baseline, Drawing *drawing) {
    const int width = swatch_width(picture, run);
    if (width > 0)
        body_draw_swatch(picture, run, is_hollow(picture, run), x, baseline, picture->layout.title.pixels, drawing);
    return x + width;
}

static void draw_overlay(const Picture *picture, Moment moment, const Rect *rect, int baseline, Drawing *drawing) {
    const Layout *layout = &picture->layout;
    const int gap = layout->title.pixels / 2;
    int lefts[RENDER_PANELS_MAX], lines[RENDER_PANELS_MAX];
    const bool notes = place_runs(picture, true, lefts, lines) <= OVERLAY_LINES;
    if (!notes) place_runs(picture, false, lefts, lines);
    for (int run = 0; run < picture->count; run++) {
        char name[CAPTION_TEXT_SIZE], note[CAPTION_TEXT_SIZE], text[4 * CAPTION_TEXT_SIZE];
        const int line = baseline + lines[run] * layout->caption_pitch;
        int x = draw_swatch(picture, run, rect->left + lefts[run], line, drawing);
        caption_method(picture, run, name, note);
        notes_of(picture, run, text);
        const int room = rect->right - x - distance_width(picture, run);
        x = caption_name_draw(picture, &layout->title, name, x, line, room, drawing) + gap;
        if (run > 0) {
            const CaptionItem distance = caption_distance_item("distance ", picture_run_distance(picture, run, moment));
            caption_item_draw(picture, &layout->method, &distance, x, line, drawing);
            x += distance_width(picture, run);
        }
        if (notes && font_width(&layout->method, text) <= rect->right - x)
            font_add(drawing, &layout->method, text, x, line, picture->theme->ink_soft);
    }
}

/* In the panel's upper right corner, on its colour: what cannot be seen must be stated. */
static void draw_state_inside(const Picture *picture, const Rect *panel, const char *text, Drawing *drawing) {
    const Font *small = &picture->layout.axis;
    const int inset = small->pixels / 2, width = font_width(small, text), x = panel->right - inset - width;
    const double half_width = width / 2.0 + 2, half_height = small->pixels / 2.0 + 2;
    const Shape ground = {.x = x - 2 + half_width,
                          .y = panel->top + inset + half_height,
                          .half_width = half_width,
                          .half_height = half_height,
                          .cosine = 1,
                          .fill = picture->theme->panel};
    drawing_add_shape(drawing, &ground, panel); /* above the boxes, as shapes are */
    font_add(drawing, small, text, x, panel->top + inset + small->pixels, picture->theme->ink_soft);
}

/* The part of a line that is free. */
typedef struct Line {
    int left, right, baseline;
} Line;

/* At the right of the first line with room. */
static void draw_state(const Picture *picture, int panel, Moment moment, const Line lines[2], Drawing *drawing) {
    const Font *font = &picture->layout.method;
    const State state = describe_state(picture, panel, moment);
    const int width = font_width(font, state.text);
    if (state.text[0] == '\0') return;
    for (int i = 0; i < 2; i++) {
        if (width > lines[i].right - lines[i].left) continue;
        font_add(drawing, font, state.text, lines[i].right - width, lines[i].baseline, picture->theme->ink_soft);
        return;
    }
    draw_state_inside(picture, &picture->layout.panels[panel], state.text, drawing);
}

void caption_panel(const Picture *picture, int panel, Moment moment, Drawing *drawing) {
    const Layout *layout = &picture->layout;
    const Rect *rect = &layout->panels[panel];
    const int run = picture_run(picture, panel), more = (layout->caption_lines - 1) * layout->caption_pitch;
    const int baseline = rect->top - layout->title_rise - more;
    if (layout->title.glyphs == NULL) return;
    if (picture->look.compare == LOOK_OVERLAY) {
        draw_overlay(picture, moment, rect, baseline, drawing);
        return;
    }
    const Notes notes = place_notes(picture);
    const Name name = lay_out_name(picture, run);
    const int x = draw_swatch(picture, run, rect->left, baseline, drawing);
    int last = baseline;
    for (int i = 0; i < name.text.count && i < TEXT_LINES_MAX; i++) {
        last = baseline + i * layout->caption_pitch;
        font_add_fitting(drawing, name.font, name.text.lines[i], x, last, rect->right - x, picture->theme->ink);
    }
    const bool below = distances_below(picture);
    Line beside = {rect->left + name_width(picture, run, &name), rect->right, baseline},
         lowest = {below ? x : rect->right, rect->right, rect->top - layout->title_rise};
    if (notes.font != NULL) {
        char text[4 * CAPTION_TEXT_SIZE];
        notes_of(picture, run, text);
        const int end = font_add(drawing, notes.font, text, notes.beside ? beside.left : x,
                                 notes.beside ? last : last + layout->caption_pitch, picture->theme->ink_soft);
        if (notes.beside) beside.left = end + layout->title.pixels / 2;
    }
    if (has_distance(picture, run)) {
        const CaptionItem item = caption_distance_item("distance ", picture_run_distance(picture, run, moment));
        const int width = caption_item_width(&layout->method, &item);
        if (width <= rect->right - rect->left)
            caption_item_draw(picture, &layout->method, &item, below ? x : rect->right - width,
                              below ? lowest.baseline : baseline, drawing);
        if (below)
            lowest.left += distance_width(picture, run);
        else
            beside.right -= distance_width(picture, run);
    }
    draw_state(picture, panel, moment, (const Line[]){beside, lowest}, drawing);
}
