/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a program does on its way to a result: files read and written, programs started, the OpenGL context. The library
   never prints: cli/ listens if the user wants to know (-v). */
#pragma once
#include "common/error.h"

/* Gets one line without its end; called from several threads at once, and in forked processes. */
typedef void TraceListener(const char *line);

/* Call it before threads begin; NULL ends it, which is the start, too. */
void trace_listen(TraceListener *listener);

/* Does nothing unless somebody listens. What is longer than 1,000 bytes is cut. */
void trace_line(const char *format, ...) PRINTF_LIKE(1, 2);
