/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The colours and symbols of methods, of their settings, and of names without a colour of their own. */
#include "pictures/colours.h"

#include "base/hash.h"
#include "methods/methods.h"
#include "methods/names.h"
#include "pictures/picture.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The first eight hues are Okabe and Ito's, "Color Universal Design" (2008); wine, from Tol, "Colour Schemes" (2021),
   replaces yellow, which is too light for lines. Purple, sky and vermilion are a little lighter or darker than theirs,
   so that any two of the eight differ in grey, too. They belong to the methods that are compared most. The others were
   found by search: the largest least distance in CIELAB between any two of all, and from the bomb, on both themes, to
   readers with normal sight and with each of the three kinds of colour blindness (Machado, Oliveira, Fernandes 2009).
   tests/pictures/test_theme.c measures them. */
typedef struct MethodPaint {
    const char *name;
    MethodSymbol symbol;
    BodyColors light, dark; /* fill, line, band; dark: the same hue, lighter, and lines exchange with bands. Of the
                               others only the light fill: the rest follows from it (paint_with()) */
} MethodPaint;

static const MethodPaint paints[] = {
    {"reference", METHOD_CIRCLE, {0x181D24, 0x000000, 0x8D99A8}, {0xCFD7E2, 0x232A33, 0xF2F5F8}},
    {"soft-step", METHOD_SQUARE, {0xD25A09, 0x6B2F00, 0xF7B07A}, {0xE6722E, 0x3A1600, 0xFFC9A0}},
    {"engine", METHOD_CIRCLE, {0x0072B2, 0x00395C, 0x4FA6D8}, {0x2A86C4, 0x061D2D, 0x8CCBF0}},
    {"momentum", METHOD_TRIANGLE, {0x009E73, 0x004D38, 0x5CCBAA}, {0x1BB28C, 0x02271C, 0x8FE3C8}},
    {"interior", METHOD_DIAMOND, {0xD07CB1, 0x6E2F52, 0xEBBBD5}, {0xD894BE, 0x3A132A, 0xF6D3E5}},
    {"scene-net", METHOD_DIAMOND, {0x66C1F7, 0x1D5F87, 0xB5DFF7}, {0x7ECAF8, 0x0F3349, 0xD0ECFC}},
    {"pair-net", METHOD_DIAMOND, {0xE69F00, 0x7A4F00, 0xFFD47A}, {0xE9A92A, 0x3B2600, 0xFFE3A3}},
    {"contact-net", METHOD_CIRCLE, {0x882255, 0x3F0F27, 0xC98BA6}, {0xB0487D, 0x2A0818, 0xE8B4CE}},
    {"avbd", METHOD_DIAMOND, .light.fill = 0x439100},
    {"nncg", METHOD_DIAMOND, .light.fill = 0x2A5900},
    {"admm", METHOD_TRIANGLE, .light.fill = 0x7F8F3D},
    {"closed-form", METHOD_CIRCLE, .light.fill = 0x0C00AC},
    {"playback", METHOD_INVERTED_TRIANGLE, .light.fill = 0x3E2856},
    {"sain", METHOD_TRIANGLE, .light.fill = 0xEAA7A4},
    {"hybrid", METHOD_SQUARE, .light.fill = 0x42D322},
    {"gns", METHOD_CIRCLE, .light.fill = 0x7131DC},
    {"subspace", METHOD_CIRCLE, .light.fill = 0xCAB77F},
};

/* Fills for methods of the registry that are not in the table, in its order; then for programs, own runs and all other
   names. Where there are more such methods than fills of theirs, they share those of the others. */
static const uint32_t spares[] = {0x826BFB, 0x540000, 0xFF4FD5, 0x7ACC53, 0xFF4072,
                                  0x0000F9, 0xAB3835, 0x920AFF, 0x55016A};

enum {
    OWNED = sizeof paints / sizeof *paints,
    SPARES = sizeof spares / sizeof *spares,
    PAINTS = OWNED + SPARES,
    FOR_METHODS = 2,
    OTHERS = SPARES - FOR_METHODS
};

/* 0 to 255, of the channels as they are: exact on every machine, and near enough to lightness. */
static double luma(uint32_t colour) {
    return 0.2126 * (colour >> 16 & 255) + 0.7152 * (colour >> 8 & 255) + 0.0722 * (colour & 255);
}

/* The same hue with another luma. */
static uint32_t with_luma(uint32_t colour, double wanted) {
    const double now = luma(colour);
    return wanted > now ? theme_mix(colour, 0xFFFFFF, (wanted - now) / (255 - now))
                        : theme_mix(colour, 0x000000, now > 0 ? (now - wanted) / now : 0);
}

/* Lightest and darkest fill that stands out from panels, ground and page of the light theme; lightest text on white. */
static const double LIGHTEST = 187, DARKEST = 48, INK_LIGHTEST = 92;

/* Of the dark theme, for one of the light. */
static double dark_luma(double light) { return 100 + 0.6 * light; }

static BodyColors light_box(uint32_t fill) {
    return (BodyColors){fill, theme_mix(fill, 0x000000, 0.5), theme_mix(fill, 0xFFFFFF, 0.45)};
}

static BodyColors dark_box(uint32_t fill) {
    return (BodyColors){fill, theme_mix(fill, 0x000000, 0.8), theme_mix(fill, 0xFFFFFF, 0.5)};
}

static MethodPaint paint_with(MethodSymbol symbol, uint32_t fill) {
    return (MethodPaint){NULL, symbol, light_box(fill), dark_box(with_luma(fill, dark_luma(luma(fill))))};
}

static MethodPaint paint_at(int place) {
    if (place >= OWNED)
        return paint_with(place < OWNED + FOR_METHODS ? METHOD_SQUARE : METHOD_PENTAGON, spares[place - OWNED]);
    const MethodPaint paint = paints[place];
    return paint.dark.fill != 0 ? paint : paint_with(paint.symbol, paint.light.fill);
}

static bool is_near(uint32_t a, uint32_t b) {
    const double least = 50; /* of 255 in each channel */
    double sum = 0;
    for (int shift = 0; shift < 24; shift += 8) {
        const double d = (double)(a >> shift & 255) - (double)(b >> shift & 255);
        sum += d * d;
    }
    return sum < least * least;
}

static bool is_like_another(uint32_t fill, bool dark) {
    bool like = false;
    for (int i = 0; i < PAINTS && !like; i++)
        like = is_near(fill, dark ? paint_at(i).dark.fill : paint_at(i).light.fill);
    return like;
}

/* Of `levels` even steps of luma, the one that is the shade-th farthest from the method's own colour; those that are
   like another colour of the table come last. The nearest step counts as the own colour. */
static uint32_t shade_fill(const MethodPaint *paint, bool dark, int shade, int levels) {
    const uint32_t own = dark ? paint->dark.fill : paint->light.fill;
    const double darkest = dark ? dark_luma(DARKEST) : DARKEST, lightest = dark ? dark_luma(LIGHTEST) : LIGHTEST;
    uint32_t fill = own;
    for (int like = 0, left = shade; like < 2; like++)
        for (int low = 0, high = levels - 1; low < high;) {
            const double step = (lightest - darkest) / (levels - 1), below = darkest + step * low,
                         above = darkest + step * high;
            const bool up = above - luma(own) > luma(own) - below;
            fill = with_luma(own, up ? above : below);
            if (up)
                high--;
            else
                low++;
            if (is_like_another(fill, dark) == like && --left == 0) return fill;
        }
    return fill;
}

static RunColours shade_of(const MethodPaint *paint, int shade, int levels) {
    RunColours colours = {paint->light, paint->dark, 0, paint->symbol, shade};
    if (shade > 0) {
        colours.light = light_box(shade_fill(paint, false, shade, levels));
        colours.dark = dark_box(shade_fill(paint, true, shade, levels));
    }
    colours.ink = with_luma(colours.light.fill, fmin(luma(colours.light.fill), INK_LIGHTEST));
    return colours;
}

/* Choices. */

/* "Planck=#2a9d8f". */
static bool read_choice(const char *text, char name[METHOD_TEXT_SIZE], uint32_t *colour, Error *error) {
    const char *equals = strrchr(text, '='), *digits = equals != NULL ? equals + 1 : text;
    digits += *digits == '#';
    if (equals == NULL || equals == text || (size_t)(equals - text) >= METHOD_TEXT_SIZE || strlen(digits) != 6 ||
        strspn(digits, "0123456789abcdefABCDEF") != 6)
        return error_input(error, "--colour", "'%s' is not NAME=RRGGBB, with six hex digits, such as interior=cc79a7",
                           text);
    snprintf(name, METHOD_TEXT_SIZE, "%.*s", (int)(equals - text), text);
    *colour = (uint32_t)strtoul(digits, NULL, 16);
    return luma(*colour) <= LIGHTEST ||
           error_input(error, "--colour",
                       "'%s' is too light to be seen on white: its lightness is %.0f of 255, at most %.0f", text,
                       luma(*colour), LIGHTEST);
}

bool colours_check(const ColourChoices *choices, Error *error) {
    char name[METHOD_TEXT_SIZE], other[METHOD_TEXT_SIZE];
    uint32_t colour;
    for (int i = 0; i < choices->count; i++) {
        if (!read_choice(choices->texts[i], name, &colour, error)) return false;
        for (int k = 0; k < i; k++)
            if (read_choice(choices->texts[k], other, &colour, error) && strcmp(name, other) == 0)
                return error_input(error, "--colour", "'%s' has two colours: %s and %s", name, choices->texts[k],
                                   choices->texts[i]);
    }
    return true;
}

/* The choice for exactly this name; false: none. */
static bool find_choice(const ColourChoices *choices, const char *name, uint32_t *colour) {
    char chosen[METHOD_TEXT_SIZE];
    Error ignored = {0};
    for (int i = 0; choices != NULL && i < choices->count; i++)
        if (read_choice(choices->texts[i], chosen, colour, &ignored) && strcmp(chosen, name) == 0) return true;
    return false;
}

static int place_in_table(const char *method, size_t length) {
    for (int i = 0; i < OWNED; i++)
        if (strlen(paints[i].name) == length && strncmp(paints[i].name, method, length) == 0) return i;
    return -1;
}

/* The place of a method: in the table, or the spare one that is its own; -1: it is no method, or a program. */
static int owned(const char *method) {
    const int place = place_in_table(method, method_name_head(method));
    const MethodDescription *wanted = method_describe(method);
    if (place >= 0 || wanted == NULL || wanted->external) return place;
    int before = 0;
    for (const MethodKind *kind = method_kinds; kind->description != wanted; kind++)
        before += !kind->description->external &&
                  place_in_table(kind->description->name, strlen(kind->description->name)) < 0;
    return OWNED + before % SPARES;
}

bool colours_have(const char *method) { return owned(method) >= 0; }

RunColours colours_hue(int i) { return shade_of(&paints[i % COLOUR_HUES], 0, COLOUR_SHADES); }

/* A picture while its colours are assigned. */
typedef struct Assignment {
    int count;
    char names[COLOURS_MAX][METHOD_TEXT_SIZE];
    int order[COLOURS_MAX];  /* by name */
    int places[COLOURS_MAX]; /* in the table, or behind it */
    int members[PAINTS];     /* runs of each place */
    bool chosen[COLOURS_MAX];
} Assignment;

/* The places of the runs, in the order of their names. A name without one has the spare colour that it chooses, or the
   next that no other name of the picture has; without any, the first again. */
static void find_places(Assignment *all, const char *const *methods) {
    for (int i = 0; i < all->count; i++) {
        int k = i;
        for (; k > 0 && strcmp(all->names[all->order[k - 1]], all->names[i]) > 0; k--)
            all->order[k] = all->order[k - 1];
        all->order[k] = i;
    }
    for (int i = 0; i < all->count; i++) {
        const int run = all->order[i], before = i > 0 ? all->order[i - 1] : run;
        const char *name = all->names[run];
        const MethodDescription *method = method_describe(methods[run]);
        /* A program is not the method whose name it gives itself. */
        int place = method != NULL && method->external ? -1 : owned(methods[run]);
        if (place < 0 && i > 0 && all->places[before] >= OWNED && strcmp(all->names[before], name) == 0)
            place = all->places[before];
        if (place < 0) {
            const int begin = OWNED + FOR_METHODS,
                      first = (int)(hash_fnv1a64(FNV1A64_START, name, strlen(name)) % OTHERS);
            int next = 0;
            while (next < OTHERS && all->members[begin + (first + next) % OTHERS] > 0) next++;
            place = begin + (first + next) % OTHERS;
        }
        all->places[run] = place;
        all->members[place]++;
    }
}

/* The paint of a name, and whether it is the one of a choice for just this run. */
static bool paint_of(MethodPaint *paint, int place, const char *name, const ColourChoices *choices, bool *chosen) {
    char method[METHOD_TEXT_SIZE];
    const size_t head = method_name_head(name);
    uint32_t colour;
    snprintf(method, sizeof method, "%.*s", (int)head, name);
    const bool alone = name[head] != '\0' && find_choice(choices, name, &colour);
    *chosen = alone || find_choice(choices, method, &colour);
    *paint = paint_at(place);
    if (*chosen) *paint = paint_with(paint->symbol, colour);
    return alone;
}

static bool is_named(const char *chosen, const char *name) {
    const size_t head = method_name_head(name);
    return strcmp(name, chosen) == 0 || (strlen(chosen) == head && strncmp(name, chosen, head) == 0);
}

ColourChoices colours_of_these(const ColourChoices *choices, const char *const *methods, int count) {
    ColourChoices these = {.count = 0};
    char chosen[METHOD_TEXT_SIZE], name[METHOD_TEXT_SIZE];
    uint32_t colour;
    Error ignored = {0};
    for (int i = 0; choices != NULL && i < choices->count; i++)
        for (int k = 0; k < count; k++) {
            method_name(name, sizeof name, methods[k]);
            if (!read_choice(choices->texts[i], chosen, &colour, &ignored) || !is_named(chosen, name)) continue;
            these.texts[these.count++] = choices->texts[i];
            break;
        }
    return these;
}

static bool check_names(const Assignment *all, const ColourChoices *choices, Error *error) {
    NameList known = {0};
    char name[METHOD_TEXT_SIZE];
    uint32_t colour;
    for (int i = 0; i < all->count; i++) name_list_add(&known, all->names[i]);
    for (int i = 0; i < choices->count; i++) {
        bool found = !read_choice(choices->texts[i], name, &colour, error);
        for (int k = 0; k < all->count && !found; k++) found = is_named(name, all->names[k]);
        if (!found) return error_unknown(error, "--colour", name, "a run of this picture", &known);
    }
    return true;
}

static bool check_distances(const Assignment *all, const RunColours *colours, Error *error) {
    for (int i = 0; i < all->count; i++) {
        const uint32_t fill = colours[i].light.fill;
        if (all->chosen[i] && is_near(fill, BOMB.fill))
            return error_input(error, "--colour", "#%06x for '%s' is too close to the colour of the bomb, #%06x", fill,
                               all->names[i], BOMB.fill);
        for (int k = 0; k < all->count; k++)
            if (all->chosen[i] && k != i && is_near(fill, colours[k].light.fill))
                return error_input(error, "--colour", "#%06x for '%s' is too close to the colour of '%s', #%06x", fill,
                                   all->names[i], all->names[k], colours[k].light.fill);
    }
    return true;
}

bool colours_assign(const char *const *methods, int count, const ColourChoices *choices, RunColours *colours,
                    Error *error) {
    Assignment all = {.count = count};
    bool taken[PAINTS][COLOURS_MAX + 1] = {{false}};
    assert(count <= COLOURS_MAX);
    for (int i = 0; i < count; i++) method_name(all.names[i], METHOD_TEXT_SIZE, methods[i]);
    find_places(&all, methods);
    for (int i = 0; i < count; i++) {
        const int run = all.order[i], place = all.places[run];
        const char *name = all.names[run];
        MethodPaint paint;
        int shade = 0;
        if (!paint_of(&paint, place, name, choices, &all.chosen[run])) {
            shade = strstr(name, "net=off") != NULL; /* the ablation is never taken for the network */
            while (taken[place][shade]) shade++;
            taken[place][shade] = true;
        }
        /* One level more than runs: the ablation may have left out the first. */
        const int levels = all.members[place] < COLOUR_SHADES ? COLOUR_SHADES : all.members[place] + 1;
        colours[run] = shade_of(&paint, shade, levels);
    }
    return choices == NULL || choices->count == 0 ||
           (colours_check(choices, error) && check_names(&all, choices, error) &&
            check_distances(&all, colours, error));
}

void colours_family(const char *method, const ColourChoices *choices, RunColours family[COLOUR_SHADES]) {
    const int place = owned(method);
    MethodPaint paint;
    bool chosen;
    assert(place >= 0);
    paint_of(&paint, place, method, choices, &chosen);
    for (int i = 0; i < COLOUR_SHADES; i++) family[i] = shade_of(&paint, i, COLOUR_SHADES);
}

void colour_put(JsonWriter *json, const char *key, uint32_t colour) {
    char text[16];
    snprintf(text, sizeof text, "#%06x", colour);
    json_put_text(json, key, text);
}
