/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Things of several textures, moved by 1 to 40 pixels in eight directions: told by how much. */
#include "content_changes.h"
#include "made.h"

#include <math.h>

enum { WIDTH = 240, HEIGHT = 200, LEFT = 90, TOP = 80, ACROSS = 60, DOWN = 40, FAR = 40 };

typedef int Texture(int x, int y); /* a level, of a pixel of the thing */

static int even(int x, int y) { return (void)x, (void)y, 40; }
static int along(int x, int y) { return (void)y, 3 * x; }
static int across(int x, int y) { return (void)x, 200 - 4 * y; }
static int frame(int x, int y) { return x < 2 || y < 2 || x >= ACROSS - 2 || y >= DOWN - 2 ? 0 : 190; }
static int noise(int x, int y) {
    const uint32_t mixed = ((uint32_t)(x + 1) * 2654435761U ^ (uint32_t)(y + 7) * 2246822519U) * 3266489917U;
    return (int)(mixed >> 25);
}

static Image *page(Texture *texture, int right, int down) {
    Image *image = image_sized(WIDTH, HEIGHT);
    memset(image->pixels, 255, (size_t)4 * WIDTH * HEIGHT);
    for (int y = 0; y < DOWN; y++)
        for (int x = 0; x < ACROSS; x++)
            memset(image->pixels + 4 * ((TOP + down + y) * WIDTH + LEFT + right + x), texture(x, y), 3);
    return image;
}

/* Whether all regions moved by this. */
static bool moved_by(const FrameChanges *changes, int right, int down) {
    bool all = changes->regions.kept > 0;
    for (int k = 0; k < changes->regions.kept; k++) {
        const Change *change = &changes->list[changes->region_change[k]];
        all = all && change->kind == CHANGE_MOVED && fabs(change->right - right) < 0.1 && fabs(change->up + down) < 0.1;
    }
    return all;
}

TEST(things_move_by_what_they_moved) {
    static Texture *const textures[] = {even, along, across, frame, noise};
    static const int steps[][2] = {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
    enum { TEXTURES = sizeof textures / sizeof textures[0], DIRECTIONS = sizeof steps / sizeof steps[0] };
    for (int i = 0; i < TEXTURES * DIRECTIONS; i++)
        for (int far = 1; far <= FAR; far++) {
            const int x = far * steps[i % DIRECTIONS][0], y = far * steps[i % DIRECTIONS][1];
            Texture *texture = textures[i / DIRECTIONS];
            const FrameChanges changes = changes_of(page(texture, 0, 0), page(texture, x, y));
            if (!moved_by(&changes, x, y))
                fail_msg("texture %d that moved by (%d, %d) is not told so", i / DIRECTIONS, x, y);
        }
}

/* Lines of random letters. */
static void write_lines(Image *image, int from, int left) {
    for (int y = from, line = 0; y < HEIGHT; y++, line++)
        for (int x = left; x < WIDTH - 20 && line % 10 < 6; x++) {
            const bool ink = noise((x - left) / 2 + line / 10 * 977, line) > 90;
            memset(image->pixels + 4 * (y * WIDTH + x), ink ? 0 : 255, 3);
        }
}

/* What follows a banner, or stands beside a new column, has moved by its size. */
TEST(what_follows_something_new_moves) {
    for (int turned = 0; turned < 2; turned++)
        for (int size = 7; size <= 47; size += 20) {
            Image *a = image_sized(WIDTH, HEIGHT), *b = image_sized(WIDTH, HEIGHT);
            memset(a->pixels, 255, (size_t)4 * WIDTH * HEIGHT);
            memset(b->pixels, 255, (size_t)4 * WIDTH * HEIGHT);
            write_lines(a, 10, 10);
            write_lines(b, turned ? 10 : 10 + size, turned ? 10 + size : 10);
            const FrameChanges changes = changes_of(a, b);
            int64_t moved = 0, all = 0;
            for (int k = 0; k < changes.regions.kept; k++) {
                const int64_t pixels = changes.regions.list[k].pixels;
                const Change *change = &changes.list[changes.region_change[k]];
                const bool right = fabs(change->right - turned * size) < 0.1,
                           down = fabs(change->up + (1 - turned) * size) < 0.1;
                moved += change->kind == CHANGE_MOVED && right && down ? pixels : 0, all += pixels;
            }
            if (10 * moved < 7 * all)
                fail_msg("turned %d, size %d: %lld of %lld pixels", turned, size, (long long)moved, (long long)all);
        }
}

/* A page of lines, or noise all over, that lies at (right, down). */
static void write_shifted(Image *image, bool page, int right, int down) {
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const int u = x - right + 64, v = y - down + 64; /* from 0 */
            const bool line = u % 320 > 100 && v % 12 < 6 && v > 100 && v < HEIGHT;
            const int level = page ? line && noise(u / 2 + v / 12 * 977, v) > 90 ? 0 : 255 : noise(u, v);
            memset(image->pixels + 4 * (y * WIDTH + x), level, 3);
            image->pixels[4 * (y * WIDTH + x) + 3] = 255;
        }
}

/* A whole picture that is shifted is one region, of any texture and in any direction; but nothing is told that another
   change breaks. */
TEST(a_shift_of_everything_is_one_region) {
    static const int shifts[][2] = {{3, 0}, {0, 5}, {2, 3}, {-7, 4}, {-1, -16}};
    for (size_t i = 0; i < 2 * sizeof shifts / sizeof shifts[0]; i++)
        for (int broken = 0; broken < 2; broken++) {
            const int *by = shifts[i / 2];
            Image *a = image_sized(WIDTH, HEIGHT), *b = image_sized(WIDTH, HEIGHT);
            write_shifted(a, i % 2 == 0, 0, 0);
            write_shifted(b, i % 2 == 0, by[0], by[1]);
            for (int y = 0; y < 6 * broken; y++)
                memset(b->pixels + 4 * ((HEIGHT / 2 + y) * WIDTH + WIDTH / 2), 128, 24);
            ImageDifference difference;
            image_compare(a, b, &difference);
            const FrameChanges changes = changes_of(a, b);
            const ImageRegion *region = &changes.regions.list[0];
            const Change *change = &changes.list[changes.region_change[0]];
            const bool whole = changes.regions.count == 1 && changes.count == 1 && change->kind == CHANGE_MOVED &&
                               fabs(change->right - by[0]) < 0.01 && fabs(change->up + by[1]) < 0.01 &&
                               region->pixels == difference.pixels && region->left == difference.left &&
                               region->bottom == difference.bottom;
            if (whole == broken)
                fail_msg("%zu regions where all moved by (%d, %d)%s", (size_t)changes.regions.count, by[0], by[1],
                         broken ? " but one thing" : "");
        }
}

/* Most of a picture of more than a megapixel is shifted, and stays so small a part that no region has a ground. */
TEST(what_follows_a_banner_moves_in_large_pictures) {
    enum { ACROSS_ALL = 1100, DOWN_ALL = 1000, HEADER = 24, ROW = 4 * ACROSS_ALL };
    for (int banner = 30; banner <= 150; banner += 60) {
        Image *a = image_sized(ACROSS_ALL, DOWN_ALL), *b = image_sized(ACROSS_ALL, DOWN_ALL);
        for (int i = 0; i < ACROSS_ALL * DOWN_ALL; i++) memset(a->pixels + 4 * i, noise(i, i / ACROSS_ALL), 4);
        memcpy(b->pixels, a->pixels, (size_t)HEADER * ROW);
        memset(b->pixels + HEADER * ROW, 200, (size_t)banner * ROW);
        memcpy(b->pixels + (HEADER + banner) * ROW, a->pixels + HEADER * ROW,
               (size_t)(DOWN_ALL - HEADER - banner) * ROW);
        const FrameChanges changes = changes_of(a, b);
        const Change *change = &changes.list[changes.region_change[0]];
        if (change->kind != CHANGE_MOVED || fabs(change->up + banner) > 0.01 || fabs(change->right) > 0.01)
            fail_msg("a banner of %d rows: kind %d, %g up", banner, (int)change->kind, change->up);
        if (changes.regions.kept != 2 || changes.regions.list[0].top != HEADER + banner ||
            changes.regions.list[1].top != HEADER)
            fail_msg("a banner of %d rows: %d regions, the first from %d", banner, changes.regions.kept,
                     changes.regions.list[0].top);
    }
}

RUN_TESTS(NULL, NULL)
