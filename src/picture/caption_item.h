/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers with a label and a unit in captions. */
#pragma once
#include "picture/caption.h"

typedef struct CaptionItem {
    char label[16], number[CAPTION_SIZE], unit[8];
} CaptionItem;

/* Numbers have the width of the longest one of the sequence, so that text does not move between frames. */
CaptionItem caption_distance_item(const char *label, double metres);
CaptionItem caption_frame_item(const Picture *picture, int frame);
CaptionItem caption_time_item(const Picture *picture, Moment moment);

int caption_item_width(const Font *font, const CaptionItem *item);
void caption_item_draw(const Picture *picture, const Font *font, const CaptionItem *item, int x, int baseline,
                       Drawing *drawing);
