/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/house_page.h"

#include "common/html_text.h"

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
