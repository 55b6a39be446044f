/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pages of a study. */
#include "base/base.h"
#include "base/file.h"
#include "base/machine.h"
#include "cli/page_set.h"
#include "pictures/player.h"
#include "runs/pieces.h"
#include "runs/trajectory.h"
#include "studies/piece_tables.h"

#include <inttypes.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The last two fields of a row, without a moment: "pages/NAME.html" and BYTES. */
static char *page_of(char *row, int64_t *bytes) {
    char *comma = strrchr(row, ',');
    *bytes = atoll(comma + 1);
    *comma = '\0';
    char *page = strrchr(row, ',') + 1;
    page[strcspn(page, "#")] = '\0';
    return page;
}

static void count_row(PageSet *set, char *row) {
    int64_t bytes;
    const char *page = page_of(row, &bytes);
    if (page[0] == '\0') {
        set->left_out++;
        return;
    }
    if (strcmp(page, set->last) == 0) return;
    snprintf(set->last, sizeof set->last, "%s", page);
    set->pages++;
    set->bytes += bytes;
}

/* The pages of the parts before this one, whichever run wrote them. */
static bool count_parts(PageSet *set, int64_t part, Error *error) {
    for (; set->counted < part; set->counted++) {
        size_t size;
        char *rows = pieces_read(&set->pieces, set->counted, &size, NULL, error), *rest = rows;
        if (rows == NULL) return false;
        for (char *row; (row = strtok_r(rest, "\n", &rest)) != NULL;) count_row(set, row);
        free(rows);
    }
    return true;
}

static void page_set_describe(void *context, int64_t part, PieceInfo *info) {
    (void)context;
    snprintf(info->name, sizeof info->name, "pages %" PRId64, part + 1);
    info->weight = 1;
    info->alone = true; /* whether there is room for a page depends on those before */
}

static bool page_set_work(void *context, int64_t part, FILE *rows, const Progress *progress, Error *error) {
    PageSet *set = context;
    return count_parts(set, part, error) && set->write(set->context, (int)part, rows, progress, error);
}

/* The study's own pieces are in another folder, and shards have no pages. */
static bool open_parts(PageSet *set, uint64_t key, Error *error) {
    Pieces *pieces = &set->pieces;
    *pieces = (Pieces){.shard = {1, 1}, .key = key ^ UINT64_C(0x7061676573)};
    set->plan = (PiecePlan){.count = set->parts, .describe = page_set_describe, .work = page_set_work, .context = set};
    return file_path(pieces->folder, sizeof pieces->folder, error, "%s/parts-%016" PRIx64, set->folder, pieces->key);
}

bool page_set_make(PageSet *set, uint64_t key, const Progress *progress, Error *error) {
    char pages[PATH_MAX];
    return file_path(pages, sizeof pages, error, "%s/pages", set->folder) && file_make_directory(pages, error) &&
           open_parts(set, key, error) && pieces_do(&set->pieces, &set->plan, progress, error) &&
           count_parts(set, set->parts, error) &&
           piece_tables_write(&set->pieces, set->folder, &set->layout, 1, NULL, 0, error);
}

bool page_set_end(const PageSet *set, Error *error) { return pieces_end(&set->pieces, error); }

static int frames_of(const Trajectory *const *runs, int count, const PlayerOptions *options) {
    int most = 0;
    for (int i = 0; i < count; i++) most = runs[i]->frames > most ? runs[i]->frames : most;
    return (options->last < 0 || options->last >= most ? most : options->last + 1) - options->first;
}

/* A page of all frames if its states fit, else of every n-th. */
static int every_that_fits(const Trajectory *const *runs, int count, const PlayerOptions *options) {
    double bytes = 0;
    for (int i = 0; i < count; i++) bytes += 6.0 * sizeof(float) * runs[i]->bodies;
    bytes *= frames_of(runs, count, options);
    return 1 + (int)(bytes / PAGE_SET_STATE_BYTES);
}

bool page_set_write(const PageSet *set, const char *name, const Trajectory *const *runs, int count,
                    const PlayerOptions *options, PageFile *file, Error *error) {
    char path[PATH_MAX], plain[PAGE_NAME_SIZE - sizeof "pages/.html"];
    PlayerResult result;
    *file = (PageFile){0};
    if (set->bytes >= PAGE_SET_MAX_BYTES) return true;
    PlayerOptions fitting = *options;
    fitting.every = every_that_fits(runs, count, options);
    snprintf(plain, sizeof plain, "%s", name);
    file_name_clean(plain);
    if (!file_path(path, sizeof path, error, "%s/pages/%s.html", set->folder, plain) ||
        !player_write(runs, count, &fitting, path, &result, error))
        return false;
    snprintf(file->path, sizeof file->path, "pages/%s.html", plain);
    file->bytes = (int)result.bytes;
    return true;
}

void page_set_link(char link[PAGE_LINK_SIZE], const PageFile *file, double time, int body, int run) {
    char moment[PLAYER_LINK_SIZE];
    link[0] = '\0';
    if (file->path[0] == '\0') return;
    player_link(moment, time, body);
    snprintf(link, PAGE_LINK_SIZE, "%s%s", file->path, moment);
    if (body >= 0 && run > 0) text_add(link, PAGE_LINK_SIZE, "&run=%d", run);
}

void page_set_print(const PageSet *set, const char *html) {
    printf("%d page%s of %.3g MB together -> %s/pages; links to them -> %s/%s\n", set->pages, plural(set->pages),
           (double)set->bytes / 1e6, set->folder, set->folder, html);
    if (set->left_out > 0)
        printf("    without a page, as pages take at most %d MB: %d\n", PAGE_SET_MAX_BYTES >> 20, set->left_out);
}
