/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "figure/contact_marks.h"

#include "picture/style.h"
#include "sketch/label_place.h"
#include "type/type.h"
#include "trajectory/trajectory_states.h"

#include <math.h>
#include <stdlib.h>

#define NORMAL_RINGS 3.1 /* length of a normal on either side / radius of the point's mark */

static const double min_arrow = 1;     /* mm */
static const double long_arrow = 3;    /* mm; the number is at its tip, else at its point */
static const double crowd = 5;         /* mm; numbers of points nearer than this to each other stand apart from them */
static const double large_share = 0.3; /* impulses above this share of the largest always get a number */

enum { MAX_NUMBERS = 600 };

/* A contact in page coordinates. */
typedef struct ShownContact {
    Point at;
    Vec2 normal, impulse; /* N s, on the body with the higher number */
    double size;          /* magnitude of the impulse */
} ShownContact;

static Vec2 impulse_of(const TrajectoryContact *contact) {
    Vec2 tangent = vec2(contact->normal.y, -contact->normal.x);
    return vec2_add(vec2_scale(contact->normal_impulse, contact->normal),
                    vec2_scale(contact->tangent_impulse, tangent));
}

double impulse_magnitude(const TrajectoryContact *contact) { return vec2_distance(impulse_of(contact), vec2(0, 0)); }

bool contact_is_finite(const TrajectoryContact *contact) {
    Vec2 impulse = impulse_of(contact);
    return isfinite(impulse.x) && isfinite(impulse.y) && isfinite(contact->point.x) && isfinite(contact->point.y);
}

static int by_size(const void *a, const void *b) {
    const ShownContact *p = a, *q = b;
    if (p->size != q->size) return p->size < q->size ? 1 : -1;
    /* a total order, so that every qsort gives the same result */
    if (p->at.y != q->at.y) return p->at.y < q->at.y ? 1 : -1;
    return (p->at.x > q->at.x) - (p->at.x < q->at.x);
}

/* The contacts inside the cell, largest impulse first. NULL if out of memory. */
static ShownContact *gather(const Trajectory *run, int step, const View *view, int *count) {
    int64_t first = run->contact_start[step], end = run->contact_start[step + 1];
    ShownContact *shown = malloc((size_t)(end - first + 1) * sizeof *shown);
    *count = 0;
    for (int64_t i = first; shown != NULL && i < end; i++) {
        const TrajectoryContact *contact = &run->contacts[i];
        Point at = view_place(view, contact->point);
        if (!contact_is_finite(contact) || at.x < view->low.x || at.x > view->high.x || at.y < view->low.y ||
            at.y > view->high.y)
            continue;
        Vec2 impulse = impulse_of(contact);
        shown[(*count)++] = (ShownContact){at, contact->normal, impulse, impulse_magnitude(contact)};
    }
    if (shown != NULL) qsort(shown, (size_t)*count, sizeof *shown, by_size);
    return shown;
}

static Point arrow_tip(const ContactLook *look, const ShownContact *contact) {
    return (Point){contact->at.x + look->arrow_scale * (double)contact->impulse.x,
                   contact->at.y + look->arrow_scale * (double)contact->impulse.y};
}

/* The point and its normal, `normal` long on either side. */
static void draw_contact_point(Sketch *sketch, Point at, Point normal, double ring) {
    const Pen circle = {0xFFFFFF, 1, ACCENT, 1.4, NULL}, thin = pen_line(INK_SOFT, 1.3, NULL);
    sketch_line(sketch, (Point){at.x - normal.x, at.y - normal.y}, (Point){at.x + normal.x, at.y + normal.y}, &thin);
    sketch_dot(sketch, at, ring, &circle);
}

void draw_contact_sample(Sketch *sketch, Point at, const ContactLook *look) {
    const double reach = NORMAL_RINGS * look->ring;
    draw_contact_point(sketch, at, (Point){reach, 0}, look->ring);
    sketch_text(sketch, (Point){at.x + reach + 1, at.y},
                &(TextStyle){CONTACT_TYPE * look->points, TEXT_LEFT, INK, 0, false}, "contact, normal");
}

static void draw_contact(const ContactLook *look, Sketch *sketch, const ShownContact *contact, LabelField *field) {
    const Point at = contact->at, tip = arrow_tip(look, contact);
    const double ring = look->ring, x = NORMAL_RINGS * ring * (double)contact->normal.x,
                 y = NORMAL_RINGS * ring * (double)contact->normal.y;
    draw_contact_point(sketch, at, (Point){x, y}, ring);
    label_add_box(field, (PageBox){at.x - ring, at.y - ring, at.x + ring, at.y + ring});
    label_add_segment(field, (Segment){at.x - x, at.y - y, at.x + x, at.y + y});
    if (contact->size * look->arrow_scale < min_arrow) return;
    sketch_arrow(sketch, at, tip, HEAD_AT_END, ACCENT, 2.4);
    label_add_segment(field, (Segment){at.x, at.y, tip.x, tip.y});
}

/* Three significant digits, or "0". */
static void format_number(char text[32], double value) {
    if (value < 0.005) {
        snprintf(text, 32, "0");
        return;
    }
    int decimals = value >= 99.95 ? 0 : value >= 9.995 ? 1 : 2;
    snprintf(text, 32, "%.*f", decimals, value);
}

/* Finds a place beside the arrow's tip, or beside the point, with a line to it if it is not near. */
static bool place_number(const ContactLook *look, const ShownContact *contact, LabelField *field, LabelWish wish,
                         PageBox *box, Segment *leader, bool *led) {
    const Point tip = arrow_tip(look, contact);
    const bool must = contact->size >= large_share * look->largest;
    const bool arrow = contact->size * look->arrow_scale >= long_arrow;
    *led = false;
    if (arrow && label_place(field, tip.x, tip.y, 0.7, wish.width, wish.height, false, box)) return true;
    if (label_place_led(field, &wish, box, leader, led)) return true;
    wish.nearest = 0;
    if (label_place_led(field, &wish, box, leader, led)) return true;
    return must && label_place(field, tip.x, tip.y, 0.7, wish.width, wish.height, true, box);
}

/* Numbers stand outside the pile of contacts, whose middle is at `middle`. */
static bool draw_number(const ContactLook *look, Sketch *sketch, const ShownContact *contact, LabelField *field,
                        double middle, bool crowded) {
    const double points = CONTACT_TYPE * look->points, em = points * MM_PER_POINT, farthest = 12;
    char text[32];
    PageBox box;
    Segment leader;
    bool led;
    format_number(text, contact->size);
    const LabelWish wish = {contact->at.x,
                            contact->at.y,
                            look->ring,
                            crowded ? crowd : 0,
                            farthest,
                            type_width(text, points) + 0.25 * em,
                            em,
                            contact->at.x < middle};
    if (!place_number(look, contact, field, wish, &box, &leader, &led)) return false;
    const Pen thin = pen_line(ACCENT, 0.8, NULL);
    if (led) sketch_line(sketch, (Point){leader.x0, leader.y0}, (Point){leader.x1, leader.y1}, &thin);
    sketch_text(sketch, (Point){(box.left + box.right) / 2, (box.bottom + box.top) / 2},
                &(TextStyle){points, TEXT_CENTER, ACCENT, 0, true}, "%s", text);
    return true;
}

/* Another contact is so near that a number between them could belong to either. */
static bool is_crowded(const ShownContact *contacts, int count, int contact) {
    for (int i = 0; i < count; i++)
        if (i != contact &&
            hypot(contacts[i].at.x - contacts[contact].at.x, contacts[i].at.y - contacts[contact].at.y) < crowd)
            return true;
    return false;
}

static double middle_of(const ShownContact *contacts, int count) {
    double sum = 0;
    for (int i = 0; i < count; i++) sum += contacts[i].at.x;
    return sum / fmax(count, 1);
}

bool draw_contacts(Sketch *sketch, const View *view, const ContactLook *look, const Trajectory *run, int step,
                   int *count, int *numbered, Error *error) {
    ShownContact *contacts = gather(run, step, view, count);
    LabelField *field = calloc(1, sizeof *field);
    const bool done = (contacts != NULL && field != NULL) || error_memory(error, "figure");
    *numbered = 0;
    if (done) {
        field->frame = (PageBox){view->low.x + 0.3, view->low.y + 0.3, view->high.x - 0.3, view->high.y - 0.3};
        for (int i = *count - 1; i >= 0; i--) draw_contact(look, sketch, &contacts[i], field);
        const double middle = middle_of(contacts, *count);
        for (int i = 0; i < *count && i < MAX_NUMBERS; i++)
            *numbered += draw_number(look, sketch, &contacts[i], field, middle, is_crowded(contacts, *count, i));
    }
    free(contacts);
    free(field);
    return done;
}
