/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a comparison left out, or let pass although it is not equal. */
#include "common/text_add.h"
#include "common/utf8.h"
#include "regression/regression.h"

#include <stdarg.h>
#include <string.h>

/* Adds a line if there is anything to count. */
static void add(RegressionText *notes, int count, const char *format, ...) PRINTF_LIKE(3, 4);
static void add(RegressionText *notes, int count, const char *format, ...) {
    size_t used = strlen(notes->text), room = sizeof notes->text - used;
    va_list arguments;
    if (count == 0) return;
    va_start(arguments, format);
    if (used > 0 && room > 1) notes->text[used++] = '\n', room--;
    vsnprintf(notes->text + used, room, format, arguments);
    va_end(arguments);
}

RegressionText regression_notes(const Regression *regression) {
    RegressionText notes = {""};
    enum { NAME = 100 }; /* of each name, so that all notes fit */
    const ImageSequence *const *sides = (const ImageSequence *const *)regression->sequences;
    bool same = sides[EXPECTED]->device == sides[ACTUAL]->device && sides[EXPECTED]->inode == sides[ACTUAL]->inode;
    add(&notes, same, "expected and actual are the same %s", sides[EXPECTED]->single ? "file" : "folder");
    int accepted = regression->other_accepted, metadata = regression->metadata;
    add(&notes, accepted, "%d frame%s passed by another accepted picture", accepted, plural(accepted));
    if (metadata > 0) {
        const RegressionFrame *first = &regression->frames[regression->first_metadata];
        add(&notes, metadata, "metadata differs in %d frame%s, first in %.*s: %s%s", metadata, plural(metadata),
            (int)utf8_cut(frame_name(first), NAME), frame_name(first), first->metadata.text,
            regression->options.strict_metadata ? "" : " (--metadata strict fails)");
    }
    int left_out = regression->runs_left_out, foreign = regression->runs_foreign;
    const char *expected = regression->sequences[EXPECTED]->folder;
    add(&notes, left_out, "not compared: %d .npz file%s only in %.*s", left_out, plural(left_out),
        (int)utf8_cut(expected, NAME), expected);
    add(&notes, foreign, "not compared: %d .npz file%s without a trajectory", foreign, plural(foreign));
    for (RegressionSide side = EXPECTED; side < SIDES; side++) {
        const ImageSequence *sequence = regression->sequences[side];
        add(&notes, sequence->skipped, "not compared: %d picture%s in subfolders of %.*s (--no-recursive)",
            sequence->skipped, plural(sequence->skipped), (int)utf8_cut(sequence->folder, NAME), sequence->folder);
    }
    return notes;
}
