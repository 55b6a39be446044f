/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "image/sequence.h"

#include "common/array.h"
#include "common/file.h"
#include "common/folder.h"
#include "common/utf8.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

bool name_is_text(const char *name) {
    size_t length, left = strlen(name);
    for (; left > 0; name += length, left -= length) {
        uint32_t character;
        length = utf8_decode(name, left, &character);
        if (length == 0 || character < 0x20 || (character >= 0x7F && character < 0xA0)) return false;
    }
    return true;
}

static bool is_png(const char *name) {
    const char *ending = strrchr(name, '.');
    return ending != NULL && strcasecmp(ending, ".png") == 0;
}

/* 19 or more digits do not count as a number. */
void sequence_read_name(SequenceFrame *frame) {
    enum { DIGITS = 18 };
    frame->folder = (int)file_folder_length(frame->name);
    const char *base = frame->name + frame->folder, *ending = strrchr(base, '.');
    const char *end = ending != NULL ? ending : base + strlen(base), *digits = end;
    while (digits > base && digits[-1] >= '0' && digits[-1] <= '9') digits--;
    bool numbered = digits < end && end - digits <= DIGITS;
    frame->number = numbered ? strtoll(digits, NULL, 10) : -1;
    frame->stem = (int)((numbered ? digits : end) - frame->name);
}

/* `before` is the path before the name, including the slash. */
static bool add_frame(ImageSequence *sequence, size_t *capacity, const char *before, const char *name, Error *error) {
    size_t size = strlen(before) + strlen(name) + 1;
    if (!name_is_text(name))
        return error_input(error, before, "a file name in it is not UTF-8 or has control characters");
    char *path = malloc(size);
    if (path == NULL ||
        !array_reserve((void **)&sequence->frames, capacity, (size_t)sequence->count + 1, sizeof *sequence->frames)) {
        free(path);
        return error_memory(error, before);
    }
    snprintf(path, size, "%s%s", before, name);
    SequenceFrame *frame = &sequence->frames[sequence->count++];
    *frame = (SequenceFrame){.path = path, .name = path + strlen(before)};
    sequence_read_name(frame);
    return true;
}

/* A folder's frames come before those of the folders below it. */
static int compare_parts(const char *x, int x_length, const char *y, int y_length) {
    int order = memcmp(x, y, (size_t)(x_length < y_length ? x_length : y_length));
    return order != 0 ? order : (x_length > y_length) - (x_length < y_length);
}

int sequence_compare_folders(const SequenceFrame *x, const SequenceFrame *y) {
    return compare_parts(x->name, x->folder, y->name, y->folder);
}

int sequence_compare_stems(const SequenceFrame *x, const SequenceFrame *y) {
    int order = sequence_compare_folders(x, y);
    return order != 0 ? order : compare_parts(x->name, x->stem, y->name, y->stem);
}

int sequence_compare_numbers(const SequenceFrame *x, const SequenceFrame *y) {
    return (x->number > y->number) - (x->number < y->number);
}

int sequence_compare_frames(const void *x, const void *y) {
    const SequenceFrame *a = x, *b = y;
    int order = sequence_compare_stems(a, b);
    if (order == 0) order = sequence_compare_numbers(a, b);
    return order != 0 ? order : strcmp(a->name, b->name);
}

static bool list_pictures(ImageSequence *sequence, bool recursive, Error *error) {
    FolderList files;
    size_t capacity = 0, length = strlen(sequence->folder) + 2;
    if (!folder_list(&files, sequence->folder, is_png, recursive, error)) return false;
    char *before = malloc(length);
    bool ok = before != NULL || error_memory(error, sequence->folder);
    if (ok) snprintf(before, length, "%s%s", sequence->folder, strcmp(sequence->folder, "/") == 0 ? "" : "/");
    for (size_t i = 0; ok && i < files.count; i++) ok = add_frame(sequence, &capacity, before, files.names[i], error);
    sequence->skipped = (int)files.skipped;
    free(before);
    folder_list_free(&files);
    if (ok && sequence->count > 0)
        qsort(sequence->frames, (size_t)sequence->count, sizeof *sequence->frames, sequence_compare_frames);
    return ok;
}

static bool take_file(ImageSequence *sequence, const char *path, Error *error) {
    size_t capacity = 0;
    char *before = strndup(path, file_folder_length(path));
    bool ok = before != NULL ? add_frame(sequence, &capacity, before, path + strlen(before), error)
                             : error_memory(error, path);
    free(before);
    return ok;
}

/* "a/b/" -> "a/b"; for a file its folder. */
static char *folder_of(const char *path, bool single) {
    size_t length = single ? file_folder_length(path) : strlen(path);
    while (length > 1 && path[length - 1] == '/') length--;
    return length == 0 ? strdup(".") : strndup(path, length);
}

ImageSequence *image_sequence_open(const char *path, bool recursive, Error *error) {
    struct stat status;
    if (stat(path, &status) != 0) {
        folder_error(path, error);
        return NULL;
    }
    ImageSequence *sequence = calloc(1, sizeof *sequence);
    if (sequence == NULL) {
        error_memory(error, path);
        return NULL;
    }
    sequence->device = status.st_dev;
    sequence->inode = status.st_ino;
    sequence->single = !S_ISDIR(status.st_mode);
    sequence->folder = folder_of(path, sequence->single);
    if (sequence->folder == NULL) error_memory(error, path);
    if (sequence->folder != NULL &&
        (sequence->single ? take_file(sequence, path, error) : list_pictures(sequence, recursive, error)))
        return sequence;
    image_sequence_close(sequence);
    return NULL;
}

void image_sequence_close(ImageSequence *sequence) {
    if (sequence == NULL) return;
    for (int i = 0; i < sequence->count; i++) free(sequence->frames[i].path);
    free(sequence->frames);
    free(sequence->folder);
    free(sequence);
}
