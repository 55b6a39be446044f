/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The command line of a command. One table states each option's name, help, type and the member of the command's
   Options that gets its value. What is not given keeps the value that the member had. argp writes the help and finds
   the options. Every command has -q and -v besides. */
#pragma once
#include "base/base.h"
#include "scenes/scenes.h"

#include <stddef.h>
#include <stdint.h>

enum { OPTIONS_MAX = 63 }; /* of a command */

typedef struct Option Option;

/* Text -> *value, with an error that begins with option->name. `text` is NULL for a flag. */
typedef bool OptionRead(const Option *option, const char *text, void *value, Error *error);

struct Option {
    const char *name;   /* "--frames"; NULL: a heading above the options of its group */
    int letter;         /* 'o' for -o as well; or 0 */
    const char *value;  /* what the help calls its value: "N"; NULL: a flag */
    const char *help;   /* NULL ends a table */
    OptionRead *read;   /* read, at and what follows up to names: one of the macros below */
    size_t at;          /* of the member in the command's Options, bytes */
    size_t count_at;    /* lists: of the member that counts */
    double least, most; /* numbers: bounds; lists: number of values in `most` */
    const char *const *names;
    const char *needed;   /* "-o DIR is needed": the error if it is not given; NULL: may be left out */
    const char *standard; /* NULL, or the help adds it: " (default: 10)". The caller sets the member to it. */
    int group;            /* of the help, from this row on; a heading begins one, too */
};

/* The offset of a member, which must have this type. */
#define OPTION_AT(T, member, type) (offsetof(T, member) + 0 * sizeof(_Generic(&((T *)NULL)->member, type * : 0)))

/* What follows the help in the row of an option. T is the command's Options. */
#define OPTION_TEXT(T, member) .read = option_text, .at = OPTION_AT(T, member, const char *)
#define OPTION_PATH(T, member) .read = option_path, .at = OPTION_AT(T, member, const char *) /* to read */
/* A file to write; "-" makes the results go to standard error (standard_output_reserve). Binary ones are refused where
   standard output is a terminal. */
#define OPTION_OUTPUT(T, member) .read = option_output, .at = OPTION_AT(T, member, const char *)
#define OPTION_BINARY(T, member) .read = option_binary, .at = OPTION_AT(T, member, const char *)
#define OPTION_FLAG(T, member) .read = option_flag, .at = OPTION_AT(T, member, bool)
#define OPTION_SEED(T, member) .read = option_seed, .at = OPTION_AT(T, member, uint64_t)
#define OPTION_RANGE(T, member) .read = option_range, .at = OPTION_AT(T, member, FloatRange)
#define OPTION_INT(T, member, minimum, maximum) \
    .read = option_int, .at = OPTION_AT(T, member, int), .least = (minimum), .most = (maximum)
#define OPTION_FLOAT(T, member, minimum, maximum) \
    .read = option_float, .at = OPTION_AT(T, member, float), .least = (double)(minimum), .most = (double)(maximum)
/* A decimal number, or a fraction of two such as 30000/1001. */
#define OPTION_DOUBLE(T, member, minimum, maximum) \
    .read = option_double, .at = OPTION_AT(T, member, double), .least = (minimum), .most = (maximum)
/* An enum without negative values, from a list of names that ends with NULL. */
#define OPTION_ENUM(T, member, list) .read = option_enum, .at = OPTION_AT(T, member, unsigned), .names = (list)
/* Several of the names, separated by commas: bit i for names[i]. */
#define OPTION_FLAGS(T, member, list) .read = option_flags, .at = OPTION_AT(T, member, unsigned), .names = (list)
/* Any other: function(option, text, &options->member, error). */
#define OPTION_READ(function, T, member) .read = (function), .at = offsetof(T, member)
/* An option that may be repeated: texts in an array, their number in `count`. */
#define OPTION_TEXTS(T, array, count)                                                                       \
    .read = option_texts, .at = OPTION_AT(T, array[0], const char *), .count_at = OPTION_AT(T, count, int), \
    .most = sizeof((T *)NULL)->array / sizeof *((T *)NULL)->array
/* Methods, which may be programs: those that are named here may be started (programs_allow). One or a list; or
   repeated. */
#define OPTION_METHOD(T, member) .read = option_method, .at = OPTION_AT(T, member, const char *)
#define OPTION_METHOD_TEXTS(T, array, count)                                                                       \
    .read = option_method_texts, .at = OPTION_AT(T, array[0], const char *), .count_at = OPTION_AT(T, count, int), \
    .most = sizeof((T *)NULL)->array / sizeof *((T *)NULL)->array
#define OPTION_PATHS(T, array, count)                                                                       \
    .read = option_paths, .at = OPTION_AT(T, array[0], const char *), .count_at = OPTION_AT(T, count, int), \
    .most = sizeof((T *)NULL)->array / sizeof *((T *)NULL)->array

#define OPTION_SET(T, member)                                                                                       \
    "--set", 0, "NAME=VALUE",                                                                                       \
        "Value of a parameter of the scene, or of what every scene has: iterations, dt, friction, bomb_x, bomb_y, " \
        "bomb_mass, bomb_speed (may be repeated)",                                                                  \
        OPTION_READ(option_set, T, member)

/* The members of a ColourChoices (pictures/colours.h). */
#define OPTION_COLOUR(T, member)                                                                                  \
    "--colour", 0, "NAME=RRGGBB",                                                                                 \
        "Colour of a method or of one run, such as planck=2a9d8f (may be repeated). By default a method has one " \
        "colour in all pictures; its further settings in a picture, in alphabetical order, have shades of it; "   \
        "any other name has a spare colour, which the name chooses",                                              \
        OPTION_TEXTS(T, member.texts, member.count)

OptionRead option_text, option_path, option_flag, option_seed, option_range, option_int, option_float, option_double,
    option_enum, option_flags, option_texts, option_paths, option_set, option_output, option_binary, option_method,
    option_method_texts;

typedef struct CommandSpec {
    const Option *options; /* ended by {0} */
    Option input;          /* how one of the command's arguments is read; value: what the help calls them all */
    struct {
        int least, most;
        const char *noun; /* "scene", for the error "only 2 scenes can be given" */
    } inputs;
    const char *help; /* description, \v, examples */
} CommandSpec;

/* Fills `options`. Bad usage ends the program with exit status 2; a bad value sets error: the first one stands. Options
   may stand between arguments. */
bool options_parse(const CommandSpec *spec, int argc, char **argv, void *options, Error *error);
