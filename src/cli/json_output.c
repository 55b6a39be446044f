/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Results as JSON. */
#include "base/base.h"
#include "base/file.h"
#include "cli/json_output.h"

#include <stdlib.h>
#include <unistd.h>

void json_output_print(FILE *out, const void *context) {
    const JsonOutput *output = context;
    JsonWriter json = {.out = out};
    json_begin_object(&json, NULL, JSON_LINES);
    json_put_text(&json, "format", output->format);
    output->write(&json, output->context);
    json_end(&json);
}

bool json_output_check(bool json, Error *error) {
    return !json || !standard_output_is_reserved() ||
           error_input(error, "--json", "cannot be combined with a file written to standard output");
}

/* Through memory, because JsonWriter needs the C locale. */
bool json_output(const char *format, JsonOutputWrite *write, const void *context, Error *error) {
    const JsonOutput output = {format, write, context};
    size_t size;
    char *text = file_print(json_output_print, &output, &size);
    if (text == NULL) return error_memory(error, "--json");
    fwrite(text, 1, size, stdout); /* main() checks standard output */
    free(text);
    return true;
}

void json_output_pair(JsonWriter *json, const char *key, double x, double y) {
    json_begin_array(json, key, JSON_ONE_LINE);
    json_put_number(json, NULL, x);
    json_put_number(json, NULL, y);
    json_end(json);
}
