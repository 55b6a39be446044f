/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Names and notes of runs. */
#include "picture/caption.h"

#include "common/method_look.h"

#include <stdio.h>
#include <string.h>

void caption_method(const Picture *picture, int run, char name[CAPTION_SIZE], char note[CAPTION_SIZE]) {
    const MethodDescription *method = picture->methods[run];
    const char *caption = picture->captions[run];
    if (caption != NULL && caption[0] != '\0') {
        snprintf(name, CAPTION_SIZE, "%s", caption);
        note[0] = '\0';
        return;
    }
    method_name(name, CAPTION_SIZE, picture->runs[run]->method);
    snprintf(note, CAPTION_SIZE, "%s", method != NULL && method->caption != NULL ? method->caption : "");
}

/* The last part, the method's description, is the one that gets cut short. */
static void join(char *text, size_t size, const char *part) {
    size_t used = strlen(text);
    if (part != NULL && part[0] != '\0') snprintf(text + used, size - used, "%s%s", used > 0 ? "; " : "", part);
}

void caption_notes(const Picture *picture, int run, const char *note, char *text, size_t size) {
    text[0] = '\0';
    join(text, size, picture->notes[run]);
    join(text, size, picture->look.costs[run]);
    join(text, size, note);
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
