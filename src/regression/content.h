/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What happened to a region, in pictures of which nothing else is known: it moved, appeared, vanished, has other
   colours. */
#pragma once
#include "base/base.h"
#include "pixels/png.h"
#include "regression/compare.h"
#include "regression/naming.h"

#include <stdlib.h>

/* Names the regions that have no name yet, each by the pixels in it and around it. masked as in image_compare_masked().
   Both pictures have one size. False with error set if out of memory.

   A differing pixel is compared with its ground: the nearest pixels to the left, to the right, above and below that are
   equal in both pictures. If the expected pixel looks like its ground and the actual one does not, something appears
   there; or it vanishes; or changes, if neither does. Where both do, an edge has moved. The first of these that holds
   is the name:

   moved       an offset explains seven tenths of the squared difference: what appears came from it, and what vanishes
               went to it. Regions that something left are tried with those where something came, and each with one that
               moved
   noise       small differences that neighbours do not share, or scattered pixels
   added       at least three quarters of the squared difference appear, and no more than a tenth vanishes
   removed     the same with vanish
   recoloured  the steps between neighbours are at the same places, and one linear map of colours explains the
               difference
   noise       small differences of any pattern, or nine tenths of the pixels differ only along edges (antialias_mark())
   replaced    something appears and something vanishes, a tenth each at least, or colours change without their pattern

   If a shift explains all that differs, that is one region; or most, where more than half of the picture differs.
   Anything else is unsure. At last, faint regions and those that moved by at most two pixels become noise, if they are
   four or more and did not move alike. If noise lies all over a picture, the stronger regions are named without it, and
   the noise is one more region.

   Fails: a faint watermark beside noise is noise; glyphs that another rasterizer moves all by the same have moved; a
   new band of colour under lines and one that changed from white are the same picture. tests/bench/compare/changes
   measures it. */
bool content_name(const Image *expected, const Image *actual, const uint8_t *masked, const ImageDifference *difference,
                  FrameChanges *changes, Error *error);

/* Sums over pixels, for what is known without surroundings. */
enum { MAPPED = 4 };

typedef struct ContentTraits {
    double pixels;            /* that differ */
    double sum[3];            /* differences of red, green and blue, */
    double absolute, square;  /* their sizes and squares, over all three */
    double pairs, shared;     /* neighbours that both differ, and the products of their differences */
    double product, steps[2]; /* sizes of steps to neighbours: products of both pictures, squares of each */
    double from[MAPPED][MAPPED], to[MAPPED][3]; /* normal equations of a linear map from colours to differences */
    int64_t levels[256];                        /* pixels by difference */
} ContentTraits;

/* The sum of the channels' differences of two pixels. */
static inline int pixel_distance(const uint8_t *p, const uint8_t *q) {
    return abs(p[0] - q[0]) + abs(p[1] - q[1]) + abs(p[2] - q[2]) + abs(p[3] - q[3]);
}

enum { CONTENT_ROWS = 32 }; /* of a picture, every n-th row is enough */

/* Adds a row of RGBA pixels. levels[width] as of image_find_levels(); pixels up to `weak` make no steps. */
void traits_add_row(ContentTraits *traits, const uint8_t *a, const uint8_t *b, const uint8_t *levels, int weak,
                    int width);

/* Adds a pixel of both pictures and the neighbour that follows after `next` bytes. both: that one differs, too. */
void traits_add_pair(ContentTraits *traits, const uint8_t *a, const uint8_t *b, size_t next, bool both);

bool traits_are_small(const ContentTraits *traits, int level); /* differences of at most that on average */
bool traits_fill_areas(const ContentTraits *traits);           /* and are not only along edges */
bool traits_are_noise(const ContentTraits *traits);
bool traits_are_recoloured(const ContentTraits *traits);

/* The level that noise all over the picture reaches, if there is something stronger, too; else 0. */
int traits_floor(const ContentTraits *traits);

/* Whether enough of a picture is equal to be ground, and it has at most NAMING_PIXELS_MAX. */
bool content_has_ground(const ContentTraits *traits, const ImageDifference *difference, int width, int height);

/* Gives all regions that have no name the same: noise, recoloured, or unsure. */
void content_name_most(const ContentTraits *traits, FrameChanges *changes);

enum { CONTENT_WHOLE_MAX = 10000000 }; /* pixels of a picture that is read again as a whole, if rows do not tell */
enum { CONTENT_MARGIN = 3 };           /* pixels around a region that are its ground */

/* Names regions as content_name() does where enough of a picture is equal. The pictures begin with row `first` of the
   whole ones, and have those that differ and CONTENT_MARGIN around; only these are looked at, so that a name does not
   depend on how much was read. floor: of traits_floor(). */
bool content_name_by_ground(const Image *expected, const Image *actual, int first, const uint8_t *masked, int floor,
                            const ImageDifference *difference, FrameChanges *changes, Error *error);

/* The rows of pictures that are read row by row, from the first difference to the last: a quarter of them at most, and
   of 16 MB. */
typedef struct ContentBand {
    int width, first, count, capacity;
    uint8_t *rows[2];
    int64_t pixels;             /* that differ so far */
    int below;                  /* equal rows since one that differs */
    bool differs, closed, lost; /* a row differs; rows between were not given, or are too many; one of those differs */
} ContentBand;

void content_band_begin(ContentBand *band, int width, int height);

/* pixels: how many differ up to this row. False if out of memory. */
bool content_band_add(ContentBand *band, int y, const uint8_t *a, const uint8_t *b, int64_t pixels);
void content_band_end(ContentBand *band);

/* The rows that it has of a picture; it must not be lost. */
Image content_band_rows(const ContentBand *band, int picture);

/* A region as content sees it. */

typedef enum DotKind { DOT_APPEARS, DOT_VANISHES, DOT_CHANGES, DOT_EDGE, DOT_KINDS } DotKind;

typedef struct Dot {
    int x, y; /* of a pixel */
    DotKind kind;
} Dot;

enum { DOTS_MAX = 1024 };

typedef struct Patch {
    const Image *pictures[2];        /* expected, actual */
    ViewRect box[2];                 /* of what the expected and the actual picture have; empty: right < left */
    double energy[DOT_KINDS], total; /* squared differences */
    double rise, fall;               /* sums of differences by sign */
    ContentTraits traits;
    ImageRegion region;
    int count;
    Dot dots[DOTS_MAX]; /* all differing pixels of the region, or every n-th */
} Patch;

/* To be freed. NULL with error set if out of memory. */
Patch *patch_create(const Image *const pictures[2], const uint8_t *masked, const ImageRegion *region, Error *error);
double patch_share(const Patch *patch, DotKind kind); /* of the squared difference */

/* How far content moved: pixels, to the right and down. */
typedef struct Motion {
    double right, down;
    double explained; /* share of the squared difference */
} Motion;

/* The offset that explains most of one region, or of two: the one that something left, and the one where it arrived. Of
   several that explain all, the smallest: an even thing that moved by less than its size looks the same moved farther.
   `hint` is tried as well. */
static const double MOTION_EXACT = 0.999; /* explains all */
Motion content_motion(const Patch *const *patches, int count, const Motion *hint);

/* How far most of what differs has moved, such as what follows a banner; 0, 0 if it does not agree. The pictures have
   one size, and `pixels` of those in their middle `columns` differ. ERROR_MEMORY. */
bool content_shift(const Image *expected, const Image *actual, int columns, int64_t pixels, Motion *shift,
                   Error *error);

/* What a shift explains of the difference: its pixels and bounds. They become IGNORED_RULE in `left`, a mask. *missed:
   what it does not explain, without a strip that it uncovers, where anything may be. */
enum { SHIFT_STRIP = 16 }; /* pixels: strips up to this wide belong to the shift */
ImageRegion content_mark_shifted(const Image *expected, const Image *actual, const uint8_t *masked, const Motion *shift,
                                 uint8_t *left, int64_t *missed);

/* Places of two pictures by a hash of what they show there. */
typedef struct Anchor {
    uint64_t hash;
    int x, y;
} Anchor;

typedef struct Anchors {
    Anchor *list;
    size_t count, capacity;
    uint64_t every; /* one of so many windows, a power of two */
} Anchors;

/* Adds a row of both pictures, if it differs, by some of its pixels: for a shift up or down. ERROR_MEMORY. */
bool shift_rows_add(Anchors rows[2], int y, const uint8_t *a, const uint8_t *b, int width, Error *error);

/* The shift that at least half of the anchors agree on, of those that stand once in each picture; 0, 0: they do not
   agree. Sorts the lists, and leaves shifts in the actual one. */
void shift_count(Anchors *expected, Anchors *actual, Motion *shift);

/* *may: a picture of this size, of whose pixels more than half differ, may be shifted, as far as its rows, or `first`,
   the first ones that differ, tell; then it is worth being read as a whole. */
bool content_may_be_shifted(const Image first[2], Anchors rows[2], const ContentTraits *traits, int width, int height,
                            bool *may, Error *error);
