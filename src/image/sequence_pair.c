/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "image/sequence.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Frames in the order of sequence_compare_frames(). */
typedef struct Range {
    const SequenceFrame **frames;
    int count;
} Range;

static SequenceFrame *find(const ImageSequence *sequence, const SequenceFrame *key,
                           int (*compare)(const void *, const void *)) {
    if (sequence->count == 0) return NULL;
    return bsearch(key, sequence->frames, (size_t)sequence->count, sizeof *sequence->frames, compare);
}

static int compare_stems(const void *x, const void *y) { return sequence_compare_stems(x, y); }

/* home.png for home.1.png, if that is another accepted picture for it. If `b` has any home.N.png, these are frames. */
static SequenceFrame *accepted_for(const ImageSequence *a, const ImageSequence *b, const SequenceFrame *frame) {
    char name[PATH_MAX];
    int dot = frame->stem - 1;
    if (frame->number < 1 || dot <= frame->folder || frame->name[dot] != '.' || frame->name[frame->stem] == '0')
        return NULL;
    if (snprintf(name, sizeof name, "%.*s%s", dot, frame->name, strrchr(frame->name, '.')) >= (int)sizeof name)
        return NULL;
    SequenceFrame key = {.name = name};
    sequence_read_name(&key);
    if (find(b, &key, sequence_compare_frames) == NULL || find(b, frame, compare_stems) != NULL) return NULL;
    return find(a, &key, sequence_compare_frames);
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
static Range take_leading(Range *range, bool any, int (*compare)(const SequenceFrame *, const SequenceFrame *)) {
    Range leading = {range->frames, any};
    while (any && leading.count < range->count && compare(range->frames[0], range->frames[leading.count]) == 0)
        leading.count++;
    range->frames += leading.count;
    range->count -= leading.count;
    return leading;
}

static int by_stem_and_number(const SequenceFrame *x, const SequenceFrame *y) {
    int order = sequence_compare_stems(x, y);
    return order != 0 ? order : sequence_compare_numbers(x, y);
}

static bool has_one_numbered_stem(Range range) {
    return range.count > 0 && range.frames[0]->number >= 0 &&
           sequence_compare_stems(range.frames[0], range.frames[range.count - 1]) == 0;
}

typedef bool PairRanges(Pairing *pairing, Range a, Range b, Error *error);

/* Calls pair_ranges for each part of both ranges that has one place in the order of `compare`. */
static bool merge(Pairing *pairing, Range a, Range b, int (*compare)(const SequenceFrame *, const SequenceFrame *),
                  PairRanges *pair_ranges, Error *error) {
    while (a.count > 0 || b.count > 0) {
        int order = a.count == 0 ? 1 : b.count == 0 ? -1 : compare(a.frames[0], b.frames[0]);
        Range first = take_leading(&a, order <= 0, compare), second = take_leading(&b, order >= 0, compare);
        if (!pair_ranges(pairing, first, second, error)) return false;
    }
    return true;
}

static bool pair_folder(Pairing *pairing, Range a, Range b, Error *error) {
    bool numbers_alone = has_one_numbered_stem(a) && has_one_numbered_stem(b);
    return merge(pairing, a, b, numbers_alone ? sequence_compare_numbers : by_stem_and_number, pair_group, error);
}

static bool pair_sequences(Pairing *pairing, const ImageSequence *a, const ImageSequence *b,
                           const SequenceFrame **frames, Error *error) {
    if (a->single) {
        put(pairing, &a->frames[0], &b->frames[0]);
        return true;
    }
    Range first = take_frames(a, b, frames), second = take_frames(b, NULL, frames + a->count);
    return merge(pairing, first, second, sequence_compare_folders, pair_folder, error);
}

SequencePair *image_sequence_pair(const ImageSequence *a, const ImageSequence *b, int *count, Error *error) {
    *count = 0;
    if (a->single != b->single) {
        error_input(error, (a->single ? b : a)->folder, "is a folder, but %s is a file",
                    (a->single ? a : b)->frames[0].path);
        return NULL;
    }
    size_t most = (size_t)a->count + (size_t)b->count + 1;
    Pairing pairing = {.pairs = malloc(most * sizeof *pairing.pairs)};
    const SequenceFrame **frames = malloc(most * sizeof *frames);
    bool ok = pairing.pairs != NULL && frames != NULL ? pair_sequences(&pairing, a, b, frames, error)
                                                      : error_memory(error, a->folder);
    free(frames);
    *count = pairing.count;
    if (ok) return pairing.pairs;
    free(pairing.pairs);
    *count = 0;
    return NULL;
}
