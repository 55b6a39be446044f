/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "picture/caption.h"

#include "picture/caption_item.h"

#include <math.h>
#include <stdio.h>

void caption_title(const Picture *picture, char title[CAPTION_SIZE]) {
    snprintf(title, CAPTION_SIZE, "%s", picture->title != NULL ? picture->title : picture->runs[0]->scene);
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
static void draw_slow(const Picture *picture, Moment moment, int x, int right, Drawing *drawing) {
    const Layout *layout = &picture->layout;
    char text[96];
    if (!describe_speed(moment, text, sizeof text)) return;
    x += layout->status.pixels;
    font_add_fitting(drawing, &layout->status, text, x, layout->header_baseline, right - x, picture->theme->ink_soft);
}

void caption_header(const Picture *picture, Moment moment, Drawing *drawing) {
    const Layout *layout = &picture->layout;
    const CaptionItem items[3] = {caption_time_item(picture, moment), caption_frame_item(picture, moment.frame),
                                  caption_distance_item("distance ", picture_distance(picture, moment))};
    int count = caption_is_pair(picture) ? 3 : 2, gap = layout->status.pixels * 5 / 4, x = layout->right;
    for (int i = 0; i < count; i++) {
        int left = x - caption_item_width(&layout->status, &items[i]);
        if (left < layout->left) break;
        caption_item_draw(picture, &layout->status, &items[i], left, layout->header_baseline, drawing);
        x = left - gap;
    }
    char title[CAPTION_SIZE];
    caption_title(picture, title);
    int end = font_add_fitting(drawing, &layout->scene, title, layout->left, layout->header_baseline, x - layout->left,
                               picture->theme->ink);
    draw_slow(picture, moment, end, x, drawing);
}
