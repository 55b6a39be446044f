/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What HTML pages share. */
#include "pictures/page.h"

#include "base/base.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

void html_put(FILE *file, const char *text) {
    while (*text != '\0') {
        const char *begin = text;
        const uint32_t character = utf8_next(&text);
        switch (character) {
        case '&': fputs("&amp;", file); break;
        case '<': fputs("&lt;", file); break;
        case '>': fputs("&gt;", file); break;
        case '"': fputs("&quot;", file); break;
        case '\'': fputs("&#39;", file); break;
        default: /* U+FFFD is also a byte that is not UTF-8; XML 1.0, section 2.2 */
            if (character == '\t' || character == '\n' || character == '\r' ||
                (character >= 0x20 && character < 0xFFFD) || character > 0xFFFF)
                fwrite(begin, 1, (size_t)(text - begin), file);
            else
                fputs("\xef\xbf\xbd", file);
        }
    }
}

void html_print(FILE *file, const char *format, ...) {
    va_list texts;
    va_start(texts, format);
    for (const char *next; (next = strstr(format, "%s")) != NULL; format = next + strlen("%s")) {
        fwrite(format, 1, (size_t)(next - format), file);
        html_put(file, va_arg(texts, const char *));
    }
    fputs(format, file);
    va_end(texts);
}

void html_put_address(FILE *file, const char *name) {
    for (; *name != '\0'; name++)
        fprintf(file, isalnum((unsigned char)*name) || strchr("-._~", *name) != NULL ? "%c" : "%%%02X",
                (unsigned char)*name);
}

void house_page_begin(FILE *out, const char *title, const char *style) {
    fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
          "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
          "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src 'self' file: data:; "
          "style-src 'unsafe-inline'\">\n<link rel=\"icon\" href=\"data:,\">\n<title>",
          out);
    html_put(out, title);
    fprintf(out, "</title>\n<style>\n%s%s</style>\n</head>\n<body>\n<main>\n", house_css, style);
}

void house_page_end(FILE *out) { fputs("</main>\n</body>\n</html>\n", out); }

void base64_put(FILE *file, const void *data, size_t size) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const uint8_t *bytes = data;
    for (size_t i = 0; i < size; i += 3) {
        const size_t left = size - i;
        const uint32_t group =
            (uint32_t)bytes[i] << 16 | (left > 1 ? (uint32_t)bytes[i + 1] << 8 : 0) | (left > 2 ? bytes[i + 2] : 0u);
        putc_unlocked(digits[group >> 18], file); /* an error stays in the file, for the caller */
        putc_unlocked(digits[group >> 12 & 63], file);
        putc_unlocked(left > 1 ? digits[group >> 6 & 63] : '=', file);
        putc_unlocked(left > 2 ? digits[group & 63] : '=', file);
    }
}

void html_put_script_hash(FILE *file, const unsigned char sha256[32]) {
    fputs(" 'sha256-", file);
    base64_put(file, sha256, 32);
    fputs("'", file);
}
