/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Texts of a picture: numbers, names, lines, the header, and the lines above a panel. */
#include "base/base.h"
#include "base/numbers.h"
#include "methods/methods.h"
#include "methods/names.h"
#include "pictures/pictures_internal.h"
#include "pictures/picture.h"
#include "pixels/gl.h"
#include "pixels/type.h"
#include "runs/compare_runs.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

bool caption_check(const char *text, const char *where, Error *error) {
    if (text != NULL && strlen(text) >= CAPTION_TEXT_SIZE)
        return error_input(error, where, "the text has %zu bytes, but at most %d are allowed", strlen(text),
                           CAPTION_TEXT_SIZE - 1);
    return type_check(text, where, error);
}

/* The widest distances. All runs have this width: otherwise a body that flies off late would move the text of frame
   0. */
static const char LONGEST_DISTANCE[] = "0.00";

/* Pads a number on the left to the width of the longest one, so that text does not move between frames. */
static void pad(char *number, size_t size, const char *text, const char *longest) {
    size_t used = 0;
    int missing = 0;
    for (const char *at = longest; *at != '\0'; missing++) utf8_next(&at);
    for (const char *at = text; *at != '\0'; missing--) utf8_next(&at);
    for (; missing > 0; missing--) used += (size_t)snprintf(number + used, size - used, "%s", FIGURE_SPACE);
    snprintf(number + used, size - used, "%s", text);
}

void caption_distance(char *text, size_t size, double metres) {
    if (isnan(metres))
        snprintf(text, size, "\xE2\x80\x93");
    else if (metres < DISTANCE_ONE_PLACE)
        snprintf(text, size, "%.*f", metres < DISTANCE_TWO_PLACES ? 2 : 1, metres);
    else if (metres < DISTANCE_MOST)
        snprintf(text, size, "%.0f", metres);
    else
        snprintf(text, size, ">999");
}

/* Numbers have the width of the longest one of the sequence, so that text does not move between frames. */
static CaptionItem distance_item(const char *label, double metres) {
    CaptionItem item = {.unit = " m"};
    char text[32];
    snprintf(item.label, sizeof item.label, "%s", label);
    caption_distance(text, sizeof text, metres);
    pad(item.number, sizeof item.number, text, LONGEST_DISTANCE);
    return item;
}

static int item_width(const Font *font, const CaptionItem *item) {
    return font_width(font, item->label) + font_width(font, item->number) + font_width(font, item->unit);
}

static void draw_item(const Picture *picture, const Font *font, const CaptionItem *item, int x, int baseline,
                      Drawing *drawing) {
    const Theme *theme = picture->theme;
    x = font_add(drawing, font, item->label, x, baseline, theme->ink_soft);
    x = font_add(drawing, font, item->number, x, baseline, theme->ink);
    font_add(drawing, font, item->unit, x, baseline, theme->ink_soft);
}

/* Names and notes of runs. */

void caption_method(const Picture *picture, int run, char name[CAPTION_TEXT_SIZE], char note[CAPTION_TEXT_SIZE]) {
    const MethodDescription *method = picture->methods[run];
    const char *caption = picture->captions[run];
    if (caption != NULL && caption[0] != '\0') {
        snprintf(name, CAPTION_TEXT_SIZE, "%s", caption);
        note[0] = '\0';
        return;
    }
    const char *methods[RENDER_PANELS_MAX];
    for (int i = 0; i < picture->count; i++) methods[i] = picture->runs[i]->method;
    method_name_among(name, CAPTION_TEXT_SIZE, methods, picture->count, run);
    const char *what = method != NULL && method->caption != NULL ? method->caption : "";
    const char *program = picture->runs[run]->program; /* "external solver: sweeps 1" */
    snprintf(note, CAPTION_TEXT_SIZE, "%s%s%s", what, what[0] != '\0' && program[0] != '\0' ? ": " : "", program);
}

/* The last part, the method's description, is the one that gets cut short. */
void caption_notes(const Picture *picture, int run, const char *note, char *text, size_t size) {
    const char *const parts[] = {picture->notes[run], picture->look.costs[run], note};
    text[0] = '\0';
    for (int i = 0; i < 3; i++)
        if (parts[i] != NULL && parts[i][0] != '\0') text_join(text, size, "; ", "%s", parts[i]);
}

int caption_name_draw(const Picture *picture, const Font *font, const char *name, int x, int baseline, int room,
                      Drawing *drawing) {
    const Font *fitting = font_width(font, name) <= room ? font : &picture->layout.axis;
    return font_add_fitting(drawing, fitting, name, x, baseline, room, picture->theme->ink);
}

int caption_fair_width(const int *widths, int count, int room) {
    for (int most = room; most > 0; most--) {
        int sum = 0;
        for (int i = 0; i < count; i++) sum += int_min(widths[i], most);
        if (sum <= room) return most;
    }
    return int_min(room, 0);
}

/* Bytes of the first `length` of a text without the spaces at their end. */
static size_t without_spaces(const char *text, size_t length) {
    while (length > 0 && text[length - 1] == ' ') length--;
    return length;
}

static bool fits(const Font *font, const char *text, size_t length, int room) {
    char line[CAPTION_TEXT_SIZE];
    snprintf(line, sizeof line, "%.*s", (int)length, text);
    return font_width(font, line) <= room;
}

/* Bytes of the first line: whole words and settings, or what fits of the first word, but at least one character. */
static size_t line_length(const Font *font, const char *text, int room) {
    size_t words = 0, characters = 0;
    for (const char *next = text; *next != '\0';) {
        type_next_code(&next);
        const size_t length = (size_t)(next - text);
        if (!fits(font, text, without_spaces(text, length), room)) break;
        characters = length;
        if (*next == ' ' || *next == '\0' || next[-1] == ':' || next[-1] == ',') words = length;
    }
    if (words > 0 || characters > 0) return words > 0 ? words : characters;
    const char *next = text;
    type_next_code(&next);
    return (size_t)(next - text);
}

/* If no word fits beside the numbers of the first line, the text begins below them. */
TextLines text_lines(const Font *font, const char *text, int first, int others) {
    const size_t word = strcspn(text, " :,");
    TextLines result = {.count = !fits(font, text, word, first) && first < others && fits(font, text, word, others)};
    do {
        const size_t length = line_length(font, text, result.count == 0 ? first : others);
        const bool last = result.count >= TEXT_LINES_MAX - 1;
        if (result.count < TEXT_LINES_MAX)
            snprintf(result.lines[result.count], CAPTION_TEXT_SIZE, "%.*s",
                     (int)(last ? strlen(text) : without_spaces(text, length)), text);
        result.count++;
        text += length;
        while (*text == ' ') text++;
    } while (*text != '\0');
    return result;
}

void caption_title(const Picture *picture, char title[CAPTION_TEXT_SIZE]) {
    const char *text = picture->title != NULL ? picture->title : picture->runs[0]->scene;
    snprintf(title, CAPTION_TEXT_SIZE, "%.*s", (int)utf8_cut(text, CAPTION_TEXT_SIZE - 1), text);
    for (char *c = title; *c != '\0'; c++)
        if (*c == '_') *c = ' ';
    if (title[0] >= 'a' && title[0] <= 'z') title[0] = (char)(title[0] - 'a' + 'A');
}

/* Two panels side by side: the header shows their distance, the only one. */
static bool is_pair(const Picture *picture) { return picture->count == 2 && picture->panel_count == 2; }

enum { HEADER_ITEMS = 3 };

typedef struct HeaderItems {
    int count, left; /* of the items with room; x where they begin, with a gap before */
    int lefts[HEADER_ITEMS];
    CaptionItem items[HEADER_ITEMS];
} HeaderItems;

static HeaderItems header_items(const Picture *picture, Moment moment) {
    const Layout *layout = &picture->layout;
    const double dt = (double)picture->runs[0]->dt;
    HeaderItems header = {.left = layout->right,
                          .items = {{.label = "t = ", .unit = " s"},
                                    {.label = "frame "},
                                    distance_item("distance ", picture_distance(picture, moment))}};
    char text[64], longest[64];
    snprintf(text, sizeof text, "%.3f", (moment.frame + moment_fraction(moment)) * dt);
    snprintf(longest, sizeof longest, "%.3f", (picture->frames - 1) * dt);
    pad(header.items[0].number, sizeof header.items[0].number, text, longest);
    snprintf(text, sizeof text, "%d", moment.frame);
    snprintf(longest, sizeof longest, "%d", picture->frames - 1);
    pad(header.items[1].number, sizeof header.items[1].number, text, longest);

    const int count = is_pair(picture) ? HEADER_ITEMS : HEADER_ITEMS - 1, gap = layout->status.pixels * 5 / 4;
    for (int i = 0; i < count; i++) {
        const int left = header.left - item_width(&layout->status, &header.items[i]);
        if (left < layout->left) break;
        header.lefts[header.count++] = left;
        header.left = left - gap;
    }
    return header;
}

/* All frames have items of equal width. */
TextLines caption_header_title(const Picture *picture) {
    const Layout *layout = &picture->layout;
    const HeaderItems header = header_items(picture, moment_stored(0));
    char title[CAPTION_TEXT_SIZE];
    caption_title(picture, title);
    return text_lines(&layout->scene, title, header.left - layout->left, layout->right - layout->left);
}

void caption_header(const Picture *picture, Moment moment, Drawing *drawing) {
    const Layout *layout = &picture->layout;
    if (layout->scene.glyphs == NULL) return;
    const HeaderItems header = header_items(picture, moment);
    for (int i = 0; i < header.count; i++)
        draw_item(picture, &layout->status, &header.items[i], header.lefts[i], layout->header_baseline, drawing);
    const TextLines title = caption_header_title(picture);
    int baseline = layout->header_baseline, right = header.left, end = layout->left;
    for (int i = 0; i < layout->header_lines; i++) {
        if (i > 0) baseline += layout->header_pitch, right = layout->right;
        end = font_add_fitting(drawing, &layout->scene, title.lines[i], layout->left, baseline, right - layout->left,
                               picture->theme->ink);
    }

    /* "slow motion 1/4, interpolated poses": during the whole slow motion, also in stored frames, or the text would
       flicker. A film of a given length may differ from real time by half a picture. */
    const double least = 0.01;
    char speed[48] = "", text[96];
    if (moment.slow > 1 + least)
        snprintf(speed, sizeof speed, moment.slow == rint(moment.slow) ? "slow motion 1/%.3g" : "%.3g times slower",
                 moment.slow);
    if (moment.slow < 1 - least) snprintf(speed, sizeof speed, "%.3g times faster", 1 / moment.slow);
    snprintf(text, sizeof text, "%s%s%s", speed, speed[0] != '\0' && moment.parts > 1 ? ", " : "",
             moment.parts > 1 ? "interpolated poses" : "");
    end += layout->status.pixels;
    font_add_fitting(drawing, &layout->status, text, end, baseline, right - end, picture->theme->ink_soft);
}

/* Above a panel. */

enum { OVERLAY_LINES = 6 }; /* with more, an overlay has names only */

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

static bool has_distance(const Picture *picture, int run) { return run > 0 && !is_pair(picture); }

/* Of a run's distance, with its word, and the space before it. */
static int distance_width(const Picture *picture, int run) {
    const CaptionItem distance = distance_item("distance ", 0);
    const Font *font = &picture->layout.method;
    return has_distance(picture, run) ? item_width(font, &distance) + font->pixels : 0;
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

/* Whether captions have a line with the number of contacts that are as the reference's. */
static bool counts_modes(const Picture *picture) {
    return picture->mode_base >= 0 && picture->look.compare != LOOK_OVERLAY;
}

static void draw_count(const Picture *picture, int run, Moment moment, int x, int right, int baseline,
                       Drawing *drawing) {
    const Trajectory *own = picture->runs[run], *base = picture->runs[picture->mode_base];
    const Font *font = &picture->layout.method;
    char text[96];
    if (run == picture->mode_base) return;
    const ModeCount count = trajectory_same_modes(own, pose_step(own, moment), base, pose_step(base, moment));
    snprintf(text, sizeof text, "%d of %d contacts as the reference", count.same, count.of);
    if (font_width(font, text) > right - x) font = &picture->layout.axis;
    font_add_fitting(drawing, font, text, x, baseline, right - x, picture->theme->ink_soft);
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
    return most + (notes.font != NULL && !notes.beside) + distances_below(picture) + counts_modes(picture);
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
            const CaptionItem distance = distance_item("distance ", picture_run_distance(picture, run, moment));
            draw_item(picture, &layout->method, &distance, x, line, drawing);
            x += distance_width(picture, run);
        }
        if (notes && font_width(&layout->method, text) <= rect->right - x)
            font_add(drawing, &layout->method, text, x, line, picture->theme->ink_soft);
    }
}

/* The part of a line that is free. */
typedef struct Line {
    int left, right, baseline;
} Line;

/* What a panel does not show must be stated: at the right of the first line with room, or else in the panel's upper
   right corner, on its colour. */
static void draw_state(const Picture *picture, int panel, Moment moment, const Line lines[2], Drawing *drawing) {
    const Font *font = &picture->layout.method, *small = &picture->layout.axis;
    const bool ended = moment.frame >= picture->runs[picture_run(picture, panel)]->frames;
    const int unseen = panel_count_out_of_view(picture, panel, moment);
    char text[64] = "ended";
    if (unseen > 0) snprintf(text, sizeof text, "%d out of view%s", unseen, ended ? ", ended" : "");
    if (unseen == 0 && !ended) return;
    const int wide = font_width(font, text);
    for (int i = 0; i < 2; i++) {
        if (wide > lines[i].right - lines[i].left) continue;
        font_add(drawing, font, text, lines[i].right - wide, lines[i].baseline, picture->theme->ink_soft);
        return;
    }
    const Rect *rect = &picture->layout.panels[panel];
    const int inset = small->pixels / 2, width = font_width(small, text), x = rect->right - inset - width;
    const double half_width = width / 2.0 + 2, half_height = small->pixels / 2.0 + 2;
    const Shape ground = {.x = x - 2 + half_width,
                          .y = rect->top + inset + half_height,
                          .half_width = half_width,
                          .half_height = half_height,
                          .cosine = 1,
                          .fill = picture->theme->panel};
    drawing_add_shape(drawing, &ground, rect); /* above the boxes, as shapes are */
    font_add(drawing, small, text, x, rect->top + inset + small->pixels, picture->theme->ink_soft);
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
    if (counts_modes(picture)) {
        draw_count(picture, run, moment, x, rect->right, lowest.baseline, drawing);
        lowest.baseline -= layout->caption_pitch;
    }
    if (notes.font != NULL) {
        char text[4 * CAPTION_TEXT_SIZE];
        notes_of(picture, run, text);
        const int end = font_add(drawing, notes.font, text, notes.beside ? beside.left : x,
                                 notes.beside ? last : last + layout->caption_pitch, picture->theme->ink_soft);
        if (notes.beside) beside.left = end + layout->title.pixels / 2;
    }
    if (has_distance(picture, run)) {
        const CaptionItem item = distance_item("distance ", picture_run_distance(picture, run, moment));
        const int width = item_width(&layout->method, &item);
        if (width <= rect->right - rect->left)
            draw_item(picture, &layout->method, &item, below ? x : rect->right - width,
                      below ? lowest.baseline : baseline, drawing);
        if (below)
            lowest.left += distance_width(picture, run);
        else
            beside.right -= distance_width(picture, run);
    }
    draw_state(picture, panel, moment, (const Line[]){beside, lowest}, drawing);
}
