/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/html_text.h"

void html_put(FILE *file, const char *text) {
    for (; *text != '\0'; text++) switch (*text) {
        case '&': fputs("&amp;", file); break;
        case '<': fputs("&lt;", file); break;
        case '>': fputs("&gt;", file); break;
        case '"': fputs("&quot;", file); break;
        case '\'': fputs("&#39;", file); break;
        default: fputc(*text, file);
        }
}
