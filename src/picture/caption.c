/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "picture/caption.h"

#include "common/utf8.h"
#include "picture/caption_item.h"

#include <math.h>
#include <stdio.h>

void caption_title(const Picture *picture, char title[CAPTION_SIZE]) {
    const char *text = picture->title != NULL ? picture->title : picture->runs[0]->scene;
    snprintf(title, CAPTION_SIZE, "%.*s", (int)utf8_cut(text, CAPTION_SIZE - 1), text);
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
    char title[CAPTION_SIZE];
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
