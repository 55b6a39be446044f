/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pictures of a folder in order, and the pairs that two folders have. */
#include "regression/sequence.h"

#include "base/base.h"
#include "base/file.h"

#include <assert.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

bool name_is_text(const char *name) { return text_is_utf8(name) && control_in_text(name) == 0; }

static bool is_kind(const char *name, const char *kind) {
    const char *ending = strrchr(name, '.');
    return ending != NULL && strcasecmp(ending + 1, kind) == 0;
}

/* What programs that draw, browsers and cameras write. */
static bool is_picture(const char *name) {
    static const char *const kinds[] = {"png", "apng", "avif", "bmp", "exr", "gif",  "heic", "jpeg", "jpg",
                                        "jxl", "pgm",  "ppm",  "qoi", "svg", "tiff", "tif",  "tga",  "webp"};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (is_kind(name, kinds[i])) return true;
    return false;
}

/* Finds folder, stem and number of a frame's name. 19 or more digits do not count as a number. */
static void read_name(SequenceFrame *frame) {
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
    char *path = malloc(size);
    const bool text = name_is_text(name);
    if (path != NULL && !text) {
        snprintf(path, size, "%s%s", before, name);
        error_input(error, path, "its name is not UTF-8, or has characters that a terminal obeys; rename it");
        return free(path), false;
    }
    if (path == NULL ||
        !array_reserve((void **)&sequence->frames, capacity, (size_t)sequence->count + 1, sizeof *sequence->frames)) {
        free(path);
        return error_memory(error, before);
    }
    snprintf(path, size, "%s%s", before, name);
    SequenceFrame *frame = &sequence->frames[sequence->count++];
    *frame = (SequenceFrame){.path = path, .name = path + strlen(before)};
    read_name(frame);
    return true;
}

/* A folder's frames come before those of the folders below it. */
static int compare_parts(const char *x, int x_length, const char *y, int y_length) {
    int order = memcmp(x, y, (size_t)(x_length < y_length ? x_length : y_length));
    return order != 0 ? order : (x_length > y_length) - (x_length < y_length);
}

/* Order of frames by folder; by folder and stem; by number; by stem and number; by all of these, then name. */
static int compare_folders(const void *a, const void *b) {
    const SequenceFrame *x = a, *y = b;
    return compare_parts(x->name, x->folder, y->name, y->folder);
}

static int compare_stems(const void *a, const void *b) {
    const SequenceFrame *x = a, *y = b;
    const int order = compare_folders(x, y);
    return order != 0 ? order : compare_parts(x->name, x->stem, y->name, y->stem);
}

bool sequence_same(const SequenceFrame *x, const SequenceFrame *y) {
    return x->number >= 0 && y->number >= 0 && compare_stems(x, y) == 0;
}

static int compare_numbers(const void *a, const void *b) {
    const SequenceFrame *x = a, *y = b;
    return (x->number > y->number) - (x->number < y->number);
}

static int by_stem_and_number(const void *a, const void *b) {
    const int order = compare_stems(a, b);
    return order != 0 ? order : compare_numbers(a, b);
}

static int compare_frames(const void *a, const void *b) {
    const SequenceFrame *x = a, *y = b;
    const int order = by_stem_and_number(x, y);
    return order != 0 ? order : strcmp(x->name, y->name);
}

ImageSequence *image_sequence_open(const char *path, bool recursive, bool all_kinds, Error *error) {
    struct stat status;
    if (stat(path, &status) != 0) return folder_error(path, error), NULL;
    ImageSequence *sequence = calloc(1, sizeof *sequence);
    if (sequence == NULL) return error_memory(error, path), NULL;
    sequence->device = status.st_dev;
    sequence->inode = status.st_ino;
    sequence->single = !S_ISDIR(status.st_mode);
    /* "a/b/" -> "a/b"; for a file its folder. */
    const size_t before = file_folder_length(path);
    size_t length = sequence->single ? before : strlen(path), capacity = 0;
    while (length > 1 && path[length - 1] == '/') length--;
    sequence->folder = length == 0 ? strdup(".") : strndup(path, length);
    const bool root = !sequence->single && sequence->folder != NULL && strcmp(sequence->folder, "/") == 0;
    char *start = calloc(strlen(path) + 3, 1); /* of each picture's path */
    FolderList files = {0};
    bool ok = (sequence->folder != NULL && start != NULL) || error_memory(error, path);
    if (ok && sequence->single) {
        memcpy(start, path, before);
        ok = add_frame(sequence, &capacity, start, path + before, error);
    } else if (ok && (ok = folder_list(&files, sequence->folder, is_picture, recursive, error))) {
        sprintf(start, "%s%s", sequence->folder, root ? "" : "/");
        for (size_t i = 0; ok && i < files.count; i++) {
            const char *name = files.names[i];
            if (all_kinds || is_kind(name, "png"))
                ok = add_frame(sequence, &capacity, start, name, error);
            else if (sequence->others++ < 3 && name_is_text(name))
                text_join(sequence->other_names, sizeof sequence->other_names, ", ", "%.30s", name);
        }
        sequence->skipped = (int)files.skipped;
        folder_list_free(&files);
        if (ok && sequence->count > 0)
            qsort(sequence->frames, (size_t)sequence->count, sizeof *sequence->frames, compare_frames);
    }
    free(start);
    if (ok) return sequence;
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

/* Frames in the order of compare_frames(). */
typedef struct Range {
    const SequenceFrame **frames;
    int count;
} Range;

static SequenceFrame *find(const ImageSequence *sequence, const SequenceFrame *key,
                           int (*compare)(const void *, const void *)) {
    if (sequence->count == 0) return NULL;
    return bsearch(key, sequence->frames, (size_t)sequence->count, sizeof *sequence->frames, compare);
}

/* home.png for home.1.png, if that is another accepted picture for it. If `b` has any home.N.png, these are frames. */
static SequenceFrame *accepted_for(const ImageSequence *a, const ImageSequence *b, const SequenceFrame *frame) {
    char name[PATH_MAX];
    int dot = frame->stem - 1;
    if (frame->number < 1 || dot <= frame->folder || frame->name[dot] != '.' || frame->name[frame->stem] == '0')
        return NULL;
    if (snprintf(name, sizeof name, "%.*s%s", dot, frame->name, strrchr(frame->name, '.')) >= (int)sizeof name)
        return NULL;
    SequenceFrame key = {.name = name};
    read_name(&key);
    if (find(b, &key, compare_frames) == NULL || find(b, frame, compare_stems) != NULL) return NULL;
    return find(a, &key, compare_frames);
}

/* The frames of `a` that can make pairs; the others are linked to theirs. */
static Range take_frames(const ImageSequence *a, const ImageSequence *b, const SequenceFrame **frames) {
    int at = a->count;
    for (int i = a->count - 1; i >= 0; i--) {
        SequenceFrame *frame = &a->frames[i], *other = b != NULL ? accepted_for(a, b, frame) : NULL;
        if (other == NULL) {
            frames[--at] = frame;
        } else { /* from the last one, so that the list is in order */
            frame->next = other->next;
            other->next = frame;
        }
    }
    return (Range){frames + at, a->count - at};
}

typedef struct Pairing {
    SequencePair *pairs;
    int count;
} Pairing;

static void put(Pairing *pairing, const SequenceFrame *a, const SequenceFrame *b) {
    pairing->pairs[pairing->count++] = (SequencePair){a, b};
}

static const SequenceFrame *find_name(Range range, const char *name) {
    for (int i = 0; i < range.count; i++)
        if (strcmp(range.frames[i]->name, name) == 0) return range.frames[i];
    return NULL;
}

/* Counts the frames whose names the other range lacks, and stores the first two. */
static int count_left(Range range, Range other, const SequenceFrame *left[2]) {
    int count = 0;
    for (int i = 0; i < range.count; i++)
        if (find_name(other, range.frames[i]->name) == NULL) {
            if (count < 2) left[count] = range.frames[i];
            count++;
        }
    return count;
}

/* All frames have the same number; at most some hundred names have (01, 001, ...). */
static bool pair_group(Pairing *pairing, Range a, Range b, Error *error) {
    const SequenceFrame *left_a[2], *left_b[2];
    int count_a = count_left(a, b, left_a), count_b = count_left(b, a, left_b);
    bool one = count_a == 1 && count_b == 1;
    if (count_a > 0 && count_b > 0 && !one) {
        const SequenceFrame *const *both = count_a > 1 ? left_a : left_b,
                                   *partner = count_a > 1 ? left_b[0] : left_a[0];
        return error_input(error, both[1]->path, "has the same number as %s: which of them belongs to %s?",
                           both[0]->name, partner->path);
    }
    for (int i = 0; i < a.count; i++) {
        const SequenceFrame *same = find_name(b, a.frames[i]->name);
        put(pairing, a.frames[i], same != NULL ? same : one ? left_b[0] : NULL);
    }
    for (int i = 0; i < b.count && !one; i++)
        if (find_name(a, b.frames[i]->name) == NULL) put(pairing, NULL, b.frames[i]);
    return true;
}

/* Takes the first frames for which `compare` finds no difference; none unless `any`. */
static Range take_leading(Range *range, bool any, int (*compare)(const void *, const void *)) {
    assert(range->count == 0 || range->frames[0] != NULL);
    Range leading = {range->frames, any};
    while (any && leading.count < range->count && compare(range->frames[0], range->frames[leading.count]) == 0)
        leading.count++;
    range->frames += leading.count;
    range->count -= leading.count;
    return leading;
}

typedef bool PairRanges(Pairing *pairing, Range a, Range b, Error *error);

/* Calls pair_ranges for each part of both ranges that has one place in the order of `compare`. */
static bool merge(Pairing *pairing, Range a, Range b, int (*compare)(const void *, const void *),
                  PairRanges *pair_ranges, Error *error) {
    while (a.count > 0 || b.count > 0) {
        int order = a.count == 0 ? 1 : b.count == 0 ? -1 : compare(a.frames[0], b.frames[0]);
        Range first = take_leading(&a, order <= 0, compare), second = take_leading(&b, order >= 0, compare);
        if (!pair_ranges(pairing, first, second, error)) return false;
    }
    return true;
}

static bool pair_folder(Pairing *pairing, Range a, Range b, Error *error) {
    const bool numbers_alone = a.count > 0 && b.count > 0 && sequence_same(a.frames[0], a.frames[a.count - 1]) &&
                               sequence_same(b.frames[0], b.frames[b.count - 1]);
    return merge(pairing, a, b, numbers_alone ? compare_numbers : by_stem_and_number, pair_group, error);
}

SequencePair *image_sequence_pair(const ImageSequence *a, const ImageSequence *b, int *count, Error *error) {
    *count = 0;
    if (a->single != b->single)
        return error_input(error, (a->single ? b : a)->folder, "is a folder, but %s is a file",
                           (a->single ? a : b)->frames[0].path),
               NULL;
    size_t most = (size_t)a->count + (size_t)b->count + 1;
    Pairing pairing = {.pairs = malloc(most * sizeof *pairing.pairs)};
    const SequenceFrame **frames = calloc(most, sizeof *frames);
    bool ok = (pairing.pairs != NULL && frames != NULL) || error_memory(error, a->folder);
    if (ok && a->single) {
        put(&pairing, &a->frames[0], &b->frames[0]);
    } else if (ok) {
        const Range first = take_frames(a, b, frames), second = take_frames(b, NULL, frames + a->count);
        ok = merge(&pairing, first, second, compare_folders, pair_folder, error);
    }
    free(frames);
    *count = ok ? pairing.count : 0;
    if (ok) return pairing.pairs;
    free(pairing.pairs);
    return NULL;
}
