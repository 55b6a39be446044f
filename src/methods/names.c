/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Names of methods in pictures: their texts without folders, and without networks where these tell nothing. */
#include "methods/names.h"

#include "methods/methods.h"

#include <stdio.h>
#include <string.h>

size_t method_name(char *name, size_t size, const char *text) {
    const MethodDescription *method = method_describe(text);
    const bool external = method != NULL && method->external;
    const char *given = external ? strstr(text, ",name=") : NULL;
    size_t used = 0;
    name[0] = '\0';
    if (given != NULL && given[strlen(",name=")] != '\0') {
        given += strlen(",name=");
        const int written = snprintf(name, size, "%.*s", (int)strcspn(given, ","), given);
        return (size_t)written < size ? (size_t)written : size - 1;
    }
    while (*text != '\0' && used < size) {
        size_t length = strcspn(text, external ? ":=, " : ":=,");
        const char *end = text + length, *start = text;
        if (external || (length > 4 && strncmp(end - 4, ".npz", 4) == 0))
            for (const char *c = text; c < end; c++)
                if (*c == '/') start = c + 1;
        if (*end != '\0') end++;
        used += (size_t)snprintf(name + used, size - used, "%.*s", (int)(end - start), start);
        text = end;
    }
    return used < size ? used : size - 1;
}

/* Copies a method's text without the setting `network`. */
static void leave_out_network(char out[METHOD_TEXT_SIZE], const char *text) {
    static const char key[] = "network=";
    const MethodDescription *method = method_describe(text);
    const char *at = method != NULL && !method->external ? strstr(text, key) : NULL;
    snprintf(out, METHOD_TEXT_SIZE, "%s", text);
    if (at == NULL || at == text || (at[-1] != ':' && at[-1] != ',')) return;
    const char *end = at + strcspn(at, ",");
    /* One of the two separators goes with it: the one before, unless this is that of the name and settings follow. */
    const int kept = (int)(at - text) - (*end == '\0' || at[-1] == ',');
    snprintf(out, METHOD_TEXT_SIZE, "%.*s%s", kept, text, at[-1] == ':' && *end == ',' ? end + 1 : end);
}

size_t method_name_among(char *name, size_t size, const char *const *methods, int count, int index) {
    char own[METHOD_TEXT_SIZE], other[METHOD_TEXT_SIZE];
    leave_out_network(own, methods[index]);
    for (int i = 0; i < count; i++) {
        if (strcmp(methods[i], methods[index]) == 0) continue;
        leave_out_network(other, methods[i]);
        if (strcmp(own, other) == 0) return method_name(name, size, methods[index]);
    }
    return method_name(name, size, own);
}

size_t method_name_head(const char *name) { return strcspn(name, ":"); }
