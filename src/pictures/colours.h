/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which colour a method has: one table for films, pages, charts and figures.

   The rule: a method has one colour in all pictures, that of its line in the table, else the next free one; its further
   settings in a picture, in alphabetical order, have shades of it (without its network always one); any other name has
   one of seven spare colours, which the name chooses; --colour changes either. So the colours of a picture follow from
   the names in it, and not from their order. */
#pragma once
#include "base/base.h"
#include "base/json_write.h"

#include <stdbool.h>
#include <stdint.h>

/* 0xRRGGBB; the band along the local top of a box shows its rotation. */
typedef struct BodyColors {
    uint32_t fill, line, band;
} BodyColors;

/* Marks and dashes in charts. */
typedef enum MethodSymbol {
    METHOD_CIRCLE,
    METHOD_SQUARE,
    METHOD_TRIANGLE,
    METHOD_DIAMOND,
    METHOD_INVERTED_TRIANGLE,
    METHOD_PENTAGON,
    METHOD_SYMBOLS
} MethodSymbol;

typedef struct RunColours {
    BodyColors light, dark; /* by the theme; lines of charts have light.fill */
    uint32_t ink;           /* of text in that colour on white */
    MethodSymbol symbol;
    int shade; /* 0: the method's own colour */
} RunColours;

/* --colour NAME=RRGGBB: the colour of a run in the light theme, from which the others follow. NAME is the name of a run
   (method_name()), or of a method with all its settings. */
enum { COLOUR_CHOICES_MAX = 32 };
typedef struct ColourChoices {
    const char *texts[COLOUR_CHOICES_MAX];
    int count;
} ColourChoices;

/* Whether the choices can be read and seen, whatever is in the picture. ERROR_INPUT with place and reason. */
bool colours_check(const ColourChoices *choices, Error *error);

/* Those of the choices that name one of these methods: for a picture among several of one command. NULL:
   none. */
ColourChoices colours_of_these(const ColourChoices *choices, const char *const *methods, int count);

/* Colours of the runs of one picture, all different; methods[i] is the text of a method ("engine:k=20"), known or not.
   Equal texts count in their order. ERROR_INPUT for choices that are refused, name no run of the picture, or are too
   close to the colour of another run or of the bomb. `choices` NULL: none. */
enum { COLOURS_MAX = 32 };
bool colours_assign(const char *const *methods, int count, const ColourChoices *choices, RunColours *colours,
                    Error *error);

/* The colours of a method of the table and of its further settings in a picture, for a page that assigns them
   itself. */
enum { COLOUR_SHADES = 6 };
void colours_family(const char *method, const ColourChoices *choices, RunColours family[COLOUR_SHADES]);

/* Whether the table has a method. */
bool colours_have(const char *method);

/* "#0072b2" */
void colour_put(JsonWriter *json, const char *key, uint32_t colour);

/* For series that are no methods: the eight hues by Okabe and Ito, from black. */
enum { COLOUR_HUES = 8 };
RunColours colours_hue(int i);
