/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/html_text.h"

#include "common/utf8.h"

#include <ctype.h>
#include <stdbool.h>
#include <string.h>

/* XML 1.0, section 2.2. */
static bool is_xml(uint32_t character) {
    return character == '\t' || character == '\n' || character == '\r' ||
           (character >= 0x20 && character != 0xFFFE && character != 0xFFFF);
}

void html_put(FILE *file, const char *text) {
    while (*text != '\0') {
        const char *begin = text;
        uint32_t character = utf8_next(&text);
        switch (character) {
        case '&': fputs("&amp;", file); break;
        case '<': fputs("&lt;", file); break;
        case '>': fputs("&gt;", file); break;
        case '"': fputs("&quot;", file); break;
        case '\'': fputs("&#39;", file); break;
        case 0xFFFD: fputs("\xef\xbf\xbd", file); break; /* also a byte that is not UTF-8 */
        default:
            if (is_xml(character))
                fwrite(begin, 1, (size_t)(text - begin), file);
            else
                fputs("\xef\xbf\xbd", file);
        }
    }
}

void html_put_address(FILE *file, const char *name) {
    for (; *name != '\0'; name++)
        fprintf(file, isalnum((unsigned char)*name) || strchr("-._~", *name) != NULL ? "%c" : "%%%02X",
                (unsigned char)*name);
}
