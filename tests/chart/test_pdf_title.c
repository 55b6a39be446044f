/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Titles in PDF files of both forms; poppler reads them. */
#include "testing.h"

#include "chart/first_line.h"
#include "chart/pdf_title.h"
#include "common/file.h"
#include "sketch/sketch_formats.h"

#include <stdlib.h>

/* Sets the title of a copy and lets poppler print it. */
static void expect_titled(const char *data, size_t size) {
    Error error = {0};
    char *pdf = malloc(size);
    assert_non_null(pdf);
    memcpy(pdf, data, size);
    assert_true(pdf_set_title(&pdf, &size, "Boxes: 1 µm (new)", &(Error){0}));
    const char *path = temporary_path("titled.pdf");
    assert_ok(file_write(path, pdf, size, &error), error);
    free(pdf);
    expect_first_line("pdfinfo", path, "Title:           Boxes: 1 µm (new)");
}

static void a_file_with_a_table_gets_a_title(void **state) {
    (void)state;
    Error error = {0};
    Sketch sketch;
    size_t size;
    sketch_begin(&sketch, 30, 20);
    strcpy(sketch.title, "old");
    char *pdf = sketch_as_pdf(&sketch, &(SketchOutput){.dpi = 100}, &size, &error);
    assert_ok(pdf != NULL, error);
    sketch_free(&sketch);
    expect_titled(pdf, size);
    free(pdf);
}

/* The smallest page whose cross-references are a stream. */
static void a_file_with_a_stream_gets_a_title(void **state) {
    (void)state;
    static const char *const objects[] = {"<</Type/Catalog/Pages 2 0 R>>", "<</Type/Pages/Kids[3 0 R]/Count 1>>",
                                          "<</Type/Page/Parent 2 0 R/MediaBox[0 0 10 10]>>"};
    char pdf[2000] = "%PDF-1.5\n";
    size_t size = strlen(pdf), offsets[5] = {0};
    for (int i = 0; i < 3; i++) {
        offsets[i + 1] = size;
        size += (size_t)snprintf(pdf + size, sizeof pdf - size, "%d 0 obj\n%s\nendobj\n", i + 1, objects[i]);
    }
    offsets[4] = size;
    size += (size_t)snprintf(pdf + size, sizeof pdf - size,
                             "4 0 obj\n<</Type/XRef/Size 5/W[1 2 1]/Root 1 0 R/Length 20>>\nstream\n");
    for (int i = 0; i < 5; i++) {
        pdf[size++] = i > 0;
        pdf[size++] = (char)(offsets[i] >> 8), pdf[size++] = (char)(offsets[i] & 255);
        pdf[size++] = 0;
    }
    size +=
        (size_t)snprintf(pdf + size, sizeof pdf - size, "\nendstream\nendobj\nstartxref\n%zu\n%%%%EOF\n", offsets[4]);
    expect_titled(pdf, size);
}

static void other_files_stay_as_they_are(void **state) {
    (void)state;
    static const char *const files[] = {"", "startxref", "%PDF-1.5\nstartxref\n99999\n%%EOF\n",
                                        "%PDF-1.5\n1 0 obj\n<</Type/Page>>\nendobj\nstartxref\n9\n%%EOF\n",
                                        "xref\n0 1\ntrailer\n<</Size 1>>\nstartxref\n0\n%%EOF\n"};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        size_t size = strlen(files[i]);
        char *pdf = malloc(size + 1), *before = pdf;
        assert_non_null(pdf);
        memcpy(pdf, files[i], size + 1);
        Error error = {0};
        assert_false(pdf_set_title(&pdf, &size, "title", &error));
        assert_error(error, ERROR_SYSTEM, "produced a PDF file of an unknown form");
        assert_ptr_equal(pdf, before);
        assert_string_equal(pdf, files[i]);
        free(pdf);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_file_with_a_table_gets_a_title),
                                       cmocka_unit_test(a_file_with_a_stream_gets_a_title),
                                       cmocka_unit_test(other_files_stay_as_they_are)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
