/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Keys, ellipsoids and answers of a memory (tabulation.h). Sums run in a fixed order. */
#include "tabulation/tabulation.h"
#include "tabulation/tabulation_sets.h"

#include <float.h>
#include <math.h>

/* A step of position correction removes this share of an overlap (dynamics/contacts.c). */
static const float push_out = 0.2f;

void tabulation_numbers(const ProblemBody *body, float angle, float dt, float numbers[TABULATION_NUMBERS]) {
    const float rate = push_out / dt, arm = 0.25f * (body->size.x + body->size.y);
    numbers[0] = rate * body->position.x;
    numbers[1] = rate * body->position.y;
    numbers[2] = rate * arm * angle;
    numbers[3] = body->velocity.x;
    numbers[4] = body->velocity.y;
    numbers[5] = arm * body->angular_velocity;
}

void tabulation_key(const Tabulation *memory, const float *bomb, const float *others, float *key) {
    float away = 0, inside = 0, sums[TABULATION_COMPONENTS_MAX] = {0};
    for (int i = 0; i < TABULATION_NUMBERS; i++) key[i] = bomb[i];
    for (int i = 0; i < memory->numbers; i++) {
        const float from = others[i] - memory->centre[i],
                    *column = memory->rows + (size_t)i * (size_t)memory->components;
        away += from * from;
        for (int c = 0; c < memory->components; c++) sums[c] += from * column[c];
    }
    for (int c = 0; c < memory->components; c++) {
        key[TABULATION_NUMBERS + c] = sums[c];
        inside += sums[c] * sums[c];
    }
    key[TABULATION_NUMBERS + memory->components] = sqrtf(away > inside ? away - inside : 0);
}

/* product[i] = row i of M times `from`; returns from^T M from. */
static float apply(const Tabulation *memory, int entry, const float *from, float *product) {
    const float *metric = memory->metrics + (size_t)entry * (size_t)memory->metric_size;
    float sum = 0;
    for (int i = 0; i < memory->key_size; i++) product[i] = 0;
    for (int i = 0; i < memory->key_size; i++) {
        float own = 0;
        for (int j = 0; j < i; j++, metric++) {
            own += *metric * from[j];
            product[j] += *metric * from[i];
        }
        product[i] += own + *metric++ * from[i];
    }
    for (int i = 0; i < memory->key_size; i++) sum += product[i] * from[i];
    return sum;
}

/* key - x0; returns its squared length. */
static float take_away(const Tabulation *memory, int entry, const float *key, float *from) {
    const float *centre = memory->keys + (size_t)entry * (size_t)memory->key_size;
    float sum = 0;
    for (int i = 0; i < memory->key_size; i++) {
        from[i] = key[i] - centre[i];
        sum += from[i] * from[i];
    }
    return sum;
}

float tabulation_distance(const Tabulation *memory, int entry, const float *key) {
    float from[TABULATION_KEY_MAX] = {0}, product[TABULATION_KEY_MAX];
    take_away(memory, entry, key, from);
    return apply(memory, entry, from, product);
}

/* The most central of the entries, at most `least` from the query. */
static int search(const Tabulation *memory, const TabulationQuery *query, float radius, float least) {
    int count, best = -1;
    const int32_t *entries = tabulation_about(memory, query, radius, &count);
    float from[TABULATION_KEY_MAX] = {0}, product[TABULATION_KEY_MAX];
    const bool inside = least <= 1;
    for (int i = 0; i < count; i++) {
        if (take_away(memory, entries[i], query->key, from) > memory->reach[entries[i]] && inside) continue;
        const float distance = apply(memory, entries[i], from, product);
        if (distance > least) continue;
        least = distance;
        best = entries[i];
    }
    return best;
}

int tabulation_find(const Tabulation *memory, const TabulationQuery *query) {
    const int set = tabulation_set(memory, query->hash, query->contacts);
    return set < 0 ? -1 : search(memory, query, sqrtf(memory->set_lists[set].reach), 1);
}

int tabulation_nearest(const Tabulation *memory, const TabulationQuery *query, float radius) {
    return search(memory, query, radius, FLT_MAX);
}

void tabulation_answer(const Tabulation *memory, int entry, const float *key, ContactImpulse *impulses) {
    const size_t size = (size_t)memory->key_size;
    const int contacts = memory->set_contacts[memory->entry_set[entry]];
    const ContactImpulse *own = memory->impulses + memory->entry_begin[entry];
    float from[TABULATION_KEY_MAX] = {0};
    take_away(memory, entry, key, from);
    for (int i = 0; i < contacts; i++) impulses[i] = own[i];
    for (int n = 0; n < TABULATION_NEAR; n++) {
        const size_t row = (size_t)entry * TABULATION_NEAR + (size_t)n;
        const int32_t near = memory->near[row];
        if (near < 0) continue;
        const ContactImpulse *other = memory->impulses + memory->entry_begin[near];
        float share = 0;
        for (int i = 0; i < memory->key_size; i++) share += memory->weights[row * size + (size_t)i] * from[i];
        for (int i = 0; i < contacts; i++) {
            impulses[i].normal += share * (other[i].normal - own[i].normal);
            impulses[i].tangent += share * (other[i].tangent - own[i].tangent);
        }
    }
}

/* With y = M d and s = d^T M d: M' = M + (1 - s) / s^2 y y^T has d^T M' d = 1 and changes no direction that M-orthogonal to d
   has. For s > 1 this is the smallest ellipsoid that contains the old one and d (Pope 1997, 3.4). */
void tabulation_stretch(Tabulation *memory, int entry, const float *key) {
    float from[TABULATION_KEY_MAX] = {0}, product[TABULATION_KEY_MAX];
    const float length = take_away(memory, entry, key, from), distance = apply(memory, entry, from, product);
    if (!(distance > FLT_MIN)) return;
    const float factor = (1 - distance) / (distance * distance);
    float *metric = memory->metrics + (size_t)entry * (size_t)memory->metric_size;
    for (int i = 0; i < memory->key_size; i++)
        for (int j = 0; j <= i; j++) *metric++ += factor * product[i] * product[j];
    /* The inverse of M' is that of M plus (1 - 1 / s) d d^T. */
    if (distance > 1) memory->reach[entry] += (1 - 1 / distance) * length;
    TabulationList *list = &memory->set_lists[memory->entry_set[entry]];
    if (memory->reach[entry] > list->reach) list->reach = memory->reach[entry];
}
