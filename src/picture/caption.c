/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "picture/caption.h"

#include "common/utf8.h"
#include "picture/body.h"
#include "picture/panel.h"
#include "picture/pose.h"

#include <stdio.h>
#include <string.h>

/* The widest distances. All runs have this width: otherwise a body that flies off late would move the text of frame 0. */
static const char LONGEST_DISTANCE[] = "0.00";

typedef struct Item {
    char label[16], number[CAPTION_SIZE], unit[8];
} Item;

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
    else if (metres < 99.95)
        snprintf(text, size, "%.*f", metres < 9.995 ? 2 : 1, metres);
    else if (metres < 999.5)
        snprintf(text, size, "%.0f", metres);
    else
        snprintf(text, size, ">999");
}

static Item distance_item(const char *label, double distance) {
    Item item = {.unit = " m"};
    char text[32];
    snprintf(item.label, sizeof item.label, "%s", label);
    caption_distance(text, sizeof text, distance);
    pad(item.number, sizeof item.number, text, LONGEST_DISTANCE);
    return item;
}

static Item frame_item(const Picture *picture, int frame) {
    Item item = {.label = "frame "};
    char text[32], longest[32];
    snprintf(text, sizeof text, "%d", frame);
    snprintf(longest, sizeof longest, "%d", picture->frames - 1);
    pad(item.number, sizeof item.number, text, longest);
    return item;
}

static Item time_item(const Picture *picture, Moment moment) {
    Item item = {.label = "t = ", .unit = " s"};
    double dt = (double)picture->runs[0]->dt;
    char text[64], longest[64];
    snprintf(text, sizeof text, "%.3f", (moment.frame + moment.fraction) * dt);
    snprintf(longest, sizeof longest, "%.3f", (picture->frames - 1) * dt);
    pad(item.number, sizeof item.number, text, longest);
    return item;
}

static int item_width(const Font *font, const Item *item) {
    return font_width(font, item->label) + font_width(font, item->number) + font_width(font, item->unit);
}

static void draw_item(const Picture *picture, const Font *font, const Item *item, int x, int baseline,
                      Drawing *drawing) {
    const Theme *theme = picture->theme;
    x = font_add(drawing, font, item->label, x, baseline, theme->ink_soft);
    x = font_add(drawing, font, item->number, x, baseline, theme->ink);
    font_add(drawing, font, item->unit, x, baseline, theme->ink_soft);
}

void caption_title(const Picture *picture, char title[CAPTION_SIZE]) {
    snprintf(title, CAPTION_SIZE, "%s", picture->title != NULL ? picture->title : picture->runs[0]->scene);
    for (char *c = title; *c != '\0'; c++)
        if (*c == '_') *c = ' ';
    if (title[0] >= 'a' && title[0] <= 'z') title[0] = (char)(title[0] - 'a' + 'A');
}

/* With two panels side by side, the header shows the only distance. */
static bool is_pair(const Picture *picture) { return picture->count == 2 && picture->panel_count == 2; }

/* Shown during the whole slow motion, also in stored frames: otherwise the text would flicker. */
static void draw_slow(const Picture *picture, Moment moment, int x, int right, Drawing *drawing) {
    const Layout *layout = &picture->layout;
    char text[64];
    if (moment.slow <= 1) return;
    snprintf(text, sizeof text, "slow motion 1/%d, interpolated poses", moment.slow);
    x += layout->status.pixels;
    font_add_fitting(drawing, &layout->status, text, x, layout->header_baseline, right - x, picture->theme->ink_soft);
}

void caption_header(const Picture *picture, Moment moment, Drawing *drawing) {
    const Layout *layout = &picture->layout;
    const Item items[3] = {time_item(picture, moment), frame_item(picture, moment.frame),
                           distance_item("distance ", picture_distance(picture, moment))};
    int count = is_pair(picture) ? 3 : 2, gap = layout->status.pixels * 5 / 4, x = layout->right;
    for (int i = 0; i < count; i++) {
        int left = x - item_width(&layout->status, &items[i]);
        if (left < layout->left) break;
        draw_item(picture, &layout->status, &items[i], left, layout->header_baseline, drawing);
        x = left - gap;
    }
    char title[CAPTION_SIZE];
    caption_title(picture, title);
    int end = font_add_fitting(drawing, &layout->scene, title, layout->left, layout->header_baseline, x - layout->left,
                               picture->theme->ink);
    draw_slow(picture, moment, end, x, drawing);
}

/* What the panel does not show. */
static void describe_state(const Picture *picture, int panel, Moment moment, char *text, size_t size) {
    bool ended = moment.frame >= picture->runs[picture_run(picture, panel)]->frames;
    int unseen = panel_count_out_of_view(picture, panel, moment);
    text[0] = '\0';
    if (unseen > 0)
        snprintf(text, size, "%d out of view%s", unseen, ended ? ", ended" : "");
    else if (ended)
        snprintf(text, size, "ended");
}

/* Boxes coloured by their distance show their run's colour only in the timeline. */
static int draw_swatch(const Picture *picture, int run, int x, int baseline, Drawing *drawing) {
    bool hollow = picture->look.compare == LOOK_OVERLAY && run > 0;
    if (picture_colors_distance(picture, run) && !hollow && (picture->look.show & LOOK_TIMELINE) == 0) return x;
    int pixels = picture->layout.title.pixels;
    return body_draw_swatch(picture, run, hollow, x, baseline, pixels, drawing) + pixels / 2;
}

static int draw_name(const Picture *picture, int run, const char *name, int left, int right, int baseline,
                     Drawing *drawing) {
    int x = draw_swatch(picture, run, left, baseline, drawing);
    return font_add_fitting(drawing, &picture->layout.title, name, x, baseline, right - x, picture->theme->ink);
}

static void draw_notes(const Picture *picture, int run, const char *note, int left, int right, int baseline,
                       Drawing *drawing) {
    char text[4 * CAPTION_SIZE];
    caption_notes(picture, run, note, text, sizeof text);
    font_add_fitting(drawing, &picture->layout.method, text, left, baseline, right - left, picture->theme->ink_soft);
}

/* All runs of an overlay on one line, in columns of equal width. */
static void draw_methods(const Picture *picture, Moment moment, int left, int right, int baseline, Drawing *drawing) {
    const Font *font = &picture->layout.method;
    int gap = picture->layout.title.pixels, width = (right - left + gap) / picture->count;
    for (int run = 0; run < picture->count; run++) {
        char title[CAPTION_SIZE], note[CAPTION_SIZE];
        int start = left + run * width, end = start + width - gap;
        caption_method(picture, run, title, note);
        Item item = distance_item("", picture_run_distance(picture, run, moment));
        int room = run > 0 ? item_width(font, &item) + gap / 2 : 0;
        int x = draw_name(picture, run, title, start, end - room, baseline, drawing) + gap / 2;
        if (run > 0) draw_item(picture, font, &item, x, baseline, drawing);
        if (end - x - room > 4 * font->pixels) draw_notes(picture, run, note, x + room, end, baseline, drawing);
    }
}

void caption_panel(const Picture *picture, int panel, Moment moment, Drawing *drawing) {
    const Layout *layout = &picture->layout;
    if (layout->title.glyphs == NULL) return;
    const Rect *rect = &layout->panels[panel];
    int baseline = rect->top - layout->title_rise, gap = layout->title.pixels / 2, right = rect->right;
    int run = picture_run(picture, panel);
    if (picture->look.compare == LOOK_OVERLAY) {
        draw_methods(picture, moment, rect->left, right, baseline, drawing);
        return;
    }
    char state[CAPTION_SIZE];
    if (run > 0 && !is_pair(picture)) {
        Item item = distance_item("distance ", picture_run_distance(picture, run, moment));
        right -= item_width(&layout->method, &item);
        draw_item(picture, &layout->method, &item, right, baseline, drawing);
        right -= layout->method.pixels;
    }
    describe_state(picture, panel, moment, state, sizeof state);
    right -= font_width(&layout->method, state);
    font_add(drawing, &layout->method, state, right, baseline, picture->theme->ink_soft);
    if (state[0] != '\0') right -= gap;
    char title[CAPTION_SIZE], note[CAPTION_SIZE];
    caption_method(picture, run, title, note);
    int x = draw_name(picture, run, title, rect->left, right, baseline, drawing) + gap;
    draw_notes(picture, run, note, x, right, baseline, drawing);
}
