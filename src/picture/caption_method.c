/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Titles and notes of runs. */
#include "picture/caption.h"

#include <stdio.h>
#include <string.h>

/* Copies a method without the folders of its files, which differ between machines. */
static void shorten_method(char *text, size_t size, const char *method) {
    size_t used = 0;
    while (*method != '\0') {
        size_t length = strcspn(method, ":=,");
        const char *end = method + length, *start = method;
        if (length > 4 && strncmp(end - 4, ".npz", 4) == 0)
            for (const char *c = method; c < end; c++)
                if (*c == '/') start = c + 1;
        if (*end != '\0') end++;
        used += (size_t)snprintf(text + used, size - used, "%.*s", (int)(end - start), start);
        method = end;
    }
}

void caption_method(const Picture *picture, int run, char title[CAPTION_SIZE], char note[CAPTION_SIZE]) {
    const MethodDescription *method = picture->methods[run];
    const char *name = method != NULL ? method->title : NULL, *caption = method != NULL ? method->caption : NULL;
    char text[TRAJECTORY_NAME_SIZE] = "";
    shorten_method(text, sizeof text, picture->runs[run]->method);
    snprintf(title, CAPTION_SIZE, "%s", name != NULL ? name : text);
    snprintf(note, CAPTION_SIZE, "%s%s%s", caption != NULL ? caption : "", caption != NULL && name != NULL ? ", " : "",
             name != NULL ? text : "");
}

/* The last part, the method's settings, is the one that gets cut short. */
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
