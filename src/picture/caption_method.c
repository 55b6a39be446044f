/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Names and notes of runs. */
#include "picture/caption.h"

#include "common/method_look.h"

#include <stdio.h>
#include <string.h>

void caption_method(const Picture *picture, int run, char name[CAPTION_SIZE], char note[CAPTION_SIZE]) {
    const MethodDescription *method = picture->methods[run];
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
