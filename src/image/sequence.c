/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "image/sequence.h"

#include "common/array.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

/* The number that a name ends in before ".png"; -1 where it has none of 1 to 18 digits. */
static int64_t frame_number(const char *name) {
    const char *ending = strrchr(name, '.');
    if (ending == NULL || strcasecmp(ending, ".png") != 0) return -1;
    const char *digits = ending;
    while (digits > name && digits[-1] >= '0' && digits[-1] <= '9') digits--;
    if (digits == ending || ending - digits > 18) return -1;
    return strtoll(digits, NULL, 10);
}

static bool add_frame(ImageSequence *sequence, size_t *capacity, const char *folder, const char *name, int64_t number,
                      Error *error) {
    size_t size = strlen(folder) + strlen(name) + 2;
    char *path = malloc(size);
    if (path == NULL ||
        !array_reserve((void **)&sequence->frames, capacity, (size_t)sequence->count + 1, sizeof *sequence->frames)) {
        free(path);
        return error_memory(error, folder);
    }
    snprintf(path, size, "%s%s%s", folder, folder[0] != '\0' ? "/" : "", name);
    sequence->frames[sequence->count++] = (SequenceFrame){number, path};
    return true;
}

static int by_number(const void *a, const void *b) {
    const SequenceFrame *x = a, *y = b;
    return (x->number > y->number) - (x->number < y->number);
}

static bool list_folder(ImageSequence *sequence, const char *path, Error *error) {
    DIR *folder = opendir(path);
    if (folder == NULL) return error_input(error, path, "cannot be read: %s", strerror(errno));
    size_t capacity = 0;
    bool ok = true;
    for (struct dirent *entry; ok && (entry = readdir(folder)) != NULL;) {
        int64_t number = frame_number(entry->d_name);
        if (number >= 0) ok = add_frame(sequence, &capacity, path, entry->d_name, number, error);
    }
    closedir(folder);
    if (!ok) return false;
    if (sequence->count == 0) return error_input(error, path, "no files named like frame_000000.png");
    qsort(sequence->frames, (size_t)sequence->count, sizeof *sequence->frames, by_number);
    for (int i = 1; i < sequence->count; i++)
        if (sequence->frames[i].number == sequence->frames[i - 1].number)
            return error_input(error, sequence->frames[i].path, "has the same number as %s",
                               sequence->frames[i - 1].path);
    return true;
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
    size_t capacity = 0;
    bool ok = S_ISDIR(status.st_mode) ? list_folder(sequence, path, error)
                                      : add_frame(sequence, &capacity, "", path, 0, error);
    if (ok) return sequence;
    image_sequence_close(sequence);
    return NULL;
}

void image_sequence_close(ImageSequence *sequence) {
    if (sequence == NULL) return;
    for (int i = 0; i < sequence->count; i++) free(sequence->frames[i].path);
    free(sequence->frames);
    free(sequence);
}

/* Both pictures of one number; the first pair that differs is kept in *difference. */
static bool compare_frame(const SequenceFrame *a, const SequenceFrame *b, SequenceDifference *difference,
                          Error *error) {
    Image *image_a = image_read_png(a->path, error);
    Image *image_b = image_a != NULL ? image_read_png(b->path, error) : NULL;
    if (image_b != NULL) {
        ImageDifference found;
        image_compare(image_a, image_b, &found);
        difference->compared++;
        difference->different += !found.equal;
        if (!found.equal && difference->first < 0) {
            difference->first = a->number;
            difference->at_first = found;
            difference->width_a = image_a->width;
            difference->height_a = image_a->height;
            difference->width_b = image_b->width;
            difference->height_b = image_b->height;
        }
    }
    bool ok = image_b != NULL;
    image_destroy(image_a);
    image_destroy(image_b);
    return ok;
}

bool image_sequence_compare(const ImageSequence *a, const ImageSequence *b, SequenceDifference *difference,
                            const Progress *progress, Error *error) {
    *difference = (SequenceDifference){.first = -1, .first_only_a = -1, .first_only_b = -1};
    for (int i = 0, j = 0; i < a->count || j < b->count;) {
        int64_t in_a = i < a->count ? a->frames[i].number : INT64_MAX;
        int64_t in_b = j < b->count ? b->frames[j].number : INT64_MAX;
        if (in_a < in_b) {
            if (difference->only_a++ == 0) difference->first_only_a = in_a;
            i++;
        } else if (in_b < in_a) {
            if (difference->only_b++ == 0) difference->first_only_b = in_b;
            j++;
        } else {
            if (!compare_frame(&a->frames[i++], &b->frames[j++], difference, error)) return false;
            if (!progress_report(progress, i, a->count))
                return error_input(error, a->frames[i - 1].path, "stopped after %d frames", difference->compared);
        }
    }
    return true;
}
