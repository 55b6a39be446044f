/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/method_look.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

size_t method_name(char *name, size_t size, const char *text) {
    size_t used = 0;
    name[0] = '\0';
    while (*text != '\0' && used < size) {
        size_t length = strcspn(text, ":=,");
        const char *end = text + length, *start = text;
        if (length > 4 && strncmp(end - 4, ".npz", 4) == 0)
            for (const char *c = text; c < end; c++)
                if (*c == '/') start = c + 1;
        if (*end != '\0') end++;
        used += (size_t)snprintf(name + used, size - used, "%.*s", (int)(end - start), start);
        text = end;
    }
    return used < size ? used : size - 1;
}

size_t method_name_head(const char *name) { return strcspn(name, ":"); }

void method_colours_assign(const MethodDescription *const *methods, int count, MethodColour *colours) {
    bool taken[METHOD_COLOURS] = {[METHOD_NO_COLOUR] = true};
    assert(count < METHOD_COLOURS);
    for (int i = 0; i < count; i++) {
        MethodColour stated = methods[i] != NULL ? methods[i]->look.colour : METHOD_NO_COLOUR;
        colours[i] = taken[stated] ? METHOD_NO_COLOUR : stated;
        taken[stated] = true;
    }
    for (int i = 0, next = METHOD_NO_COLOUR; i < count; i++) {
        if (colours[i] != METHOD_NO_COLOUR) continue;
        while (taken[next]) next++;
        colours[i] = (MethodColour)next;
        taken[next] = true;
    }
}
