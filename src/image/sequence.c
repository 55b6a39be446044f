/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "image/sequence.h"

#include "common/array.h"
#include "common/file.h"
#include "common/utf8.h"

#include <dirent.h>
#include <errno.h>
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
    return name[0] != '.' && ending != NULL && strcasecmp(ending, ".png") == 0;
}

/* Splits a name into stem and number; 19 or more digits do not count as a number. */
static void read_name(SequenceFrame *frame) {
    enum { DIGITS = 18 };
    const char *ending = strrchr(frame->name, '.'), *end = ending != NULL ? ending : frame->name + strlen(frame->name);
    const char *digits = end;
    while (digits > frame->name && digits[-1] >= '0' && digits[-1] <= '9') digits--;
    bool numbered = digits < end && end - digits <= DIGITS;
    frame->number = numbered ? strtoll(digits, NULL, 10) : -1;
    frame->stem = (int)((numbered ? digits : end) - frame->name);
}

/* `folder` is the path before the name, including the slash. */
static bool add_frame(ImageSequence *sequence, size_t *capacity, const char *folder, const char *name, Error *error) {
    size_t size = strlen(folder) + strlen(name) + 1;
    if (!name_is_text(name))
        return error_input(error, folder, "a file name in it is not UTF-8 or has control characters");
    char *path = malloc(size);
    if (path == NULL ||
        !array_reserve((void **)&sequence->frames, capacity, (size_t)sequence->count + 1, sizeof *sequence->frames)) {
        free(path);
        return error_memory(error, folder);
    }
    snprintf(path, size, "%s%s", folder, name);
    SequenceFrame *frame = &sequence->frames[sequence->count++];
    *frame = (SequenceFrame){.path = path, .name = path + strlen(folder)};
    read_name(frame);
    return true;
}

static int by_stem(const SequenceFrame *x, const SequenceFrame *y) {
    int common = x->stem < y->stem ? x->stem : y->stem, order = memcmp(x->name, y->name, (size_t)common);
    return order != 0 ? order : (x->stem > y->stem) - (x->stem < y->stem);
}

static int by_number(const SequenceFrame *x, const SequenceFrame *y) {
    return (x->number > y->number) - (x->number < y->number);
}

static int by_stem_and_number(const void *a, const void *b) {
    int order = by_stem(a, b);
    return order != 0 ? order : by_number(a, b);
}

static bool sort(ImageSequence *sequence, Error *error) {
    if (sequence->count == 0) return true;
    qsort(sequence->frames, (size_t)sequence->count, sizeof *sequence->frames, by_stem_and_number);
    for (int i = 1; i < sequence->count; i++)
        if (by_stem_and_number(&sequence->frames[i], &sequence->frames[i - 1]) == 0)
            return error_input(error, sequence->frames[i].path, "has the same number as %s",
                               sequence->frames[i - 1].path);
    return true;
}

static bool list_folder(ImageSequence *sequence, const char *path, Error *error) {
    DIR *folder = opendir(path);
    if (folder == NULL) return error_input(error, path, "cannot be read: %s", strerror(errno));
    char before[4096];
    size_t capacity = 0, length = strlen(path);
    bool ok = snprintf(before, sizeof before, "%s%s", path, path[length - 1] == '/' ? "" : "/") < (int)sizeof before ||
              error_input(error, path, "the name is too long");
    for (struct dirent *entry; ok && (entry = readdir(folder)) != NULL;)
        if (is_png(entry->d_name)) ok = add_frame(sequence, &capacity, before, entry->d_name, error);
    closedir(folder);
    return ok && sort(sequence, error);
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

ImageSequence *image_sequence_open(const char *path, Error *error) {
    struct stat status;
    if (stat(path, &status) != 0) {
        error_input(error, path, "cannot be read: %s", strerror(errno));
        return NULL;
    }
    ImageSequence *sequence = calloc(1, sizeof *sequence);
    if (sequence == NULL) {
        error_memory(error, path);
        return NULL;
    }
    sequence->single = !S_ISDIR(status.st_mode);
    sequence->folder = folder_of(path, sequence->single);
    if (sequence->folder == NULL) error_memory(error, path);
    if (sequence->folder != NULL &&
        (sequence->single ? take_file(sequence, path, error) : list_folder(sequence, path, error)))
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

static bool has_one_stem(const ImageSequence *sequence) {
    return sequence->count > 0 && by_stem(&sequence->frames[0], &sequence->frames[sequence->count - 1]) == 0;
}

SequencePair *image_sequence_pair(const ImageSequence *a, const ImageSequence *b, int *count, Error *error) {
    *count = 0;
    if (a->single != b->single) {
        error_input(error, (a->single ? b : a)->folder, "is a folder, but %s is a file",
                    (a->single ? a : b)->frames[0].path);
        return NULL;
    }
    SequencePair *pairs = malloc(((size_t)a->count + (size_t)b->count + 1) * sizeof *pairs);
    if (pairs == NULL) {
        error_memory(error, a->folder);
        return NULL;
    }
    bool numbers_alone = has_one_stem(a) && has_one_stem(b);
    for (int i = 0, j = 0; i < a->count || j < b->count;) {
        const SequenceFrame *x = i < a->count ? &a->frames[i] : NULL, *y = j < b->count ? &b->frames[j] : NULL;
        int order = x == NULL       ? 1
                    : y == NULL     ? -1
                    : a->single     ? 0
                    : numbers_alone ? by_number(x, y)
                                    : by_stem_and_number(x, y);
        pairs[(*count)++] = (SequencePair){order <= 0 ? x : NULL, order >= 0 ? y : NULL};
        i += order <= 0;
        j += order >= 0;
    }
    return pairs;
}
