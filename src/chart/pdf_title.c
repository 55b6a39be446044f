/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "chart/pdf_title.h"

#include "common/memory_stream.h"
#include "sketch/pdf_objects.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The last cross-reference section. */
typedef struct Section {
    size_t start;   /* its offset */
    bool is_stream; /* else a table */
    long objects, root;
} Section;

/* The last place of a word in a file, which may hold zeros; NULL: none. */
static const char *find_last(const char *data, size_t size, const char *word) {
    const size_t length = strlen(word);
    for (size_t i = size < length ? 0 : size - length + 1; i-- > 0;)
        if (memcmp(data + i, word, length) == 0) return data + i;
    return NULL;
}

/* The number behind a key of the dictionary at `text`, which ends with a zero; -1: none. */
static long number_of(const char *text, const char *key) {
    const char *found = strstr(text, key);
    return found != NULL ? strtol(found + strlen(key), NULL, 10) : -1;
}

static bool find_section(const char *pdf, size_t size, Section *section) {
    char text[1024] = "";
    const char *start = find_last(pdf, size, "startxref");
    if (start == NULL) return false;
    const size_t left = size - (size_t)(start - pdf);
    snprintf(text, sizeof text, "%.*s", left < 64 ? (int)left : 64, start);
    section->start = strtoul(text + strlen("startxref"), NULL, 10);
    if (section->start >= size || size - section->start < 4) return false;
    section->is_stream = memcmp(pdf + section->start, "xref", 4) != 0;
    const char *dictionary = section->is_stream ? pdf + section->start : find_last(pdf, size, "trailer");
    if (dictionary == NULL) return false;
    const size_t room = size - (size_t)(dictionary - pdf);
    snprintf(text, sizeof text, "%.*s", room < sizeof text ? (int)room : (int)sizeof text - 1, dictionary);
    if (section->is_stream && strstr(text, "/XRef") == NULL) return false;
    section->objects = number_of(text, "/Size"), section->root = number_of(text, "/Root");
    return section->objects > 0 && section->root > 0;
}

static void put_bytes(FILE *file, size_t value, int count) {
    for (int i = count - 1; i >= 0; i--) fputc((int)(value >> 8 * i & 255), file);
}

/* Object, then its cross-reference in the kind of the last one. */
static void write_update(FILE *file, const Section *section, size_t size, const char *title) {
    fprintf(file, "\n%ld 0 obj\n<</Title", section->objects);
    pdf_put_text(file, title);
    fprintf(file, ">>\nendobj\n");
    fflush(file);
    const size_t object = size + 1, reference = (size_t)ftell(file);
    if (section->is_stream) {
        fprintf(
            file,
            "%ld 0 obj\n<</Type/XRef/Size %ld/Root %ld 0 R/Info %ld 0 R/Prev %zu/Index[%ld 2]/W[1 8 1]/Length 20>>\n"
            "stream\n",
            section->objects + 1, section->objects + 2, section->root, section->objects, section->start,
            section->objects);
        put_bytes(file, 1, 1), put_bytes(file, object, 8), put_bytes(file, 0, 1);
        put_bytes(file, 1, 1), put_bytes(file, reference, 8), put_bytes(file, 0, 1);
        fprintf(file, "\nendstream\nendobj\n");
    } else
        fprintf(file, "xref\n%ld 1\n%010zu 00000 n \ntrailer\n<</Size %ld/Root %ld 0 R/Info %ld 0 R/Prev %zu>>\n",
                section->objects, object, section->objects + 1, section->root, section->objects, section->start);
    fprintf(file, "startxref\n%zu\n%%%%EOF\n", reference);
}

bool pdf_set_title(char **pdf, size_t *size, const char *title, Error *error) {
    Section section;
    char *whole = NULL;
    size_t whole_size;
    if (!find_section(*pdf, *size, &section))
        return error_system(error, "gnuplot", "produced a PDF file of an unknown form");
    FILE *file = memory_stream(&whole, &whole_size);
    if (file == NULL) return error_memory(error, "PDF file");
    fwrite(*pdf, 1, *size, file);
    write_update(file, &section, *size, title);
    const bool done = !ferror(file);
    if (fclose(file) != 0 || !done) {
        free(whole);
        return error_memory(error, "PDF file");
    }
    free(*pdf);
    *pdf = whole, *size = whole_size;
    return true;
}
