/* SPDX-License-Identifier: GPL-3.0-or-later */
/* All letters of films can be read: of panels, time lines and both cards, none is cut, shortened, on another one, on a
   box or arrow, or across the edge of a panel or a rule. */
#include "testing.h"

#include "made.h"
#include "methods/methods.h"
#include "pictures/pictures_internal.h"
#include "pictures/picture.h"

enum { RUNS = RENDER_PANELS_MAX, OPAQUE = 128 }; /* opacity, of 255, from which a pixel is part of a letter */

static const char *const files[RUNS] = {"trajectories/stack-engine", "trajectories/stack-pair-net",
                                        "gallery/stack-momentum",    "gallery/stack-contact-net",
                                        "gallery/stack-interior",    "gallery/stack-reference"};
static Trajectory *runs[RUNS];
static const Trajectory *panels[RUNS];
static unsigned ellipses[FONT_FACES * FONT_SIZES]; /* bitmaps */

FIXTURE(make) {
    for (int font = 0; font < FONT_FACES * FONT_SIZES; font++)
        for (int i = 0; i < FONT_GLYPHS; i++) {
            const FontGlyph *glyph = &font_glyphs[font / FONT_SIZES][font % FONT_SIZES][i];
            if (glyph->code == 0x2026) ellipses[font] = glyph->offset;
        }
    for (int i = 0; i < RUNS; i++) {
        panels[i] = runs[i] = trajectory_of(printed(SOURCE_DIR "/golden/%s.npz", files[i]));
    }
    strcpy(runs[2]->method, "playback:launches=recorded-launches.csv,k=20");
    strcpy(runs[3]->method, "exec-solver:/usr/bin/python3 adapters/sweeps.py,k=100,name=Sweeps by others");
    strcpy(runs[3]->program, "sweeps 1");
}

FIXTURE(destroy) {
    for (int i = 0; i < RUNS; i++) trajectory_destroy(runs[i]);
}

/* What a letter may be on, from below to above: rectangles, then shapes. */
typedef struct Film {
    int width, height;
    uint32_t panel; /* colour of what is behind texts in panels */
    Drawing drawing;
    uint8_t *letters; /* [height, width] 1: ink of a letter */
} Film;

static bool is_ellipsis(const GlyphInstance *glyph) {
    bool found = false;
    for (int i = 0; i < FONT_FACES * FONT_SIZES; i++) found |= ellipses[i] == glyph->bitmap;
    return found;
}

static bool has_ink(const Drawing *drawing, const GlyphInstance *glyph, int x, int y) {
    const size_t at = glyph->bitmap + (size_t)((y - glyph->box[1]) * glyph->box[2] + x - glyph->box[0]);
    return (at < font_bitmaps_size ? font_bitmaps[at] : drawing->bitmaps[at - font_bitmaps_size]) >= OPAQUE;
}

static Rect bounds_of(const Drawing *drawing, size_t thing) {
    if (thing < drawing->rect_count) return drawing->rects[thing].rect;
    const int32_t *bounds = drawing->shapes[thing - drawing->rect_count].bounds;
    return (Rect){bounds[0], bounds[1], bounds[2], bounds[3]};
}

/* Whether the middle of a pixel within its bounds is in the shape, or on its outline if it is hollow. */
static bool in_shape(const ShapeInstance *shape, int x, int y) {
    const double one = 65536, right = x - shape->bounds[0], down = y - shape->bounds[1];
    const double cosine = shape->axis[0] / one, sine = shape->axis[1] / one;
    const double inside_x = shape->extents[0] / one - fabs(shape->axis[2] / one + right * cosine + down * sine),
                 inside_y = shape->extents[1] / one - fabs(shape->axis[3] / one + right * sine - down * cosine);
    const double inside = fmin(inside_x, inside_y);
    return inside > 0 && ((shape->paint[0] & SHAPE_HOLLOW) == 0 || inside < shape->extents[3] / one);
}

static bool is_ground(const Film *film, size_t thing) {
    if (thing < film->drawing.rect_count) return true;
    const ShapeInstance *shape = &film->drawing.shapes[thing - film->drawing.rect_count];
    return shape->paint[0] == film->panel && shape->extents[3] == 0;
}

/* Pixels of a letter that are on a thing; of all, if its number is behind the last one. */
static int ink_on(const Drawing *drawing, const GlyphInstance *glyph, size_t thing) {
    const Rect letter = {glyph->box[0], glyph->box[1], glyph->box[0] + glyph->box[2], glyph->box[1] + glyph->box[3]};
    const bool all = thing >= drawing->rect_count + drawing->shape_count;
    const Rect rect = all ? letter : bounds_of(drawing, thing);
    int count = 0;
    for (int y = letter.top > rect.top ? letter.top : rect.top; y < letter.bottom && y < rect.bottom; y++)
        for (int x = letter.left > rect.left ? letter.left : rect.left; x < letter.right && x < rect.right; x++)
            count += has_ink(drawing, glyph, x, y) && (all || thing < drawing->rect_count ||
                                                       in_shape(&drawing->shapes[thing - drawing->rect_count], x, y));
    return count;
}

/* What is wrong with a letter; NULL: nothing. What is below the ground on which a letter lies as a whole does not
   count. */
static const char *fault_of(const Film *film, const GlyphInstance *glyph) {
    const Drawing *drawing = &film->drawing;
    const size_t things = drawing->rect_count + drawing->shape_count;
    const int ink = ink_on(drawing, glyph, things);
    const char *fault = NULL;
    for (size_t i = 0; i < things; i++) {
        const int on = ink_on(drawing, glyph, i);
        if (on > 0) fault = on == ink && is_ground(film, i) ? NULL : "a letter is on a line, box or arrow";
    }
    for (int y = glyph->box[1]; y < glyph->box[1] + glyph->box[3]; y++)
        for (int x = glyph->box[0]; x < glyph->box[0] + glyph->box[2]; x++) {
            if (!has_ink(drawing, glyph, x, y)) continue;
            if (x < 0 || y < 0 || x >= film->width || y >= film->height) return "a letter is cut";
            if (film->letters[y * film->width + x]++ > 0) fault = "a letter is on another";
        }
    return is_ellipsis(glyph) ? "a text is shortened" : fault;
}

static int check_film(const RenderOptions *options, int count, Moment moment) {
    Film film = {.width = options->width, .height = options->height, .panel = theme_get(options->look.theme)->panel};
    Error error = {0};
    Picture picture;
    int faults = 0;
    assert_ok(picture_plan(&picture, panels, count, film.width, film.height, &error), error);
    assert_ok(picture_apply_options(&picture, options, &error), error);
    picture_draw(&picture, moment, &film.drawing);
    assert_non_null(film.letters = calloc((size_t)film.width, (size_t)film.height));
    for (size_t i = 0; i < film.drawing.glyph_count; i++) {
        const GlyphInstance *glyph = &film.drawing.glyphs[i];
        const char *fault = fault_of(&film, glyph);
        if (fault == NULL) continue;
        if (faults++ == 0)
            print_error("%d runs, %d x %d, compare %s, show %d, moment %d, frame %d: %s at (%d, %d)\n", count,
                        film.width, film.height, look_compare_names[options->look.compare], options->look.show,
                        moment.kind, moment.frame, fault, glyph->box[0], glyph->box[1]);
    }
    assert_true(film.drawing.glyph_count > 0);
    free(film.letters);
    drawing_free(&film.drawing);
    picture_free(&picture);
    return faults > 0;
}

TEST_WITH(letters_of_films_are_clear, make, destroy) {
    static const int sizes[][2] = {{480, 320}, {640, 360}, {1280, 720}, {1920, 1080}, {720, 1280}};
    static const Moment moments[] = {{MOMENT_STORED, 60, 0, 1, 1}, {MOMENT_BETWEEN, 33, 2, 4, 4}},
                        cards[] = {{MOMENT_TITLE, 0, 0, 1, 1}, {MOMENT_END, 75, 0, 1, 1}};
    const unsigned of_one = SHOW_TRAILS | SHOW_CONTACTS | SHOW_IMPULSES | SHOW_VELOCITIES,
                   shown[] = {0, of_one, of_one | SHOW_GHOSTS | SHOW_DISTANCE | SHOW_TIMELINE};
    int faults = 0;
    for (size_t size = 0; size < sizeof sizes / sizeof *sizes; size++)
        for (int count = 1; count <= RUNS; count++) {
            const bool narrow = sizes[size][0] < 640; /* there the time line's key shortens five names */
            RenderOptions options = {
                .width = sizes[size][0], .height = sizes[size][1], .end_card = true, .describe = method_describe};
            for (int i = 0; i < 2; i++) faults += check_film(&options, count, cards[i]);
            for (int compare = LOOK_SPLIT; compare <= (count > 1 ? LOOK_DIFFERENCE : LOOK_SPLIT); compare++)
                for (int show = 0; show < (count > 1 && !(narrow && count > 4) ? 3 : 2); show++)
                    for (int i = 0; i < 2; i++) {
                        options.look = (RenderLook){.compare = (LookCompare)compare, .show = shown[show]};
                        faults += check_film(&options, count, moments[i]);
                    }
        }
    assert_int_equal(faults, 0);
}

RUN_TESTS(NULL, NULL)
