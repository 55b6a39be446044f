/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Texts of a picture: numbers, names, lines, the header. */
#include "base/base.h"
#include "methods/methods.h"
#include "methods/names.h"
#include "pictures/pictures_internal.h"
#include "pictures/picture.h"
#include "pixels/gl.h"
#include "pixels/type.h"

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

static size_t count_characters(const char *text) {
    size_t count = 0;
    for (; *text != '\0'; count++) utf8_next(&text);
    return count;
}

/* Pads a number on the left to the width of the longest one, so that text does not move between frames. */
static void pad(char *number, size_t size, const char *text, const char *longest) {
    size_t used = 0;
    for (size_t i = count_characters(text); i < count_characters(longest); i++)
        used += (size_t)snprintf(number + used, size - used, "%s", FIGURE_SPACE);
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

CaptionItem caption_distance_item(const char *label, double metres) {
    CaptionItem item = {.unit = " m"};
    char text[32];
    snprintf(item.label, sizeof item.label, "%s", label);
    caption_distance(text, sizeof text, metres);
    pad(item.number, sizeof item.number, text, LONGEST_DISTANCE);
    return item;
}

static CaptionItem caption_frame_item(const Picture *picture, int frame) {
    CaptionItem item = {.label = "frame "};
    char text[32], longest[32];
    snprintf(text, sizeof text, "%d", frame);
    snprintf(longest, sizeof longest, "%d", picture->frames - 1);
    pad(item.number, sizeof item.number, text, longest);
    return item;
}

static CaptionItem caption_time_item(const Picture *picture, Moment moment) {
    CaptionItem item = {.label = "t = ", .unit = " s"};
    double dt = (double)picture->runs[0]->dt;
    char text[64], longest[64];
    snprintf(text, sizeof text, "%.3f", (moment.frame + moment_fraction(moment)) * dt);
    snprintf(longest, sizeof longest, "%.3f", (picture->frames - 1) * dt);
    pad(item.number, sizeof item.number, text, longest);
    return item;
}

int caption_item_width(const Font *font, const CaptionItem *item) {
    return font_width(font, item->label) + font_width(font, item->number) + font_width(font, item->unit);
}

void caption_item_draw(const Picture *picture, const Font *font, const CaptionItem *item, int x, int baseline,
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
static void caption_join(char *text, size_t size, const char *part) {
    if (part != NULL && part[0] != '\0') text_join(text, size, "; ", "%s", part);
}

void caption_notes(const Picture *picture, int run, const char *note, char *text, size_t size) {
    text[0] = '\0';
    caption_join(text, size, picture->notes[run]);
    caption_join(text, size, picture->look.costs[run]);
    caption_join(text, size, note);
}

int caption_name_draw(const Picture *picture, const Font *font, const char *name, int x, int baseline, int room,
                      Drawing *drawing) {
    const Font *fitting = font_width(font, name) <= room ? font : &picture->layout.axis;
    return font_add_fitting(drawing, fitting, name, x, baseline, room, picture->theme->ink);
}

static int sum_up_to(const int *widths, int count, int most) {
    int sum = 0;
    for (int i = 0; i < count; i++) sum += widths[i] < most ? widths[i] : most;
    return sum;
}

int caption_fair_width(const int *widths, int count, int room) {
    int most = room;
    while (most > 0 && sum_up_to(widths, count, most) > room) most--;
    return most;
}

/* Bytes of the first `length` of a text without the spaces at their end. */
static size_t without_spaces(const char *text, size_t length) {
    while (length > 0 && text[length - 1] == ' ') length--;
    return length;
}

static bool caption_fits(const Font *font, const char *text, size_t length, int room) {
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
        if (!caption_fits(font, text, without_spaces(text, length), room)) break;
        characters = length;
        if (*next == ' ' || *next == '\0' || next[-1] == ':' || next[-1] == ',') words = length;
    }
    if (words > 0 || characters > 0) return words > 0 ? words : characters;
    const char *next = text;
    type_next_code(&next);
    return (size_t)(next - text);
}

/* If no word fits beside the numbers, the text begins below them. */
static bool begins_below(const Font *font, const char *text, int first, int others) {
    const size_t word = strcspn(text, " :,");
    return !caption_fits(font, text, word, first) && first < others && caption_fits(font, text, word, others);
}

TextLines text_lines(const Font *font, const char *text, int first, int others) {
    TextLines result = {.count = begins_below(font, text, first, others)};
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

bool caption_is_pair(const Picture *picture) { return picture->count == 2 && picture->panel_count == 2; }

/* "slow motion 1/4, interpolated poses"; false in real time without interpolation. A film of a given length may differ
   from real time by half a picture. */
static bool describe_speed(Moment moment, char *text, size_t size) {
    const double least = 0.01;
    char speed[48] = "";
    if (moment.slow > 1 + least)
        snprintf(speed, sizeof speed, moment.slow == rint(moment.slow) ? "slow motion 1/%.3g" : "%.3g times slower",
                 moment.slow);
    if (moment.slow < 1 - least) snprintf(speed, sizeof speed, "%.3g times faster", 1 / moment.slow);
    snprintf(text, size, "%s%s%s", speed, speed[0] != '\0' && moment.parts > 1 ? ", " : "",
             moment.parts > 1 ? "interpolated poses" : "");
    return text[0] != '\0';
}

/* Shown during the whole slow motion, also in stored frames: otherwise the text would flicker. */
static void draw_slow(const Picture *picture, Moment moment, int x, int right, int baseline, Drawing *drawing) {
    const Layout *layout = &picture->layout;
    char text[96];
    if (!describe_speed(moment, text, sizeof text)) return;
    x += layout->status.pixels;
    font_add_fitting(drawing, &layout->status, text, x, baseline, right - x, picture->theme->ink_soft);
}

enum { HEADER_ITEMS = 3 };

typedef struct HeaderItems {
    int count, left; /* of the items with room; x where they begin, with a gap before */
    int lefts[HEADER_ITEMS];
    CaptionItem items[HEADER_ITEMS];
} HeaderItems;

static HeaderItems header_items(const Picture *picture, Moment moment) {
    const Layout *layout = &picture->layout;
    HeaderItems header = {.left = layout->right,
                          .items = {caption_time_item(picture, moment), caption_frame_item(picture, moment.frame),
                                    caption_distance_item("distance ", picture_distance(picture, moment))}};
    const int count = caption_is_pair(picture) ? HEADER_ITEMS : HEADER_ITEMS - 1, gap = layout->status.pixels * 5 / 4;
    for (int i = 0; i < count; i++) {
        const int left = header.left - caption_item_width(&layout->status, &header.items[i]);
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
        caption_item_draw(picture, &layout->status, &header.items[i], header.lefts[i], layout->header_baseline,
                          drawing);
    const TextLines title = caption_header_title(picture);
    int baseline = layout->header_baseline, right = header.left, end = layout->left;
    for (int i = 0; i < layout->header_lines; i++) {
        if (i > 0) baseline += layout->header_pitch, right = layout->right;
        end = font_add_fitting(drawing, &layout->scene, title.lines[i], layout->left, baseline, right - layout->left,
                               picture->theme->ink);
    }
    draw_slow(picture, moment, end, right, baseline, drawing);
}
