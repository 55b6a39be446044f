/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "render/caption.h"

#include "render/panel.h"
#include "render/style.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { TEXT_SIZE = 256 };
static const double FAR_APART = 1000.0; /* m; beyond it the figures say no more */

typedef struct Item {
    char label[16], number[TEXT_SIZE], unit[8];
} Item;

/* Pads a number on the left to the width that the longest of the run will take. */
static void pad(char *number, size_t size, const char *text, const char *longest) {
    size_t used = 0;
    for (size_t i = strlen(text); i < strlen(longest); i++)
        used += (size_t)snprintf(number + used, size - used, "%s", FIGURE_SPACE);
    snprintf(number + used, size - used, "%s", text);
}

static void format_apart(char *text, size_t size, double apart) {
    if (isnan(apart))
        snprintf(text, size, "\xE2\x80\x93");
    else if (apart < FAR_APART)
        snprintf(text, size, "%.2f", apart);
    else
        snprintf(text, size, ">%.0f", FAR_APART);
}

static Item apart_item(const Picture *picture, int frame) {
    Item item = {.label = "apart ", .unit = " m"};
    char text[32], longest[32];
    format_apart(text, sizeof text, picture_apart(picture, frame));
    format_apart(longest, sizeof longest, picture->largest_apart);
    pad(item.number, sizeof item.number, text, longest);
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

static Item time_item(const Picture *picture, int frame) {
    Item item = {.label = "t = ", .unit = " s"};
    double dt = (double)picture->panels[0]->dt;
    char text[64], longest[64];
    snprintf(text, sizeof text, "%.3f", frame * dt);
    snprintf(longest, sizeof longest, "%.3f", (picture->frames - 1) * dt);
    pad(item.number, sizeof item.number, text, longest);
    return item;
}

static int item_width(const Font *font, const Item *item) {
    return font_width(font, item->label) + font_width(font, item->number) + font_width(font, item->unit);
}

static void draw_item(const Layout *layout, const Item *item, int x, Drawing *drawing) {
    x = font_add(drawing, &layout->status, item->label, x, layout->header_baseline, INK_SOFT);
    x = font_add(drawing, &layout->status, item->number, x, layout->header_baseline, INK);
    font_add(drawing, &layout->status, item->unit, x, layout->header_baseline, INK_SOFT);
}

/* "pyramid_settled" -> "Pyramid settled" */
static void scene_title(char *title, size_t size, const char *scene) {
    snprintf(title, size, "%s", scene);
    for (char *c = title; *c != '\0'; c++)
        if (*c == '_') *c = ' ';
    if (title[0] >= 'a' && title[0] <= 'z') title[0] = (char)(title[0] - 'a' + 'A');
}

void caption_header(const Picture *picture, int frame, Drawing *drawing) {
    const Layout *layout = &picture->layout;
    Item items[3] = {time_item(picture, frame), frame_item(picture, frame), apart_item(picture, frame)};
    int count = picture->count > 1 ? 3 : 2, gap = layout->status.pixels * 5 / 4, x = layout->right;
    for (int i = 0; i < count; i++) {
        int left = x - item_width(&layout->status, &items[i]);
        if (left < layout->left) break;
        draw_item(layout, &items[i], left, drawing);
        x = left - gap;
    }
    char title[TEXT_SIZE];
    scene_title(title, sizeof title, picture->title != NULL ? picture->title : picture->panels[0]->scene);
    font_add_fitting(drawing, &layout->scene, title, layout->left, layout->header_baseline, x - layout->left, INK);
}

static bool is_method(const char *text, const char *name) {
    size_t length = strlen(name);
    return strncmp(text, name, length) == 0 && (text[length] == '\0' || text[length] == ':');
}

/* Copies a method without the folders of its files: they belong to a machine and not to a picture. */
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

static void describe(const char *method, const char **title, char *note, size_t size) {
    char text[TRAJECTORY_NAME_SIZE] = "";
    shorten_method(text, sizeof text, method);
    *title = NULL;
    if (is_method(method, "engine")) {
        *title = "Physics engine";
        snprintf(note, size, "sequential impulses, %s", text);
    } else {
        if (is_method(method, "reference")) *title = "Converged solution";
        if (is_method(method, "pair-net")) *title = "Neural network";
        if (is_method(method, "scene-net")) *title = "Network of the scene";
        snprintf(note, size, "%s", text);
    }
}

/* What the bodies do not show. */
static void describe_state(const Picture *picture, int panel, int frame, char *text, size_t size) {
    bool ended = frame >= picture->panels[panel]->frames;
    int unseen = panel_count_unseen(picture, panel, frame);
    text[0] = '\0';
    if (unseen > 0)
        snprintf(text, size, "%d out of view%s", unseen, ended ? ", ended" : "");
    else if (ended)
        snprintf(text, size, "ended");
}

/* The note comes first: what is cut short is the method's settings. */
static void add_note(char *text, size_t size, const char *note, const char *method) {
    bool both = note != NULL && method[0] != '\0';
    snprintf(text, size, "%s%s%s", note != NULL ? note : "", both ? "; " : "", method);
}

void caption_panel(const Picture *picture, int panel, int frame, Drawing *drawing) {
    const Layout *layout = &picture->layout;
    if (layout->title.glyphs == NULL) return;
    const Trajectory *trajectory = picture->panels[panel];
    const Rect *rect = &layout->panels[panel];
    int baseline = rect->top - layout->title_rise, gap = layout->title.pixels / 2;
    const char *title;
    char note[TEXT_SIZE];
    describe_state(picture, panel, frame, note, sizeof note);
    int right = rect->right - font_width(&layout->method, note);
    font_add(drawing, &layout->method, note, right, baseline, INK_SOFT);
    if (note[0] != '\0') right -= gap;
    describe(trajectory->method, &title, note, sizeof note);
    int x = panel_draw_swatch(picture, panel, rect->left, baseline, drawing) + gap;
    x = font_add_fitting(drawing, &layout->title, title != NULL ? title : note, x, baseline, right - x, INK) + gap;
    if (title == NULL) note[0] = '\0';
    char text[2 * TEXT_SIZE];
    add_note(text, sizeof text, picture->notes[panel], note);
    font_add_fitting(drawing, &layout->method, text, x, baseline, right - x, INK_SOFT);
}
