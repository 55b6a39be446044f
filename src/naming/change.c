/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "naming/change.h"

#include "common/text_add.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const double SMALL = 0.005;     /* pixels; smaller movements round to 0.00 */
static const double ALONG = 0.25;      /* a movement's smaller part is left out below this share of the larger */
static const double SEEN_TURN = 0.001; /* rad */
static const double DEGREES = 57.29577951308232;

static void add_subject(ChangeText *text, const Change *change) {
    static const char *const names[] = {
        [SUBJECT_HEADER] = "header",         [SUBJECT_CAPTION] = "caption",   [SUBJECT_AXIS] = "axis",
        [SUBJECT_LEGEND] = "legend",         [SUBJECT_TIMELINE] = "timeline", [SUBJECT_MARKS] = "marks",
        [SUBJECT_BACKGROUND] = "background", [SUBJECT_PAGE] = "page"};
    switch (change->subject) {
    case SUBJECT_BODY: text_add(text->text, sizeof text->text, "body %d", change->body); break;
    case SUBJECT_BOMB: text_add(text->text, sizeof text->text, "bomb (body %d)", change->body); break;
    case SUBJECT_FIXED: text_add(text->text, sizeof text->text, "static body %d", change->body); break;
    case SUBJECT_GROUND: text_add(text->text, sizeof text->text, "ground (body %d)", change->body); break;
    case SUBJECT_BODIES:
        text_add(text->text, sizeof text->text, "%d more %s", change->body, change->body == 1 ? "body" : "bodies");
        break;
    case SUBJECT_HEADER:
    case SUBJECT_CAPTION:
    case SUBJECT_AXIS:
    case SUBJECT_LEGEND:
    case SUBJECT_TIMELINE:
    case SUBJECT_MARKS:
    case SUBJECT_BACKGROUND:
    case SUBJECT_PAGE: text_add(text->text, sizeof text->text, "%s", names[change->subject]); break;
    }
    if (change->panel > 0) text_add(text->text, sizeof text->text, " of panel %d", change->panel);
}

static void add_pixels(ChangeText *text, double pixels, const char *positive, const char *negative) {
    double size = fabs(pixels);
    text_add(text->text, sizeof text->text, " %.*f px %s",
             size < 0.1    ? 2
             : size < 9.95 ? 1
                           : 0,
             size, pixels > 0 ? positive : negative);
}

/* " 0.4 px right", " 3 px right and 2 px up"; a movement along one axis has one part. */
static void add_amount(ChangeText *text, const Change *change) {
    double right = fabs(change->right), up = fabs(change->up);
    bool has_right = right >= SMALL && right >= ALONG * up, has_up = up >= SMALL && up >= ALONG * right;
    bool turns = fabs(change->turn) >= SEEN_TURN;
    if (has_right || has_up) text_add(text->text, sizeof text->text, " moved");
    if (has_right) add_pixels(text, change->right, "right", "left");
    if (has_right && has_up) text_add(text->text, sizeof text->text, " and");
    if (has_up) add_pixels(text, change->up, "up", "down");
    if (turns)
        text_add(text->text, sizeof text->text, "%s %.2g degrees", has_right || has_up ? ", turned" : " turned",
                 DEGREES * fabs(change->turn));
    if (!has_right && !has_up && !turns) text_add(text->text, sizeof text->text, " moved less than 0.01 px");
}

ChangeText change_words(const Change *change) {
    ChangeText text = {""};
    add_subject(&text, change);
    switch (change->kind) {
    case CHANGE_OTHER:
        if (change->subject <= SUBJECT_BODIES) text_add(text.text, sizeof text.text, " changed");
        break;
    case CHANGE_MOVED:
        if (change->subject == SUBJECT_BODIES)
            text_add(text.text, sizeof text.text, " moved");
        else
            add_amount(&text, change);
        break;
    case CHANGE_COLOUR: text_add(text.text, sizeof text.text, ": colour"); break;
    case CHANGE_LINE_WIDTH: text_add(text.text, sizeof text.text, ": line width"); break;
    case CHANGE_APPEARED: text_add(text.text, sizeof text.text, " only in the actual run"); break;
    case CHANGE_DISAPPEARED: text_add(text.text, sizeof text.text, " only in the expected run"); break;
    }
    return text;
}

ChangeText change_cause(const Change *change) {
    bool several = change->subject == SUBJECT_BODIES;
    if (change->kind != CHANGE_MOVED && !several) return change_words(change);
    ChangeText text = {""};
    if (several)
        text_add(text.text, sizeof text.text, "other bodies");
    else
        add_subject(&text, change);
    text_add(text.text, sizeof text.text, change->kind == CHANGE_MOVED ? " moved" : " changed");
    return text;
}

ChangeText region_name(const FrameChanges *changes, int region) {
    ChangeText text = {""};
    int change = changes->region_change[region], others = changes->region_others[region];
    if (change < 0) return text;
    text = change_words(&changes->list[change]);
    if (others > 0)
        text_add(text.text, sizeof text.text, ", and %d more %s", others, others == 1 ? "change" : "changes");
    return text;
}

ChangeText region_words(const FrameChanges *changes, int region) {
    ChangeText text = {""};
    const ImageRegion *r = &changes->regions.list[region];
    ChangeText name = region_name(changes, region);
    text_add(text.text, sizeof text.text, "%d x %d pixels at (%d, %d), %" PRId64 " of them %s", r->right - r->left,
             r->bottom - r->top, r->left, r->top, r->pixels, r->pixels == 1 ? "differs" : "differ");
    if (name.text[0] != '\0') text_add(text.text, sizeof text.text, ": %s", name.text);
    return text;
}
