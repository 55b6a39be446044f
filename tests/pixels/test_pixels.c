/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shapes and glyphs pixel by pixel, in both kinds of context. */
#include "owned_drawings.h"

#include "pictures/mesa.h"
#include "pixels/gl.h"
#include "screens.h"

static const double PI = 3.14159265358979323846;

static Shape box(double x, double y, double width, double height) {
    return (Shape){.x = x, .y = y, .half_width = width / 2, .half_height = height / 2, .cosine = 1, .fill = WHITE};
}

static Shape turned(Shape shape, double angle) {
    shape.cosine = cos(angle);
    shape.sine = sin(angle);
    return shape;
}

static const Image *paint(Shape shape) {
    drawing_add_shape(&drawing, &shape, &everything);
    return painted();
}

/* White on black: the white area in pixels. */
static double area(const Image *image) {
    double sum = 0;
    for (int i = 0; i < SCREEN_SIDE * SCREEN_SIDE; i++) sum += image->pixels[4 * i] / 255.0;
    return sum;
}

static void assert_only(const Image *image, Rect rect, uint32_t color) {
    for (int y = 0; y < SCREEN_SIDE; y++)
        for (int x = 0; x < SCREEN_SIDE; x++) {
            bool inside = x >= rect.left && x < rect.right && y >= rect.top && y < rect.bottom;
            if (rgb(image, x, y) != (inside ? color : BLACK)) fail_msg("pixel %d, %d: %06x", x, y, rgb(image, x, y));
            assert_int_equal(pixel(image, x, y)[3], 255);
        }
}

TEST(edges_between_pixels_are_sharp) {
    assert_only(paint(box(40, 30, 20, 10)), (Rect){30, 25, 50, 35}, WHITE);
    assert_only(paint(box(40.5, 30.5, 21, 1)), (Rect){30, 30, 51, 31}, WHITE);
    drawing_add_rect(&drawing, (Rect){3, 4, 9, 17}, 0x123456);
    assert_only(painted(), (Rect){3, 4, 9, 17}, 0x123456);
}

/* 51 levels in steps of 5: the coverage of a pixel, rounded. */
TEST(edges_within_pixels_cover_their_share) {
    for (int i = 0; i <= 16; i++) {
        const Image *image = paint(box(40 + i / 16.0, 30, 20, 10));
        int gained = (int)floor(51.0 * i / 16 + 0.5), lost = (int)floor(51.0 * (16 - i) / 16 + 0.5);
        assert_int_equal(pixel(image, 50, 30)[0], 5 * gained);
        assert_int_equal(pixel(image, 30, 30)[0], 5 * lost);
        assert_int_equal(pixel(image, 49, 30)[0], 255);
        assert_int_equal(pixel(image, 51, 30)[0], 0);
    }
}

TEST(area_does_not_depend_on_the_angle) {
    for (int i = 0; i < 40; i++) {
        const Image *image = paint(turned(box(47.3, 48.9, 50, 31), 0.17 * i));
        assert_true(fabs(area(image) - 50.0 * 31.0) < 0.005 * 50 * 31);
    }
}

/* A box with a corner radius of half its side. */
TEST(a_disc_has_the_area_of_a_circle) {
    for (double radius = 3; radius < 45; radius += 3.7) {
        Shape disc = box(48, 48, 2 * radius, 2 * radius);
        disc.radius = radius;
        assert_true(fabs(area(paint(disc)) - PI * radius * radius) < 0.02 * PI * radius * radius);
    }
}

TEST(moving_by_whole_pixels_moves_the_pixels) {
    OWN(Image) *before = image_create(SCREEN_SIDE, SCREEN_SIDE, &(Error){0});
    Shape shape = turned(box(30.3, 31.7, 25, 14), 0.6);
    shape.radius = 3.3, shape.outline = 1.4, shape.line = 0x405060;
    memcpy(before->pixels, paint(shape)->pixels, SCREEN_SIDE * SCREEN_SIDE * 4);
    shape.x += 17, shape.y += 23;
    const Image *after = paint(shape);
    for (int y = 0; y < SCREEN_SIDE - 23; y++)
        for (int x = 0; x < SCREEN_SIDE - 17; x++) assert_int_equal(rgb(before, x, y), rgb(after, x + 17, y + 23));
}

/* Smaller differences can be due to the machine's arithmetic. */
TEST(positions_snap_to_a_256th_of_a_pixel) {
    Shape shape = turned(box(30.25, 31.75, 25, 14), 0.6);
    drawing_add_shape(&drawing, &shape, &everything);
    shape.x += 1e-3, shape.y -= 1e-3, shape.half_width -= 1e-3, shape.half_height += 1e-3;
    drawing_add_shape(&drawing, &shape, &everything);
    shape.x += 1.0 / 256;
    drawing_add_shape(&drawing, &shape, &everything);
    assert_memory_equal(&drawing.shapes[0], &drawing.shapes[1], sizeof(ShapeInstance));
    assert_memory_not_equal(&drawing.shapes[1], &drawing.shapes[2], sizeof(ShapeInstance));
    drawing_clear(&drawing);
}

/* A sixteenth of a pixel can be seen. */
TEST(small_movements_show) {
    Shape shape = turned(box(30.25, 31.75, 25, 14), 0.6);
    uint64_t hash = image_hash(paint(shape));
    shape.x += 1.0 / 16;
    assert_true(image_hash(paint(shape)) != hash);
}

TEST(outline_and_fill_meet_where_they_should) {
    Shape shape = box(40, 40, 20, 20);
    shape.outline = 2, shape.line = 0xFF0000, shape.fill = 0x00FF00;
    const Image *image = paint(shape);
    assert_int_equal(rgb(image, 29, 40), BLACK);
    assert_int_equal(rgb(image, 30, 40), 0xFF0000);
    assert_int_equal(rgb(image, 31, 40), 0xFF0000);
    assert_int_equal(rgb(image, 32, 40), 0x00FF00);
    assert_int_equal(rgb(image, 40, 49), 0xFF0000);
    assert_int_equal(rgb(image, 40, 47), 0x00FF00);
}

/* Counter-clockwise: the band goes from the top to the left, to the bottom, to the right. */
TEST(the_band_shows_quarter_turns) {
    static const int at[4][2] = {{48, 32}, {32, 48}, {48, 63}, {63, 48}};
    for (int quarter = 0; quarter < 4; quarter++) {
        Shape shape = turned(box(48, 48, 40, 40), quarter * PI / 2);
        shape.band = 8, shape.band_color = 0xFF0000;
        const Image *image = paint(shape);
        for (int i = 0; i < 4; i++) assert_int_equal(rgb(image, at[i][0], at[i][1]), i == quarter ? 0xFF0000 : WHITE);
    }
}

/* What is below is visible inside; a thick outline fills the box. */
TEST(a_hollow_box_is_its_outline_alone) {
    for (int i = 0; i < 20; i++) {
        Shape hollow = turned(box(47.3, 48.9, 50, 31), 0.17 * i);
        hollow.hollow = true, hollow.line = WHITE, hollow.fill = 0x123456, hollow.outline = 0.8 + 0.3 * i;
        double inner = (50 - 2 * hollow.outline) * (31 - 2 * hollow.outline);
        const Image *image = paint(hollow);
        assert_near(area(image), 50 * 31 - inner, 0.012 * 50 * 31);
        assert_int_equal(rgb(image, 47, 48), BLACK);
        for (int k = 0; k < SCREEN_SIDE * SCREEN_SIDE; k++) /* white over black is grey: nothing of the fill's colour */
            assert_true(image->pixels[4 * k] == image->pixels[4 * k + 1]);
    }
    Shape thick = box(40, 30, 20, 10);
    thick.hollow = true, thick.line = WHITE, thick.outline = 6;
    assert_only(paint(thick), (Rect){30, 25, 50, 35}, WHITE);
}

TEST(lines_have_their_length_and_thickness) {
    for (int i = 0; i < 12; i++) {
        double length = 6 * i, t = 3 + 0.5 * i, c = cos(0.4 * i), s = sin(0.4 * i);
        Point from = {48 - c * length / 2, 48 - s * length / 2}, to = {48 + c * length / 2, 48 + s * length / 2};
        stroke_line(&drawing, from, to, t, WHITE, &everything);
        assert_near(area(painted()), length * t + PI * t * t / 4, 0.02 * (length * t + t * t) + 0.4);
    }
}

/* A slanted line equals the box that it represents, although it is drawn in tiles; also with a clip. */
TEST(long_lines_are_drawn_completely) {
    for (int i = 0; i < 24; i++) {
        double c = cos(0.26 * i), s = sin(0.26 * i), t = 2 + 0.3 * i;
        const Rect clip = i % 2 == 0 ? everything : (Rect){20, 30, 70, 77};
        Shape whole = turned(box(48.3, 47.1, 80 + t, t), -0.26 * i);
        whole.radius = t / 2;
        drawing_add_shape(&drawing, &whole, &clip);
        uint64_t hash = image_hash(painted());
        Point from = {48.3 - 40 * c, 47.1 - 40 * s}, to = {48.3 + 40 * c, 47.1 + 40 * s};
        stroke_line(&drawing, from, to, t, WHITE, &clip);
        assert_true(fmin(fabs(c), fabs(s)) < 0.25 || drawing.shape_count > 2);
        assert_true(image_hash(painted()) == hash);
    }
}

/* Dashes of 4 and gaps of 6 thicknesses, with round ends; one segment, or segments of any length. */
TEST(dashes_continue_across_segments) {
    for (int pieces = 1; pieces < 20; pieces += 3) {
        DashedLine line = {2, 0, WHITE, {4, 6, 0, 0}};
        for (int i = 0; i < pieces; i++)
            stroke_dashed(&drawing, (Point){8 + 80.0 * i / pieces, 40}, (Point){8 + 80.0 * (i + 1) / pieces, 40}, &line,
                          &everything);
        const Image *image = painted();
        for (int x = 8; x < 88; x++) {
            int at = (x - 8) % 20;
            if (at >= 1 && at < 7) assert_int_equal(pixel(image, x, 39)[0], 255);
            if (at >= 10 && at < 18) assert_int_equal(pixel(image, x, 39)[0], 0);
        }
    }
}

/* The tip is at the arrow's end; an arrow without length is not drawn. */
TEST(arrows_point_where_they_end) {
    const ArrowStyle style = {2, WHITE, BLACK};
    for (int i = 0; i < 16; i++) {
        Point to = {48 + 30 * cos(0.39 * i), 48 + 30 * sin(0.39 * i)};
        stroke_arrow(&drawing, (Point){48, 48}, to, i % 2 == 0, &style, &everything);
        const Image *image = painted();
        assert_true(pixel(image, (int)to.x, (int)to.y)[0] > 100 && pixel(image, 48, 48)[0] > 100);
        int beyond_x = (int)(48 + 34 * cos(0.39 * i)), beyond_y = (int)(48 + 34 * sin(0.39 * i));
        assert_int_equal(pixel(image, beyond_x, beyond_y)[0], 0);
    }
    stroke_arrow(&drawing, (Point){48, 48}, (Point){48, 48}, false, &style, &everything);
    stroke_arrow(&drawing, (Point){48, 48}, (Point){NAN, 48}, true, &style, &everything);
    stroke_line(&drawing, (Point){INFINITY, 48}, (Point){0, 48}, 2, WHITE, &everything);
    stroke_dashed(&drawing, (Point){0, 0}, (Point){INFINITY, 0}, &(DashedLine){2, 0, WHITE, {4, 6, 0, 0}}, &everything);
    assert_int_equal(drawing.shape_count, 0);
}

TEST(nothing_is_painted_outside_the_clip) {
    Shape shape = turned(box(40, 40, 400, 400), 0.3);
    drawing_add_shape(&drawing, &shape, &(Rect){10, 20, 33, 35});
    assert_only(painted(), (Rect){10, 20, 33, 35}, WHITE);
}

/* Boxes of all angles and text, over which a dot goes from place to place: only the tiles that it leaves or enters are
   painted again, which cut the boxes and the text, and the picture is the one that is painted whole. */
TEST(damaged_parts_are_those_of_the_whole) {
    const Font font = font_pick(FONT_SEMIBOLD, 33);
    OWN(Drawing) before = {0}, after = {0};
    Damage damage;
    assert_ok(damage_init(&damage, SCREEN_SIDE, SCREEN_SIDE, &error), error);
    const Screen *s = &screens[0];
    assert_ok(context_make_current(&s->context, &error), error);
    for (int i = 0; i < 64; i++) {
        const Drawing painted_before = before;
        before = after, after = painted_before;
        drawing_clear(&after);
        for (int k = 0; k < 4; k++) {
            Shape shape = turned(box(20 + 24 * k, 30 + 14 * k, 60, 30), 0.4 + 1.7 * k);
            shape.outline = 3, shape.line = 0x3366cc, shape.band = 6, shape.band_color = 0xcc9933;
            drawing_add_shape(&after, &shape, &everything);
        }
        font_add(&after, &font, "WWW", 4, 76, 0x33cc66);
        Shape dot = box(6 + i * 11 % 84, 6 + i * 37 % 84, 9, 9);
        drawing_add_shape(&after, &dot, &everything);
        assert_true(damage_find(&damage, &before, &after));
        assert_ok(canvas_paint(s->canvas, &after, BLACK, i > 0 ? &damage : NULL, s->image, &error), error);
        const uint64_t hash = image_hash(s->image);
        assert_ok(canvas_paint(s->canvas, &after, BLACK, NULL, s->image, &error), error);
        assert_true(image_hash(s->image) == hash);
    }
    damage_free(&damage);
}

/* Upper edge at y = 10, in a box of up to 1000 km. */
TEST(large_boxes_keep_their_edges) {
    for (double side = 400; side < 1e8; side *= 3.7)
        for (int half_turn = 0; half_turn < 2; half_turn++) {
            double half = rint(side) / 2;
            Shape shape = turned(box(-half / 3, 10 + half, 2 * half, 2 * half), half_turn * PI);
            if (half > 8192) shape.band = side / 8; /* lost: the picture is smaller than the band */
            assert_only(paint(shape), (Rect){0, 10, SCREEN_SIDE, SCREEN_SIDE}, WHITE);
        }
}

TEST(shapes_with_invalid_positions_are_not_painted) {
    static const double bad[] = {NAN, INFINITY, -INFINITY, 1e30, -1e30, 3e9};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        Shape shapes[] = {box(bad[i], 10, 5, 5), box(10, bad[i], 5, 5), box(10, 10, NAN, 5), box(10, 10, 5, -3),
                          turned(box(10, 10, 5, 5), NAN)};
        for (size_t k = 0; k < sizeof shapes / sizeof shapes[0]; k++)
            drawing_add_shape(&drawing, &shapes[k], &everything);
    }
    Shape outside = box(-30, -30, 20, 20);
    drawing_add_shape(&drawing, &outside, &everything);
    assert_int_equal(drawing.shape_count, 0);
    assert_only(painted(), (Rect){0, 0, 0, 0}, WHITE);
}

TEST(glyphs_are_the_bitmaps_of_the_font) {
    Font font = font_pick(FONT_SEMIBOLD, 33);
    assert_int_equal(font.pixels, 32);
    int behind = font_add(&drawing, &font, "R", 20, 50, WHITE);
    assert_int_equal(drawing.glyph_count, 1);
    GlyphInstance glyph = drawing.glyphs[0];
    assert_int_equal(behind, 20 + font_width(&font, "R"));
    const Image *image = painted();
    for (int y = 0; y < glyph.box[3]; y++)
        for (int x = 0; x < glyph.box[2]; x++)
            assert_int_equal(pixel(image, glyph.box[0] + x, glyph.box[1] + y)[0],
                             font_bitmaps[glyph.bitmap + (unsigned)(y * glyph.box[2] + x)]);
}

/* A character missing from the font, an overlong encoding, a truncated surrogate, a lone byte. */
TEST(unknown_characters_show_as_question_marks) {
    Font font = font_pick(FONT_REGULAR, 20);
    assert_int_equal(font_width(&font, "\xE4\xBD\xA0"), font_width(&font, "?"));
    assert_int_equal(font_width(&font, "\xC0\xAF"), font_width(&font, "??"));
    assert_int_equal(font_width(&font, "\xE4\xBD"), font_width(&font, "??"));
    assert_int_equal(font_width(&font, "\xFF"), font_width(&font, "?"));
    assert_int_not_equal(font_width(&font, "\xC2\xB5"), font_width(&font, "?")); /* micro */
}

TEST(digits_have_equal_width) {
    for (double size = 9; size < 80; size++)
        for (FontFace face = FONT_REGULAR; face <= FONT_SEMIBOLD; face++) {
            Font font = font_pick(face, size);
            int width = font_width(&font, "0000000000");
            assert_int_equal(font_width(&font, "1234567890"), width);
            assert_int_equal(font_width(&font, "1111111111"), width);
            assert_int_equal(font_width(&font, "11111" FIGURE_SPACE "1111"), width);
        }
}

TEST(long_text_is_cut_to_fit) {
    Font font = font_pick(FONT_REGULAR, 20);
    const char *text = "sequential impulses, engine";
    for (int room = 0; room <= font_width(&font, text) + 2; room++) {
        int end = font_add_fitting(&drawing, &font, text, 10, 30, room, WHITE);
        assert_true(end <= 10 + room);
        if (room >= font_width(&font, text)) assert_int_equal(end, 10 + font_width(&font, text));
        drawing_clear(&drawing);
    }
    Font none = font_pick(FONT_REGULAR, 8);
    assert_int_equal(font_add_fitting(&drawing, &none, text, 10, 30, 500, WHITE), 10);
    assert_int_equal(drawing.glyph_count, 0);
}

RUN_TESTS(open_screens, close_screens)
