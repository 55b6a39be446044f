/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Comparison of PNG sequences: pairs, masks, differing pixels and their regions. */
#pragma once
#include "base/base.h"
#include "pixels/png.h"

#include <stddef.h>
#include <stdint.h>

/* PNG sequences: files of a folder whose names consist of a stem and a number, such as frame_000123.png. A folder
   may hold several sequences (stems), pictures without number, and subfolders with pictures. A single file is a
   sequence of one. */

typedef struct SequenceFrame {
    char *path;
    const char
        *name;  /* relative to the compared folder ("sub/x.png"), the end of `path`: UTF-8 without control characters */
    int folder; /* length of the name's folder with its slash, 0 if it has none */
    int stem;   /* length of the name up to the number in bytes, with the folder */
    int64_t number;             /* -1: none */
    struct SequenceFrame *next; /* another accepted picture for the same name, set by image_sequence_pair(); or NULL */
} SequenceFrame;

typedef struct ImageSequence {
    uint64_t device, inode; /* of the file or folder */
    char *folder;           /* "." for a bare file name */
    bool single;            /* one file, not a folder */
    int count;
    SequenceFrame *frames; /* [count], sorted by folder, stem, number, name */
    int skipped;           /* pictures in subfolders that were not to be read */
} ImageSequence;

/* The PNG files of a folder (possibly none) and, if recursive, of its subfolders; or one file. Files are found as
   folder_list() finds them. ERROR_INPUT if there is no such path, or if a name is not text. */
ImageSequence *image_sequence_open(const char *path, bool recursive, Error *error);
void image_sequence_close(ImageSequence *sequence);

typedef struct SequencePair {
    const SequenceFrame *a, *b; /* NULL if the other sequence lacks the frame */
} SequencePair;

/* Pairs the frames of each folder: those of equal names first, then those of equal stem and number. If both folders
   have one stem and only numbered frames, numbers alone decide. Two single files are a pair.

   home.1.png, home.2.png ... in `a` are further accepted pictures for home.png if both sequences have home.png and `b`
   has no home.N.png: they make no pair, but follow home.png by `next`.

   malloc'ed, sorted by folder, stem and number. NULL with error set if out of memory, for a file and a folder, or if
   several frames of equal number could make a pair. */
SequencePair *image_sequence_pair(const ImageSequence *a, const ImageSequence *b, int *count, Error *error);
int sequence_compare_stems(const SequenceFrame *x, const SequenceFrame *y);

/* Whether a name is UTF-8 without characters that a terminal obeys (control_in_text()). */
bool name_is_text(const char *name);

/* Comparison of two pictures, pixel by pixel. */

/* If the sizes differ, only same_size is set. */
typedef struct ImageDifference {
    bool equal, same_size;
    int64_t pixels;               /* differing and not ignored */
    int64_t beyond;               /* of these, those that differ by more than the tolerance */
    int64_t moved;                /* differing, but ignored: IGNORED_EDGE, IGNORED_RULE */
    int64_t counted;              /* not masked */
    int largest;                  /* largest difference of a channel, 0..255, rounded up */
    int first_x, first_y;         /* first differing pixel, row by row; -1, -1 if none */
    int left, top, right, bottom; /* bounds of the differences; right and bottom are exclusive */
} ImageDifference;
void image_compare(const Image *a, const Image *b, ImageDifference *difference);

/* The difference of channel i of a from channel j of b, 0..255, rounded up. */
int image_channel_difference(const Image *a, size_t i, const Image *b, size_t j);

/* The largest difference of a channel of one pixel, as above. Both pictures must have the same size. */
int image_pixel_difference(const Image *a, const Image *b, size_t pixel);

/* The next pixel from x on that may differ, in the row that begins at pixel `first`; `width` if there is none. Certain
   where both pictures have 8 bits. */
size_t image_next_difference(const Image *a, const Image *b, size_t first, size_t x);

/* masked[height, width]: Ignored; NULL: nothing is ignored. tolerance: 0..255. */
void image_compare_masked(const Image *a, const Image *b, const uint8_t *masked, int tolerance,
                          ImageDifference *difference);

/* The parts of it: levels, the largest difference of a channel of each pixel as above, and their counts. */

/* levels[count] of RGBA pixels. */
void image_levels(const uint8_t *a, const uint8_t *b, size_t count, uint8_t *levels);

/* levels[count] from pixel `first` on, 0 where masked. Returns how many differ, but are ignored and not masked. */
int64_t image_find_levels(const Image *a, const Image *b, const uint8_t *masked, size_t first, size_t count,
                          uint8_t *levels);

/* Whether rows of pictures of equal size may differ; certain where both have 8 bits. */
bool image_row_differs(const Image *a, const Image *b, int y);

/* Adds a row to the difference of pictures of equal size; rows are added from the top. */
void image_count_levels(ImageDifference *difference, int y, const uint8_t *levels, int count, int tolerance);

/* Cuts both pictures to their overlap: what both have when their top left corners meet. */
void image_cut_to_overlap(Image *a, Image *b);

/* Pixels that a comparison ignores: rectangles, pictures and colours. */

enum { MASK_PARTS = 64 };

typedef enum MaskKind { MASK_RECTANGLE, MASK_PICTURE, MASK_COLOR } MaskKind;

typedef struct MaskPart {
    MaskKind kind;
    int x, y, width, height;     /* of a rectangle, which may extend beyond the edges */
    struct MaskPicture *picture; /* masks where it is neither black nor transparent */
    uint8_t color[3];            /* masks opaque pixels that have this colour in the expected picture */
} MaskPart;

typedef struct Mask {
    int count;
    MaskPart parts[MASK_PARTS];
} Mask;

/* ERROR_INPUT for more than MASK_PARTS parts or an unreadable picture; its pixels are decompressed when it is drawn. */
bool mask_add_rectangle(Mask *mask, int x, int y, int width, int height, Error *error);
bool mask_add_picture(Mask *mask, const char *path, Error *error);
bool mask_add_color(Mask *mask, const uint8_t color[3], Error *error);
void mask_free(Mask *mask);

/* What a byte of masked[height, width] tells of its pixel. Pixels that are not IGNORED_NOT are ignored. */
typedef enum Ignored {
    IGNORED_NOT,
    IGNORED_MASK,
    IGNORED_EDGE, /* differs as parts of an edge may: antialias_mark() */
    IGNORED_RULE  /* differs as a rule allows: shift_mark(), level_mark() */
} Ignored;

/* Sets the masked bytes to IGNORED_MASK. ERROR_INPUT if a picture has another size than the expected picture, or pixels
   that are damaged; `path` names the expected picture in the message. Threads may share a mask. */
bool mask_draw(const Mask *mask, const Image *expected, const char *path, uint8_t *masked, Error *error);

/* Copies the ignored pixels of `expected` to `actual`; masked NULL: none. Both pictures must have the same size. */
void image_copy_masked(const Image *expected, Image *actual, const uint8_t *masked);

/* Chunks of PNG files that change how equal pixels are displayed: the colour space (cICP, iCCP, sRGB, gAMA, cHRM), its
   range (mDCV, cLLI, sBIT), the background (bKGD), the shape and size of a pixel (pHYs) and the orientation in eXIf
   (PNG specification, third edition, sections 11.3.2 to 11.3.4). */

/* "gAMA 0.45455 and none, orientation 1 and 6" */
typedef struct PngDisplay {
    char text[256];
} PngDisplay;

/* Finds what differs between two files; an empty text if nothing does. Each chunk is compared by itself, although some
   viewers ignore gAMA beside iCCP. Colour profiles are compared uncompressed. Both files must be valid up to their
   ends, as png_check() or image_decode_png() finds. False with error set when memory is short. */
bool png_display_compare(const uint8_t *a, size_t a_size, const uint8_t *b, size_t b_size, PngDisplay *display,
                         Error *error);

/* Where two pictures differ: clusters of differing pixels. Two differing pixels belong to one region if a chain of
   differing pixels links them whose steps are at most the gap, in x and in y. So a moved box is one or two regions, and
   so is a caption. Time is linear in the pixels and memory in the width, whatever the pictures show. */

enum { IMAGE_REGIONS_MAX = 16 };

typedef struct ImageRegion {
    int64_t pixels;               /* differing */
    int left, top, right, bottom; /* bounds; right and bottom are exclusive */
} ImageRegion;

typedef struct ImageRegions {
    int64_t count; /* of all regions */
    int kept;
    ImageRegion list[IMAGE_REGIONS_MAX]; /* [kept], the largest: most pixels first, then by top, then by left */
} ImageRegions;

/* The gap in pixels for pictures of this size: the space between two words of a caption, or more. */
int image_regions_gap(int width, int height);

/* Row by row, from the top; rows without a difference may be left out. levels[width] as above. NULL with error set if
   out of memory. The regions are complete, and must last, until the end. */
typedef struct RegionScan RegionScan;
RegionScan *region_scan_create(int width, int height, ImageRegions *regions, Error *error);
void region_scan_row(RegionScan *scan, int y, const uint8_t *levels);
void region_scan_end(RegionScan *scan, int height);
void region_scan_destroy(RegionScan *scan); /* NULL: does nothing */

/* `difference` is what image_compare_masked() found in the same pictures and mask. False with error set if out of
   memory. */
bool image_regions_find(const Image *a, const Image *b, const uint8_t *masked, const ImageDifference *difference,
                        ImageRegions *regions, Error *error);
