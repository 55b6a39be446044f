/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/trace.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>

static TraceListener *heard_by;

void trace_listen(TraceListener *listener) { heard_by = listener; }

void trace_line(const char *format, ...) {
    char line[1001];
    va_list arguments;
    if (heard_by == NULL) return;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    heard_by(line);
}
