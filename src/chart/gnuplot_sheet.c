/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "chart/gnuplot_sheet.h"

#include "chart/gnuplot.h"
#include "common/file.h"
#include "common/memory_stream.h"

#include <limits.h>
#include <stdlib.h>

bool gnuplot_sheet_open(GnuplotSheet *sheet, const char *what, Error *error) {
    sheet->page.script = memory_stream(&sheet->script, &sheet->script_size);
    sheet->page.caption = memory_stream(&sheet->caption, &sheet->caption_size);
    sheet->page.links = memory_stream(&sheet->links, &sheet->links_size);
    bool open = sheet->page.script != NULL && sheet->page.caption != NULL && sheet->page.links != NULL;
    return open || error_memory(error, what);
}

static void close_file(GnuplotPage *page, FILE **file) {
    if (*file == NULL) return;
    if (ferror(*file)) page->no_memory = true;
    if (fclose(*file) != 0) page->no_memory = true;
    *file = NULL;
}

bool gnuplot_sheet_close(GnuplotSheet *sheet, const char *what, Error *error) {
    close_file(&sheet->page, &sheet->page.script);
    close_file(&sheet->page, &sheet->page.caption);
    close_file(&sheet->page, &sheet->page.links);
    return !sheet->page.no_memory || error_memory(error, what);
}

bool gnuplot_sheet_draw(const GnuplotSheet *sheet, const char *folder, const char *prefix, const char *name,
                        Error *error) {
    char stem[PATH_MAX], caption[PATH_MAX + 4];
    if (sheet->page.width <= 0) return true;
    if (!file_path(stem, sizeof stem, error, "%s/%s%s", folder, prefix, name)) return false;
    snprintf(caption, sizeof caption, "%s.txt", stem);
    const GnuplotDrawing drawing = {sheet->page.width,
                                    sheet->page.height,
                                    sheet->script,
                                    sheet->script_size,
                                    .without_pdf = true,
                                    .title = name,
                                    .overlay = sheet->links_size > 0 ? sheet->links : NULL};
    return gnuplot_draw(&drawing, stem, error) && file_write(caption, sheet->caption, sheet->caption_size, error);
}

void gnuplot_sheet_free(GnuplotSheet *sheet) {
    close_file(&sheet->page, &sheet->page.script);
    close_file(&sheet->page, &sheet->page.caption);
    close_file(&sheet->page, &sheet->page.links);
    free(sheet->script);
    free(sheet->caption);
    free(sheet->links);
    *sheet = (GnuplotSheet){0};
}
