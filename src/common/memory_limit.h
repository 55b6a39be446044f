/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The limit that a shell or a service sets on the memory of a process: the likely reason where a library fails without
   giving one. */
#pragma once

typedef struct MemoryLimit {
    char text[80]; /* "; the memory of a process is limited to 200 MiB (ulimit -v)"; empty without a limit */
} MemoryLimit;

MemoryLimit memory_limit(void);
