/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Results as JSON (--json): one object on standard output and nothing else there. Its first key is "format": the
   name of the command and the version of the keys, "twinbox solve 1". A number that is not finite is null. After an
   error nothing is printed. */
#pragma once
#include "base/base.h"
#include "base/json_write.h"
#include "cli/options.h"

#include <stdbool.h>
#include <stdio.h>

#define OPTION_JSON(T, member) \
    "--json", 0, NULL, "Print the result as one JSON object on standard output", OPTION_FLAG(T, member)

/* Refuses --json where a file is written to standard output. */
bool json_output_check(bool json, Error *error);

/* Prints what `write` puts between the format and the end of the object. */
typedef void JsonOutputWrite(JsonWriter *json, const void *context);

/* The same into a file: the object of a JsonOutput. */
typedef struct JsonOutput {
    const char *format;
    JsonOutputWrite *write;
    const void *context;
} JsonOutput;
void json_output_print(FILE *out, const void *output);
bool json_output(const char *format, JsonOutputWrite *write, const void *context, Error *error);

/* "point": [x, y] */
void json_output_pair(JsonWriter *json, const char *key, double x, double y);
