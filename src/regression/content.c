/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Names regions by their surroundings, as content.h defines it for content_name(). */
#include "regression/content.h"

#include "base/base.h"
#include "base/numbers.h"
#include "pixels/png.h"
#include "regression/compare.h"
#include "regression/regression_internal.h"
#include "regression/naming.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What a region is called while the others are looked at. */
typedef struct Verdict {
    ChangeKind kind; /* CHANGE_OTHER: not known yet */
    Motion motion;
    Patch *patch;
} Verdict;

/* Of the squared difference: what a movement explains, and where it looks like noise; what either picture must show,
   and if a movement explains all: one side of a gradient has nearly the colour of its ground. */
static const double MOVED = 0.7, CERTAIN = 0.9, BOTH = 0.15, TRACE = 0.02;

/* Whether something of these patches appears and something vanishes. Where content leaves, the difference has the other
   sign than where it arrives; a box that grew on one side has one sign. */
static bool shows_both(const Patch *const *patches, int count, double least) {
    enum { EVIDENCE = 12 }; /* pixels; fewer fit to many offsets by chance */
    double energy[DOT_KINDS] = {0}, total = 0, rise = 0, fall = 0;
    int dots = 0;
    for (int i = 0; i < count; i++) {
        dots += patches[i]->count;
        total += patches[i]->total, rise += patches[i]->rise, fall += patches[i]->fall;
        for (int k = 0; k < DOT_KINDS; k++) energy[k] += patches[i]->energy[k];
    }
    if (dots < EVIDENCE) return false;
    const double either = (energy[DOT_CHANGES] + energy[DOT_EDGE]) / 2;
    return energy[DOT_APPEARS] + either >= least * total && energy[DOT_VANISHES] + either >= least * total &&
           fmin(rise, fall) >= least * (rise + fall);
}

static ChangeKind kind_of_patch(const Patch *patch) {
    enum { SMALL = 8 };
    static const double MOST = 0.75, LITTLE = 0.1, EACH = 0.1;
    const double appears = patch_share(patch, DOT_APPEARS), vanishes = patch_share(patch, DOT_VANISHES);
    if (appears >= MOST && vanishes <= LITTLE) return CHANGE_APPEARED;
    if (vanishes >= MOST && appears <= LITTLE) return CHANGE_DISAPPEARED;
    if (traits_are_recoloured(&patch->traits)) return CHANGE_COLOUR;
    if (traits_are_small(&patch->traits, SMALL)) return CHANGE_NOISE;
    if ((appears >= EACH && vanishes >= EACH) || patch_share(patch, DOT_CHANGES) >= MOST) return CHANGE_REPLACED;
    return CHANGE_UNSURE;
}

static bool judge_region(const Image *const pictures[2], const uint8_t *masked, const ImageRegion *region,
                         bool scattered, const Motion *hint, Verdict *verdict, Error *error) {
    const Patch *patch = verdict->patch = patch_create(pictures, masked, region, error);
    if (patch == NULL) return false;
    const bool noise = scattered || traits_are_noise(&patch->traits);
    if (!scattered && shows_both(&patch, 1, TRACE)) verdict->motion = content_motion(&patch, 1, hint);
    const double enough = !shows_both(&patch, 1, BOTH) ? MOTION_EXACT : noise ? CERTAIN : MOVED;
    verdict->kind = verdict->motion.explained >= enough ? CHANGE_MOVED : noise ? CHANGE_NOISE : kind_of_patch(patch);
    return true;
}

/* Whether two regions may be the places of one thing: it left the first and came to the second, or one is a part of
   what moved in the other. */
static bool may_join(const Verdict *a, const Verdict *b) {
    static const double LITTLE = 0.35; /* where it left, little appears */
    const bool a_moved = a->kind == CHANGE_MOVED, b_moved = b->kind == CHANGE_MOVED;
    if (a->kind == CHANGE_NOISE || b->kind == CHANGE_NOISE || (a_moved && b_moved)) return false;
    if (a_moved || b_moved) return true;
    return a->kind != CHANGE_COLOUR && b->kind != CHANGE_COLOUR && patch_share(a->patch, DOT_APPEARS) <= LITTLE &&
           patch_share(b->patch, DOT_VANISHES) <= LITTLE;
}

static void join_pairs(Verdict *verdicts, int count) {
    for (int i = 0; i < count; i++)
        for (int j = 0; j < count; j++) {
            const Patch *patches[2] = {verdicts[i].patch, verdicts[j].patch};
            if (i == j || !may_join(&verdicts[i], &verdicts[j]) || !shows_both(patches, 2, BOTH)) continue;
            const Verdict *known = verdicts[i].kind == CHANGE_MOVED ? &verdicts[i] : &verdicts[j];
            const Motion motion = content_motion(patches, 2, &known->motion);
            if (motion.explained < MOVED) continue;
            verdicts[i].kind = verdicts[j].kind = CHANGE_MOVED;
            verdicts[i].motion = verdicts[j].motion = motion;
        }
}

/* Another rasterizer or compression moves and shades many things, each in its own way. */
static void find_jitter(Verdict *verdicts, int count) {
    enum { MANY = 4, FAINT = 16 };
    static const double SMALL = 2.25, ALIKE = 0.1; /* pixels */
    int small = 0, agreeing = 0;
    bool found[IMAGE_REGIONS_MAX] = {false};
    for (int i = 0; i < count; i++) {
        const Motion *a = &verdicts[i].motion;
        const bool moved = verdicts[i].kind == CHANGE_MOVED && fmax(fabs(a->right), fabs(a->down)) <= SMALL;
        found[i] = moved || verdicts[i].kind == CHANGE_NOISE || traits_are_small(&verdicts[i].patch->traits, FAINT);
        small += found[i];
        int alike = 0;
        for (int k = 0; moved && k < count; k++) {
            const Motion *b = &verdicts[k].motion;
            alike += verdicts[k].kind == CHANGE_MOVED && fabs(a->right - b->right) <= ALIKE &&
                     fabs(a->down - b->down) <= ALIKE;
        }
        if (alike > agreeing) agreeing = alike;
    }
    for (int i = 0; i < count && small >= MANY && 4 * agreeing < 3 * small; i++)
        if (found[i]) verdicts[i].kind = CHANGE_NOISE;
}

/* Regions whose pixels differ along edges only. */
static bool find_edges(const Image *const pictures[2], Verdict *verdicts, int count, Error *error) {
    static const double NEARLY_ALL = 0.9;
    const size_t width = (size_t)pictures[0]->width;
    uint8_t *edges = NULL;
    for (int i = 0; i < count; i++) {
        if (verdicts[i].kind != CHANGE_UNSURE && verdicts[i].kind != CHANGE_REPLACED) continue;
        if (traits_fill_areas(&verdicts[i].patch->traits)) continue;
        if (edges == NULL) {
            edges = calloc(width, (size_t)pictures[0]->height);
            if (edges == NULL) return error_memory(error, "regions");
            if (!antialias_mark(pictures[0], pictures[1], edges, error)) return free(edges), false;
        }
        const Patch *patch = verdicts[i].patch;
        int marked = 0;
        for (int k = 0; k < patch->count; k++)
            marked += edges[(size_t)patch->dots[k].y * width + (size_t)patch->dots[k].x] == IGNORED_EDGE;
        if (marked >= NEARLY_ALL * patch->count) verdicts[i].kind = CHANGE_NOISE;
    }
    free(edges);
    return true;
}

/* The change of this kind and amount, or -1 if there is no room for a new one. */
static int change_for(FrameChanges *changes, const Verdict *verdict) {
    static const double SAME = 0.25; /* pixels */
    const bool moved = verdict->kind == CHANGE_MOVED;
    const Change change = {.subject = SUBJECT_CONTENT,
                           .kind = verdict->kind,
                           .right = moved ? verdict->motion.right : 0,
                           .up = moved ? 0 - verdict->motion.down : 0}; /* no -0 */
    for (int i = 0; i < changes->count; i++) {
        const Change *at = &changes->list[i];
        if (at->subject == SUBJECT_CONTENT && at->kind == change.kind && fabs(at->right - change.right) < SAME &&
            fabs(at->up - change.up) < SAME)
            return i;
    }
    if (changes->count == CHANGES_MAX) return -1;
    changes->list[changes->count] = change;
    return changes->count++;
}

static void add_change(FrameChanges *changes, const Verdict *verdict, int region) {
    const int change = change_for(changes, verdict);
    changes->region_change[region] = (int16_t)change;
    if (change >= 0) changes->list[change].pixels += changes->regions.list[region].pixels;
}

/* Many regions, and all of few pixels. */
static bool are_scattered(const ImageRegions *regions) {
    return regions->count > 4 * IMAGE_REGIONS_MAX && regions->list[0].pixels <= 16;
}

/* Names the regions by their surroundings. shift: of most of them; 0, 0: not known. */
static bool name_regions(const Image *const pictures[2], const uint8_t *masked, const Motion *shift,
                         FrameChanges *changes, Error *error) {
    Verdict verdicts[IMAGE_REGIONS_MAX] = {0};
    int regions[IMAGE_REGIONS_MAX], count = 0;
    const bool scattered = are_scattered(&changes->regions);
    bool ok = true;
    for (int i = 0; ok && i < changes->regions.kept; i++) {
        if (changes->region_change[i] >= 0) continue;
        ok = judge_region(pictures, masked, &changes->regions.list[i], scattered, shift, &verdicts[count], error);
        regions[count++] = i;
    }
    if (ok) {
        join_pairs(verdicts, count);
        find_jitter(verdicts, count);
        ok = find_edges(pictures, verdicts, count, error);
    }
    for (int i = 0; ok && i < count; i++) add_change(changes, &verdicts[i], regions[i]);
    for (int i = 0; i < count; i++) free(verdicts[i].patch);
    return ok;
}

static ChangeKind kind_of_most(const ContentTraits *traits) {
    return traits_are_noise(traits) ? CHANGE_NOISE : traits_are_recoloured(traits) ? CHANGE_COLOUR : CHANGE_UNSURE;
}

void content_name_most(const ContentTraits *traits, FrameChanges *changes) {
    const Verdict verdict = {.kind = kind_of_most(traits)};
    for (int i = 0; i < changes->regions.kept; i++)
        if (changes->region_change[i] < 0) add_change(changes, &verdict, i);
}

/* Over every n-th row; levels above `most` are left out. */
static bool sum_rows(const Image *const pictures[2], const uint8_t *masked, int most, ContentTraits *traits,
                     Error *error) {
    const size_t width = (size_t)pictures[0]->width;
    uint8_t *levels = malloc(width);
    if (levels == NULL) return error_memory(error, "regions");
    for (int y = 0; y < pictures[0]->height; y += CONTENT_ROWS) {
        const size_t first = (size_t)y * width;
        (void)image_find_levels(pictures[0], pictures[1], masked, first, width, levels);
        for (size_t x = 0; x < width; x++) levels[x] = levels[x] > most ? 0 : levels[x];
        traits_add_row(traits, pictures[0]->pixels + 4 * first, pictures[1]->pixels + 4 * first, levels, 0, (int)width);
    }
    free(levels);
    return true;
}

/* The mask, or one of nothing, to add to. */
static uint8_t *copy_mask(const Image *picture, const uint8_t *masked, Error *error) {
    const size_t count = (size_t)picture->width * (size_t)picture->height;
    uint8_t *copy = calloc(count, 1);
    if (copy == NULL) return error_memory(error, "regions"), NULL;
    if (masked != NULL) memcpy(copy, masked, count);
    return copy;
}

/* The regions become those of what `left` does not ignore, and one of all the rest, at place 0 or the last. */
static bool name_apart(const Image *const pictures[2], const uint8_t *left, const ImageDifference *difference,
                       const Verdict *rest, ImageRegion all, bool first, FrameChanges *changes, Error *error) {
    ImageRegions *regions = &changes->regions;
    all.pixels = difference->pixels;
    if (!image_regions_find(pictures[0], pictures[1], left, difference, regions, error)) return false;
    if (regions->kept == IMAGE_REGIONS_MAX) regions->kept--;
    if (!name_regions(pictures, left, &(Motion){0}, changes, error)) return false;
    for (int i = 0; i < regions->kept; i++) all.pixels -= regions->list[i].pixels;
    const int at = first ? 0 : regions->kept;
    memmove(regions->list + 1, regions->list, (size_t)(regions->kept - at) * sizeof *regions->list);
    memmove(changes->region_change + 1, changes->region_change,
            (size_t)(regions->kept - at) * sizeof *changes->region_change);
    regions->list[at] = all;
    regions->kept++, regions->count++;
    add_change(changes, rest, at);
    return true;
}

/* *named: there is noise everywhere, or other colours, and something else that is stronger. */
static bool name_above(const Image *const pictures[2], const uint8_t *masked, int floor,
                       const ImageDifference *difference, FrameChanges *changes, bool *named, Error *error) {
    ContentTraits traits = {0};
    if (!sum_rows(pictures, masked, floor, &traits, error)) return false;
    const Verdict weak = {.kind = kind_of_most(&traits)};
    *named = weak.kind != CHANGE_UNSURE;
    if (!*named) return true;
    uint8_t *strong = copy_mask(pictures[0], masked, error);
    if (strong != NULL) level_mark(pictures[0], pictures[1], floor, strong);
    const ImageRegion all = {0, difference->left, difference->top, difference->right, difference->bottom};
    const bool ok = strong != NULL && name_apart(pictures, strong, difference, &weak, all, false, changes, error);
    free(strong);
    return ok;
}

/* Names what a shift explains of the difference as one region, and the rest apart. *named: that is all; or most, where
   so much differs that no region has a ground. */
static bool name_shifted(const Image *const pictures[2], const uint8_t *masked, const Motion *shift,
                         const ImageDifference *difference, FrameChanges *changes, bool *named, Error *error) {
    static const double MOST = 0.75;
    const bool filled = 2 * difference->pixels > (int64_t)pictures[0]->width * pictures[0]->height;
    const Verdict moved = {.kind = CHANGE_MOVED, .motion = *shift};
    int64_t missed;
    uint8_t *left = copy_mask(pictures[0], masked, error);
    if (left == NULL) return false;
    const ImageRegion all = content_mark_shifted(pictures[0], pictures[1], masked, shift, left, &missed);
    *named = (double)all.pixels >= (filled ? MOST : 1) * (double)(all.pixels + missed);
    const bool ok = !*named || name_apart(pictures, left, difference, &moved, all, true, changes, error);
    free(left);
    return ok;
}

/* *named: a shift explains most of the difference, and that is less to tell than its regions. Else *shift is that of
   most, which few regions tell more exactly. */
static bool find_shifted(const Image *const pictures[2], const uint8_t *masked, const ImageDifference *difference,
                         Motion *shift, FrameChanges *changes, bool *named, Error *error) {
    enum { FEW = 4 };
    if (!content_shift(pictures[0], pictures[1], pictures[0]->width, difference->pixels, shift, error)) return false;
    const double far = fmax(fabs(shift->right), fabs(shift->down));
    const bool many = changes->regions.kept >= FEW;
    *named = far > 0 && changes->count == 0 && (many || changes->regions.kept == 1 || far <= SHIFT_STRIP);
    if (*named && !name_shifted(pictures, masked, shift, difference, changes, named, error)) return false;
    if (!*named && !many) *shift = (Motion){0};
    return true;
}

static bool name_by_ground(const Image *const pictures[2], const uint8_t *masked, int floor,
                           const ImageDifference *difference, FrameChanges *changes, Error *error) {
    Motion shift = {0};
    bool named = false;
    if (floor > 0 && !name_above(pictures, masked, floor, difference, changes, &named, error)) return false;
    if (!named && changes->regions.kept > 1 && !are_scattered(&changes->regions) &&
        !find_shifted(pictures, masked, difference, &shift, changes, &named, error))
        return false;
    return named || name_regions(pictures, masked, &shift, changes, error);
}

bool content_has_ground(const ContentTraits *traits, const ImageDifference *difference, int width, int height) {
    const int64_t pixels = (int64_t)width * height;
    return pixels <= NAMING_PIXELS_MAX && (difference->pixels <= pixels / 2 || traits_floor(traits) > 0);
}

static void shift_regions(FrameChanges *changes, int down) {
    for (int i = 0; i < changes->regions.kept; i++)
        changes->regions.list[i].top += down, changes->regions.list[i].bottom += down;
}

static Image rows_of(const Image *image, int top, int count) {
    const size_t before = 4 * (size_t)image->width * (size_t)top;
    return (Image){image->width, count, image->pixels + before,
                   image->pixels16 == NULL ? NULL : image->pixels16 + before};
}

bool content_name_by_ground(const Image *expected, const Image *actual, int first, const uint8_t *masked, int floor,
                            const ImageDifference *difference, FrameChanges *changes, Error *error) {
    const int top = int_max(difference->top - CONTENT_MARGIN, first),
              bottom = int_min(difference->bottom + CONTENT_MARGIN, first + expected->height);
    const Image rows[2] = {rows_of(expected, top - first, bottom - top), rows_of(actual, top - first, bottom - top)};
    ImageDifference inside = *difference;
    inside.top -= top, inside.bottom -= top;
    if (masked != NULL) masked += (size_t)(top - first) * (size_t)expected->width;
    shift_regions(changes, -top);
    const bool ok = name_by_ground((const Image *const[2]){&rows[0], &rows[1]}, masked, floor, &inside, changes, error);
    shift_regions(changes, top);
    return ok;
}

bool content_may_be_shifted(const Image rows[2], Anchors votes[2], const ContentTraits *traits, int width, int height,
                            bool *may, Error *error) {
    enum { ENOUGH = 32, COLUMNS = 512, LITTLE = 1 << 20 };
    const int64_t pixels = (int64_t)width * height;
    *may = kind_of_most(traits) == CHANGE_UNSURE && pixels <= CONTENT_WHOLE_MAX;
    if (!*may || pixels <= LITTLE) return true;
    Motion shift = {0};
    shift_count(&votes[0], &votes[1], &shift);
    if (shift.down == 0 && rows[0].height >= ENOUGH) {
        const Image first[2] = {rows_of(&rows[0], 0, ENOUGH), rows_of(&rows[1], 0, ENOUGH)};
        const int columns = int_min(width, COLUMNS);
        if (!content_shift(&first[0], &first[1], columns, (int64_t)columns * ENOUGH, &shift, error)) return false;
    }
    *may = shift.right != 0 || shift.down != 0;
    return true;
}

/* As judge_rows() does for pictures that are read in pieces. */
static bool may_be_shifted(const Image *const pictures[2], const ContentTraits *traits,
                           const ImageDifference *difference, bool *may, Error *error) {
    const int width = pictures[0]->width, height = pictures[0]->height,
              top = int_max(difference->top - CONTENT_MARGIN, 0);
    const Image rows[2] = {rows_of(pictures[0], top, height - top), rows_of(pictures[1], top, height - top)};
    Anchors votes[2] = {0};
    bool ok = true;
    for (int y = 0; ok && y < height - top; y++)
        ok = shift_rows_add(votes, y, rows_of(&rows[0], y, 1).pixels, rows_of(&rows[1], y, 1).pixels, width, error);
    ok = ok && content_may_be_shifted(rows, votes, traits, width, height, may, error);
    free(votes[0].list), free(votes[1].list);
    return ok;
}

bool content_name(const Image *expected, const Image *actual, const uint8_t *masked, const ImageDifference *difference,
                  FrameChanges *changes, Error *error) {
    const Image *const pictures[2] = {expected, actual};
    ContentTraits traits = {0};
    if (!sum_rows(pictures, masked, 255, &traits, error)) return false;
    const int floor = changes->count == 0 ? traits_floor(&traits) : 0;
    if (content_has_ground(&traits, difference, expected->width, expected->height))
        return content_name_by_ground(expected, actual, 0, masked, floor, difference, changes, error);
    bool named = false;
    if (!may_be_shifted(pictures, &traits, difference, &named, error)) return false;
    if (named && !find_shifted(pictures, masked, difference, &(Motion){0}, changes, &named, error)) return false;
    if (!named) content_name_most(&traits, changes);
    return true;
}
