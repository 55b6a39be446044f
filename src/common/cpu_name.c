/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/cpu_name.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>
#include <sys/utsname.h>

/* Spaces are joined, and what cannot stand in every table becomes one. */
static void copy_plain(char name[CPU_NAME_SIZE], const char *text) {
    size_t used = 0;
    for (; *text != '\0' && used + 1 < CPU_NAME_SIZE; text++) {
        const char c = isalnum((unsigned char)*text) || strchr("-_.,:()+/@", *text) != NULL ? *text : ' ';
        if (c != ' ' || (used > 0 && name[used - 1] != ' ')) name[used++] = c == '@' ? ' ' : c;
        if (used > 1 && name[used - 1] == ' ' && name[used - 2] == ' ') used--;
    }
    while (used > 0 && name[used - 1] == ' ') used--;
    name[used] = '\0';
}

void cpu_name(char name[CPU_NAME_SIZE]) {
    char line[256];
    struct utsname system;
    name[0] = '\0';
    FILE *file = fopen("/proc/cpuinfo", "re");
    while (file != NULL && name[0] == '\0' && fgets(line, sizeof line, file) != NULL) {
        const char *colon = strchr(line, ':');
        if (colon != NULL && strncmp(line, "model name", strlen("model name")) == 0) copy_plain(name, colon + 1);
    }
    if (file != NULL) fclose(file);
    if (name[0] == '\0' && uname(&system) == 0) copy_plain(name, system.machine);
    if (name[0] == '\0') strcpy(name, "unknown");
}
