/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pieces/piece_file.h"

#include "common/file.h"
#include "common/hash.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { HEAD_SIZE = 512 };

/* Everything before the results. The same head and results have one text, which is compared when it is read. */
static int print_head(char text[HEAD_SIZE], const PieceHead *head, const void *results, size_t size) {
    return snprintf(text, HEAD_SIZE,
                    "twinbox piece 1\nkey %016" PRIx64 "\nnumber %" PRId64
                    "\nname %s\ncpu %s\nbytes %zu\nhash %016" PRIx64 "\n\n",
                    head->key, head->number, head->name, head->cpu, size, hash_xxh3(results, size));
}

bool piece_file_write(const char *path, const PieceHead *head, const void *results, size_t size, Error *error) {
    char text[HEAD_SIZE];
    if (size > PIECE_MAX_SIZE - HEAD_SIZE)
        return error_system(error, path, "the results of '%s' are too large: %zu bytes", head->name, size);
    const size_t length = (size_t)print_head(text, head, results, size);
    char *whole = malloc(length + size);
    if (whole == NULL) return error_memory(error, path);
    memcpy(whole, text, length);
    if (size > 0) memcpy(whole + length, results, size);
    const bool done = file_write(path, whole, length + size, error);
    free(whole);
    return done;
}

/* Copies the rest of the line "cpu ..." of a head. */
static void find_cpu(const char *text, char cpu[CPU_NAME_SIZE]) {
    const char *line = strstr(text, "\ncpu ");
    cpu[0] = '\0';
    if (line == NULL) return;
    line += strlen("\ncpu ");
    snprintf(cpu, CPU_NAME_SIZE, "%.*s", (int)strcspn(line, "\n"), line);
}

/* Whether the study is another, to say so. */
static bool refuse(const char *path, const char *text, const PieceHead *head, Error *error) {
    unsigned long long key;
    char name[PIECE_NAME_SIZE];
    if (sscanf(text, "twinbox piece 1\nkey %16llx\n", &key) != 1)
        return error_input(error, path, "is not a piece of a study; delete it");
    if (key != head->key)
        return error_input(error, path, "is a piece of another study (key %016llx, not %016llx); delete it", key,
                           (unsigned long long)head->key);
    if (sscanf(text, "twinbox piece 1\nkey %*16x\nnumber %*d\nname %127[^\n]", name) == 1 &&
        strcmp(name, head->name) != 0)
        return error_input(error, path, "is the piece '%s', not '%s'; delete it", name, head->name);
    return error_input(error, path, "is damaged or cut off; delete it, and its shard does it again");
}

char *piece_file_read(const char *path, PieceHead *head, size_t *size, Error *error) {
    char expected[HEAD_SIZE];
    size_t whole;
    char *text = file_read(path, PIECE_MAX_SIZE, &whole, error);
    if (text == NULL) return NULL;
    const char *end = strstr(text, "\n\n");
    const size_t length = end != NULL ? (size_t)(end - text) + strlen("\n\n") : whole;
    find_cpu(text, head->cpu);
    *size = whole - length;
    const size_t wanted = (size_t)print_head(expected, head, text + length, *size);
    if (end == NULL || length != wanted || memcmp(expected, text, length) != 0) {
        refuse(path, text, head, error);
        free(text);
        return NULL;
    }
    memmove(text, text + length, *size + 1);
    return text;
}
