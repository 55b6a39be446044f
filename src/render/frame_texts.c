/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "render/frame_texts.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static void append(char *text, size_t size, const char *part) {
    size_t used = strlen(text);
    snprintf(text + used, size - used, "%s%s", used == 0 ? "" : " | ", part);
}

static void add(FrameTexts *texts, const char *key, const char *value) {
    texts->entries[texts->count++] = (ImageText){key, value};
}

void frame_part_text(char *text, size_t size, Moment moment) {
    snprintf(text, size, "%d/%d", moment.part, moment.parts);
}

void frame_texts_fill(FrameTexts *texts, const Picture *picture, Moment moment) {
    texts->methods[0] = texts->states[0] = '\0';
    texts->count = 0;
    for (int i = 0; i < picture->count; i++) {
        const Trajectory *run = picture->runs[i];
        char hash[20];
        int shown = picture_run_frame(picture, i, moment.frame);
        snprintf(hash, sizeof hash, "%016" PRIx64, trajectory_frame_hash(run, shown));
        append(texts->methods, sizeof texts->methods, run->method);
        append(texts->states, sizeof texts->states, hash);
    }
    snprintf(texts->frame, sizeof texts->frame, "%d", moment.frame);
    frame_part_text(texts->part, sizeof texts->part, moment);
    add(texts, "Scene", picture->runs[0]->scene);
    add(texts, "Method", texts->methods);
    add(texts, "Frame", texts->frame);
    if (moment.kind == MOMENT_BETWEEN) add(texts, "Part", texts->part);
    if (moment.kind == MOMENT_TITLE) add(texts, "Card", "title");
    if (moment.kind == MOMENT_END) add(texts, "Card", "end");
    add(texts, "State", texts->states);
    add(texts, "Software", "twinbox");
}
