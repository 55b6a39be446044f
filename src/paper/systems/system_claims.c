/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/systems/system_claims.h"

#include "common/file.h"
#include "common/memory_stream.h"
#include "paper/systems/system.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

const char *const claim_holds_words[CLAIM_HOLDS + 1] = {"no", "partly", "yes"};

static const CsvColumn columns[] = {
    {"system", CSV_NAME, .offset = offsetof(ClaimRow, system), .key = true},
    {"claim", CSV_TEXT, .offset = offsetof(ClaimRow, claim), .maximum = CLAIM_TEXT_SIZE, .quoted = true, .key = true},
    {"source", CSV_TEXT, .offset = offsetof(ClaimRow, source), .maximum = CLAIM_TEXT_SIZE, .quoted = true},
    {"measured", CSV_TEXT, .offset = offsetof(ClaimRow, measured), .maximum = CLAIM_TEXT_SIZE, .quoted = true},
    {"figure", CSV_TEXT, .offset = offsetof(ClaimRow, figure), .maximum = CLAIM_TEXT_SIZE, .quoted = true},
    {"holds", CSV_WORD, .offset = offsetof(ClaimRow, holds), .words = claim_holds_words},
};
const CsvLayout claim_layout = CSV_LAYOUT("systems", columns, ClaimRow, .max_rows = 100);

ClaimHolds claim_at_least(double value, double yes, double partly) {
    return value >= yes ? CLAIM_YES : value >= partly ? CLAIM_PARTLY : CLAIM_NO;
}

ClaimHolds claim_at_most(double value, double yes, double partly) {
    return value <= yes ? CLAIM_YES : value <= partly ? CLAIM_PARTLY : CLAIM_NO;
}

ClaimHolds claim_in_cases(int holding, int cases) {
    return holding == 0 ? CLAIM_NO : holding == cases ? CLAIM_YES : CLAIM_PARTLY;
}

/* What does not fit could not be read back. */
static bool check_text(const Claims *claims, const char *text, Error *error) {
    return (text[0] != '\0' && strlen(text) <= CLAIM_TEXT_SIZE) ||
           error_input(error, claims->system, "a text of a claim has 1 to %d bytes (got '%s')", CLAIM_TEXT_SIZE, text);
}

/* A number that was not measured becomes a dash, which has as many bytes. */
static void show_dashes(char *figure) {
    static const char dash[] = "–";
    _Static_assert(sizeof dash == sizeof "nan", "the text keeps its length");
    for (char *at = strstr(figure, "nan"); at != NULL; at = strstr(at, "nan")) {
        char *begin = at > figure && at[-1] == '-' ? at - 1 : at;
        memmove(begin, at, strlen(at) + 1);
        memcpy(begin, dash, sizeof dash - 1);
    }
}

bool claim_state(const Claims *claims, const Claim *claim, Error *error, const char *format, ...) {
    char figure[CLAIM_TEXT_SIZE + 2];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(figure, sizeof figure, format, arguments);
    va_end(arguments);
    show_dashes(figure);
    const ClaimRow row = {claims->system, claim->claim, claim->source, claim->measured, figure, (int)claim->holds};
    return check_text(claims, row.claim, error) && check_text(claims, row.source, error) &&
           check_text(claims, row.measured, error) && check_text(claims, row.figure, error) &&
           csv_row_print(claims->lines, &claim_layout, &row, error);
}

static bool state_all(const PaperSystem *const *systems, Claims *claims, Error *error) {
    csv_header_print(claims->lines, &claim_layout);
    for (int i = 0; systems[i] != NULL; i++) {
        claims->system = systems[i]->name;
        if (!systems[i]->claim(claims, error)) return false;
    }
    return true;
}

bool system_claims_write(const PaperSystem *const *systems, const char *folder, Error *error) {
    char path[CSV_PATH_SIZE], *text = NULL;
    size_t size;
    CsvTable scores;
    if (!csv_table_path(path, folder, &claim_layout, error) ||
        !csv_table_read_from(&scores, folder, &system_score_layout, error))
        return false;
    Claims claims = {.folder = folder, .scores = scores.rows, .score_count = scores.count};
    claims.lines = memory_stream(&text, &size);
    bool written = claims.lines != NULL || error_memory(error, path);
    if (claims.lines != NULL) {
        written = state_all(systems, &claims, error);
        const bool whole = !ferror(claims.lines);
        if ((fclose(claims.lines) != 0 || !whole) && written) written = error_memory(error, path);
    }
    written = written && file_write(path, text, size, error);
    free(text);
    csv_table_free(&scores);
    return written;
}
