/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The line above a panel. */
#include "common/method_look.h"
#include "picture/body.h"
#include "picture/caption_item.h"
#include "picture/panel.h"

#include <stdio.h>

enum { NOTE_EMS = 5 }; /* a description with less room says nothing */

/* What a panel does not show, in full and in short. */
typedef struct State {
    char full[64], brief[64];
} State;

static State describe_state(const Picture *picture, int panel, Moment moment) {
    const bool ended = moment.frame >= picture->runs[picture_run(picture, panel)]->frames;
    const int unseen = panel_count_out_of_view(picture, panel, moment);
    State state = {"", ""};
    if (unseen > 0) {
        snprintf(state.full, sizeof state.full, "%d out of view%s", unseen, ended ? ", ended" : "");
        snprintf(state.brief, sizeof state.brief, "%d out%s", unseen, ended ? ", ended" : "");
    } else if (ended)
        snprintf(state.full, sizeof state.full, "ended"), snprintf(state.brief, sizeof state.brief, "ended");
    return state;
}

static bool is_hollow(const Picture *picture, int run) { return picture->look.compare == LOOK_OVERLAY && run > 0; }

/* The swatch and the space after it. Boxes coloured by their distance show their run's colour only in the timeline. */
static int swatch_width(const Picture *picture, int run) {
    const int pixels = picture->layout.title.pixels;
    const bool none =
        picture_colors_distance(picture, run) && !is_hollow(picture, run) && (picture->look.show & LOOK_TIMELINE) == 0;
    return none ? 0 : pixels * 3 / 4 + pixels / 2;
}

static int name_width(const Picture *picture, int run) {
    char name[CAPTION_SIZE], note[CAPTION_SIZE];
    caption_method(picture, run, name, note);
    return swatch_width(picture, run) + font_width(&picture->layout.title, name);
}

int caption_least_width(const Picture *picture, bool whole) {
    const Layout *layout = &picture->layout;
    const CaptionItem distance = caption_distance_item("", 0);
    int least = 0;
    for (int run = 0; run < picture->count; run++) {
        char name[CAPTION_SIZE], note[CAPTION_SIZE];
        caption_method(picture, run, name, note);
        snprintf(name + method_name_head(name), 4, "\xE2\x80\xA6");
        const int width = whole ? name_width(picture, run) + layout->title.pixels / 2 +
                                      (run > 0 ? caption_item_width(&layout->method, &distance) : 0)
                                : swatch_width(picture, run) + font_width(&layout->axis, name);
        if (width > least) least = width;
    }
    return least;
}

/* Room that a name keeps whatever stands beside it: all that it needs; but of very long settings only a part. */
static int kept_width(const Picture *picture, int run) {
    const Rect *panel = &picture->layout.panels[0];
    const int most = (panel->right - panel->left) * 3 / 5, whole = name_width(picture, run);
    char name[CAPTION_SIZE], note[CAPTION_SIZE];
    caption_method(picture, run, name, note);
    snprintf(name + method_name_head(name), 4, "\xE2\x80\xA6"); /* an ellipsis */
    const int head = swatch_width(picture, run) + font_width(&picture->layout.title, name);
    return whole < most ? whole : most > head ? most : head < whole ? head : whole;
}

/* Swatch and name in at most `room` pixels; returns the x where the name ends. */
static int draw_name(const Picture *picture, int run, int x, int baseline, int room, Drawing *drawing) {
    const Layout *layout = &picture->layout;
    const int swatch = swatch_width(picture, run);
    char name[CAPTION_SIZE], note[CAPTION_SIZE];
    caption_method(picture, run, name, note);
    if (swatch > 0) body_draw_swatch(picture, run, is_hollow(picture, run), x, baseline, layout->title.pixels, drawing);
    return caption_name_draw(picture, &layout->title, name, x + swatch, baseline, room - swatch, drawing);
}

static void notes_of(const Picture *picture, int run, char text[4 * CAPTION_SIZE]) {
    char name[CAPTION_SIZE], note[CAPTION_SIZE];
    caption_method(picture, run, name, note);
    caption_notes(picture, run, note, text, 4 * CAPTION_SIZE);
}

static void draw_notes(const Picture *picture, int run, int left, int right, int baseline, Drawing *drawing) {
    const Font *font = &picture->layout.method;
    char text[4 * CAPTION_SIZE];
    notes_of(picture, run, text);
    if (right - left >= NOTE_EMS * font->pixels || font_width(font, text) <= right - left)
        font_add_fitting(drawing, font, text, left, baseline, right - left, picture->theme->ink_soft);
}

/* How the runs of an overlay share the line above it, in pixels. */
typedef struct Shares {
    int names[RENDER_PANELS_MAX], notes[RENDER_PANELS_MAX]; /* of each run, with the space before */
    int distance;                                           /* of each run but the first; 0: no room for them */
    int spare;                                              /* what is left for each run */
} Shares;

/* Shares room by need: widths that are too large are cut to the same one. Returns what is left. */
static int share(int *widths, int count, int room) {
    const int most = caption_fair_width(widths, count, room > 0 ? room : 0);
    for (int i = 0; i < count; i++) room -= widths[i] = widths[i] < most ? widths[i] : most;
    return room > 0 ? room : 0;
}

/* Names first, then distances, all or none, then descriptions. */
static Shares share_line(const Picture *picture, int room) {
    const Font *font = &picture->layout.method;
    const CaptionItem any = caption_distance_item("", 0);
    const int count = picture->count, gap = picture->layout.title.pixels / 2;
    Shares shares = {.distance = caption_item_width(font, &any) + gap};
    for (int run = 0; run < count; run++) {
        char text[4 * CAPTION_SIZE];
        notes_of(picture, run, text);
        shares.names[run] = name_width(picture, run);
        shares.notes[run] = text[0] != '\0' ? font_width(font, text) + gap : 0;
    }
    int left = share(shares.names, count, room);
    if (left < (count - 1) * shares.distance) shares.distance = 0;
    left = share(shares.notes, count, left - (count - 1) * shares.distance);
    shares.spare = left / count;
    return shares;
}

/* All runs of an overlay on one line. */
static void draw_overlay(const Picture *picture, Moment moment, int left, int right, int baseline, Drawing *drawing) {
    const int between = picture->layout.title.pixels, gap = between / 2;
    const Shares shares = share_line(picture, right - left - (picture->count - 1) * between);
    for (int run = 0, x = left; run < picture->count; run++) {
        draw_name(picture, run, x, baseline, shares.names[run], drawing);
        x += shares.names[run];
        if (run > 0 && shares.distance > 0) {
            const CaptionItem distance = caption_distance_item("", picture_run_distance(picture, run, moment));
            caption_item_draw(picture, &picture->layout.method, &distance, x + gap, baseline, drawing);
            x += shares.distance;
        }
        draw_notes(picture, run, x + gap, x + shares.notes[run], baseline, drawing);
        x += shares.notes[run] + shares.spare + between;
    }
}

static bool has_distance(const Picture *picture, int panel) {
    return picture_run(picture, panel) > 0 && !caption_is_pair(picture);
}

/* "distance " if it fits above every panel, also beside a number of bodies out of view: it must not come and go. */
static const char *distance_label(const Picture *picture) {
    const Layout *layout = &picture->layout;
    const CaptionItem item = caption_distance_item("distance ", 0);
    const int needed = caption_item_width(&layout->method, &item) + font_width(&layout->method, "00 out") +
                       layout->method.pixels + 2 * layout->title.pixels;
    for (int panel = 0; panel < picture->panel_count; panel++)
        if (has_distance(picture, panel) && kept_width(picture, picture_run(picture, panel)) + needed >
                                                layout->panels[0].right - layout->panels[0].left)
            return "";
    return "distance ";
}

/* In the panel's upper right corner, where the line above it has no room: what cannot be seen must be stated. */
static void draw_state_inside(const Picture *picture, const Rect *panel, const char *text, Drawing *drawing) {
    const Font *font = &picture->layout.axis;
    const int inset = font->pixels / 2;
    font_add(drawing, font, text, panel->right - inset - font_width(font, text), panel->top + inset + font->pixels,
             picture->theme->ink_soft);
}

void caption_panel(const Picture *picture, int panel, Moment moment, Drawing *drawing) {
    const Layout *layout = &picture->layout;
    const Rect *rect = &layout->panels[panel];
    const Font *font = &layout->method;
    const int baseline = rect->top - layout->title_rise, gap = layout->title.pixels / 2;
    const int run = picture_run(picture, panel);
    if (layout->title.glyphs == NULL) return;
    if (picture->look.compare == LOOK_OVERLAY) {
        draw_overlay(picture, moment, rect->left, rect->right, baseline, drawing);
        return;
    }
    const int name_end = rect->left + kept_width(picture, run) + gap;
    int right = rect->right;
    if (has_distance(picture, panel)) {
        const CaptionItem item =
            caption_distance_item(distance_label(picture), picture_run_distance(picture, run, moment));
        const int left = right - caption_item_width(font, &item);
        if (left >= name_end) {
            caption_item_draw(picture, font, &item, left, baseline, drawing);
            right = left - font->pixels;
        }
    }
    const State state = describe_state(picture, panel, moment);
    const char *text = font_width(font, state.full) <= right - name_end ? state.full : state.brief;
    if (font_width(font, text) <= right - name_end && text[0] != '\0') {
        right -= font_width(font, text);
        font_add(drawing, font, text, right, baseline, picture->theme->ink_soft);
        right -= gap;
    } else if (text[0] != '\0')
        draw_state_inside(picture, rect, text, drawing);
    const int end = draw_name(picture, run, rect->left, baseline, right - rect->left, drawing);
    draw_notes(picture, run, end + gap, right, baseline, drawing);
}
