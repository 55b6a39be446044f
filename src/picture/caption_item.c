/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "picture/caption_item.h"

#include "common/utf8.h"

#include <math.h>
#include <stdio.h>

/* The widest distances. All runs have this width: otherwise a body that flies off late would move the text of frame 0. */
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
    else if (metres < 99.95)
        snprintf(text, size, "%.*f", metres < 9.995 ? 2 : 1, metres);
    else if (metres < 999.5)
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

CaptionItem caption_frame_item(const Picture *picture, int frame) {
    CaptionItem item = {.label = "frame "};
    char text[32], longest[32];
    snprintf(text, sizeof text, "%d", frame);
    snprintf(longest, sizeof longest, "%d", picture->frames - 1);
    pad(item.number, sizeof item.number, text, longest);
    return item;
}

CaptionItem caption_time_item(const Picture *picture, Moment moment) {
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
