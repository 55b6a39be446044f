/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The three formats of a sketch. Areas have closed forms; a PDF's object table is checked. */
#include "made.h"
#include "files.h"

#include "base/hash.h"
#include "base/process.h"
#include "figures/sketch_writers.h"
#include "pixels/type.h"

#include <inttypes.h>

OWNED_VALUE(Sketch, sketch_free)

/* Ten pixels per mm. */
static const SketchOutput white = {254, false, false}, clear = {254, true, false}, outlines = {254, false, true};

static Image *as_pixels(const Sketch *sketch, const SketchOutput *output) {
    Error error = {0};
    const char *path = temporary_path("sketch.png");
    assert_ok(sketch_write(sketch, path, output, &error), error);
    Image *image = image_of(path);
    assert_int_equal(image->width, (int)lrint(10 * sketch->width));
    assert_int_equal(image->height, (int)lrint(10 * sketch->height));
    return image;
}

/* Covered area of a transparent sketch, square mm. */
static double covered(Sketch *sketch) {
    OWN(Image) *image = as_pixels(sketch, &clear);
    double sum = 0;
    for (size_t i = 0; i < (size_t)image->width * (size_t)image->height; i++) sum += image->pixels[4 * i + 3];
    sketch_free(sketch);
    return sum / 255 / 100;
}

static const Pen black = {0, 1, NO_COLOUR, 0, NULL};

TEST(areas_are_those_of_geometry) {
    Sketch sketch;
    sketch_begin(&sketch, 20, 10);
    sketch_dot(&sketch, (Point){10.03, 5.02}, 4, &black); /* of 36 corners */
    assert_near(covered(&sketch), 18 * 16 * sin(2 * M_PI / 36), 0.02);
    sketch_begin(&sketch, 20, 10);
    const Point triangle[] = {{1.23, 1.11}, {15.7, 2.9}, {7.77, 8.08}};
    sketch_shape(&sketch, triangle, 3, &black);
    assert_near(covered(&sketch), 0.5 * ((15.7 - 1.23) * (8.08 - 1.11) - (7.77 - 1.23) * (2.9 - 1.11)), 0.02);
    sketch_begin(&sketch, 20, 10);
    const Pen line = pen_line(0, 10, NULL), dashed = pen_line(0, 10, "(10,20)");
    sketch_line(&sketch, (Point){2, 2}, (Point){14, 7}, &line);
    assert_near(covered(&sketch), 13 * 10 * LINE_UNIT, 0.05);
    sketch_begin(&sketch, 20, 10);
    sketch_line(&sketch, (Point){2, 5}, (Point){2 + 3 * 30 * LINE_UNIT, 5}, &dashed); /* three dashes */
    assert_near(covered(&sketch), 30 * LINE_UNIT * 10 * LINE_UNIT, 0.02);
}

/* Areas of winding number 2 count once, and a line that turns back is still drawn; its edges are those of pixels, as in
   the pixels of an edge what overlaps adds up. */
TEST(overlaps_count_once) {
    Sketch sketch;
    sketch_begin(&sketch, 10, 10);
    const Point twice[] = {{2, 2}, {6, 2}, {6, 6}, {2, 6}, {2, 2}, {6, 2}, {6, 6}, {2, 6}};
    sketch_shape(&sketch, twice, 8, &(Pen){0, 0.5, NO_COLOUR, 0, NULL});
    assert_near(covered(&sketch), 16 * 128 / 255.0, 0.01);
    sketch_begin(&sketch, 10, 10);
    const Point back[] = {{2, 5.05}, {8, 5.05}, {2, 5.05}};
    const Pen line = pen_line(0, 10, NULL);
    sketch_path(&sketch, back, 3, &line);
    double bar = 6 * 1.7, cap = M_PI / 2 * 0.85 * 0.85;
    assert_near(covered(&sketch), bar + cap, 0.05);
}

static const uint8_t *pixel(const Image *image, int x, int y) {
    return image->pixels + 4 * ((size_t)y * (size_t)image->width + (size_t)x);
}

static void expect_pixel(const Image *image, int x, int y, unsigned rgba) {
    const uint8_t *p = pixel(image, x, y);
    unsigned found = (unsigned)p[0] << 24 | (unsigned)p[1] << 16 | (unsigned)p[2] << 8 | p[3];
    if (found != rgba) fail_msg("pixel (%d, %d) is %08x, not %08x", x, y, found, rgba);
}

TEST(shapes_lie_at_their_place_and_colour) {
    OWN(Sketch) sketch;
    sketch_begin(&sketch, 10, 10);
    sketch_rectangle(&sketch, (Point){2, 1}, (Point){5, 6}, &(Pen){0x204060, 1, NO_COLOUR, 0, NULL});
    sketch_rectangle(&sketch, (Point){4, 1}, (Point){5, 6}, &(Pen){0xFFFFFF, 0.2, NO_COLOUR, 0, NULL});
    Image *image = as_pixels(&sketch, &white);
    expect_pixel(image, 19, 50, 0xFFFFFFFF);
    expect_pixel(image, 20, 40, 0x204060FF);
    expect_pixel(image, 39, 89, 0x204060FF);
    expect_pixel(image, 40, 89, 0x4D6680FF); /* a fifth of the way to white */
    expect_pixel(image, 20, 39, 0xFFFFFFFF);
    expect_pixel(image, 20, 90, 0xFFFFFFFF);
    image_destroy(image);
    image = as_pixels(&sketch, &clear);
    expect_pixel(image, 19, 50, 0);
    expect_pixel(image, 20, 40, 0x204060FF);
    image_destroy(image);
}

TEST(a_picture_of_its_places_size_keeps_its_pixels) {
    OWN(Sketch) sketch;
    OWN(Image) *picture = image_sized(20, 10);
    for (int i = 0; i < 20 * 10 * 4; i++) picture->pixels[i] = i % 4 == 3 ? 255 : (uint8_t)(i * 37);
    picture->pixels[3] = 0;
    sketch_begin(&sketch, 10, 5);
    sketch_image(&sketch, picture, (Point){3, 2}, 2);
    OWN(Image) *image = as_pixels(&sketch, &white);
    expect_pixel(image, 30, 20, 0xFFFFFFFF);
    for (int y = 0; y < 10; y++)
        for (int x = 0; x < 20; x++)
            if (x + y > 0) assert_memory_equal(pixel(image, 30 + x, 20 + y), pixel(picture, x, y), 4);
}

/* Left and right edge of everything not white, mm. */
static void find_ink(const Image *image, double *left, double *right) {
    *left = HUGE_VAL, *right = -HUGE_VAL;
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++)
            if (pixel(image, x, y)[0] < 128) *left = fmin(*left, x / 10.0), *right = fmax(*right, (x + 1) / 10.0);
}

TEST(words_are_as_wide_as_they_say) {
    const double points = 20, end = 15;
    double left, right;
    Sketch sketch;
    sketch_begin(&sketch, 60, 10);
    sketch_text(&sketch, (Point){end, 5}, &(TextStyle){points, TEXT_LEFT, 0, 0, false}, "HHHH");
    Image *image = as_pixels(&sketch, &white);
    find_ink(image, &left, &right);
    double bearing = left - end;
    assert_true(bearing > 0 && bearing < 1);
    assert_near(right, end + type_width("HHHH", points) - bearing, 0.11);
    image_destroy(image);
    sketch_free(&sketch);
    /* The capitals are centred at the given position: 20 points are 7.06 mm, capitals of Inter 0.727 of that. */
    sketch_begin(&sketch, 60, 10);
    sketch_text(&sketch, (Point){end, 5}, &(TextStyle){points, TEXT_LEFT, 0, 90, false}, "HHHH");
    image = as_pixels(&sketch, &white);
    find_ink(image, &left, &right);
    assert_near((left + right) / 2, end, 0.06);
    assert_near(right - left, 0.727 * points * MM_PER_POINT, 0.11);
    image_destroy(image);
    sketch_free(&sketch);
}

static void draw_something(Sketch *sketch) {
    OWN(Image) *picture = image_sized(3, 2);
    for (int i = 0; i < 3 * 2 * 4; i++) picture->pixels[i] = (uint8_t)(i * 37);
    sketch_begin(sketch, 30, 20);
    strcpy(sketch->title, "Something <new>");
    sketch_image(sketch, picture, (Point){1, 1}, 5);
    sketch_text(sketch, (Point){15, 10}, &(TextStyle){8, TEXT_CENTER, 0x123456, 30, true}, "a < b & \"c\" \xFF\x01 ±");
    sketch_rectangle(sketch, (Point){1, 1}, (Point){9, 9}, &(Pen){0x336699, 0.25, 0, 1, "(3,2)"});
    sketch_arrow(sketch, (Point){1, 1}, (Point){20, 9}, 0, 2);
}

/* With and without a white page, in every format. The hashes are equal on Debian 12 and 13. */
TEST(a_sketch_has_the_same_bytes_everywhere) {
    static const struct {
        const char *name;
        uint64_t on_white, transparent;
    } expected[SKETCH_FORMATS] = {
        {"a.png", 0x8961ee4eecd6dbbf, 0xd460ed1a4855cf70},
        {"a.svg", 0x790089e5b389122c, 0x78359eb7844e919a},
        {"a.pdf", 0x8e6a7e11b749347c, 0xb71502ec6a31e165},
    };
    OWN(Sketch) sketch;
    draw_something(&sketch);
    for (int i = 0; i < 2 * SKETCH_FORMATS; i++) {
        const bool transparent = i % 2 == 1;
        const char *path = temporary_path(expected[i / 2].name);
        assert_ok(sketch_write(&sketch, path, transparent ? &clear : &white, &error), error);
        size_t size;
        char *data = read_whole(path, &size);
        const uint64_t hash = hash_xxh3(data, size);
        free(data);
        if (hash != (transparent ? expected[i / 2].transparent : expected[i / 2].on_white))
            fail_msg("%s%s: other bytes, with the hash 0x%016" PRIx64, expected[i / 2].name,
                     transparent ? ", transparent" : "", hash);
    }
}

/* Text is text, in a font that the file brings; or outlines, without the font. */
TEST(an_svg_has_its_words) {
    OWN(Sketch) sketch;
    size_t size;
    draw_something(&sketch);
    FREED char *svg = sketch_as_svg(&sketch, &white, &size, &error);
    assert_ok(svg != NULL, error);
    assert_non_null(strstr(svg, ">a &lt; b &amp; &quot;c&quot; ?? ±</text>"));
    assert_non_null(strstr(svg, "<title>Something &lt;new></title>"));
    strcpy(sketch.title, "]]> > ]>");
    FREED char *other = sketch_as_svg(&sketch, &white, &size, &error);
    assert_non_null(strstr(other, "<title>]]&gt; > ]></title>")); /* else no XML */
    assert_non_null(strstr(svg, "@font-face{font-family:Inter;src:url(data:font/otf;base64,T1RUTwA"));
    assert_non_null(
        strstr(svg, "font-family=\"Inter, 'Helvetica Neue', Helvetica, Arial, 'Liberation Sans', sans-serif\""));
    /* centred at (15, 10), capitals' middle 0.3635 em above the baseline, turned by 30 degrees */
    const double em = 8 * MM_PER_POINT;
    const char *text =
        printed("<text transform=\"translate(%.3f %.3f) rotate(-30)\" font-size=\"%.4f\" fill=\"#123456\" "
                "text-anchor=\"middle\" stroke=\"#FFFFFF\"",
                15 + TYPE_MIDDLE * em * sin(M_PI / 6), 10 + TYPE_MIDDLE * em * cos(M_PI / 6), em);
    assert_non_null(strstr(svg, text));
    assert_null(strstr(svg, "aria-label"));
}

/* The program prints this text, without blank lines, first. */
static void expect_printed(const char *program, const char *path, const char *wanted) {
    Error error = {0};
    Process process;
    char text[2000];
    const char *const out = temporary_path("printed.txt");
    const char *command =
        printed("%s %s %s | grep . >%s", program, path, strcmp(program, "pdftotext") == 0 ? "-" : "", out);
    assert_ok(process_start(&process, (const char *const[]){"sh", "-c", command, NULL}, &error), error);
    assert_ok(process_finish(&process, text, sizeof text, &error), error);
    FREED char *printed = text_of(out);
    if (strncmp(printed, wanted, strlen(wanted)) != 0) fail_msg("%s prints '%s', not '%s'", program, printed, wanted);
}

TEST(an_svg_of_outlines_needs_no_font) {
    OWN(Sketch) sketch;
    size_t size;
    draw_something(&sketch);
    FREED char *svg = sketch_as_svg(&sketch, &outlines, &size, &error);
    assert_ok(svg != NULL, error);
    assert_null(strstr(svg, "<text"));
    assert_null(strstr(svg, "font"));
    assert_non_null(strstr(svg, "aria-label=\"a &lt; b &amp; &quot;c&quot; ?? ±\""));
    assert_non_null(strstr(svg, "width=\"30.000mm\" height=\"20.000mm\" viewBox=\"0 0 30.000 20.000\""));
    assert_non_null(strstr(svg, "M1.000 19.000L9.000 19.000L9.000 11.000L1.000 11.000Z\" fill=\"#336699\" "
                                "fill-opacity=\"0.250\" stroke=\"#000000\" stroke-width=\"0.170\""));
}

/* poppler reads from a PDF what a reader sees: each text once, in the order of drawing, powers as powers; and its
   title. */
TEST(a_pdf_is_read_as_it_is_seen) {
    Sketch sketch;
    sketch_begin(&sketch, 100, 40);
    strcpy(sketch.title, "Distances, 1 µm to ∞");
    const TextStyle style = {8, TEXT_LEFT, 0, 0, true};
    sketch_text(&sketch, (Point){5, 30}, &style, "momentum:k=20, 0.55 s");
    sketch_power_of_ten(&sketch, (Point){20, 20}, &style, 1, -7);
    sketch_power_of_ten(&sketch, (Point){20, 10}, &style, 1, 12);
    const char *path = temporary_path("read.pdf");
    assert_ok(sketch_write(&sketch, path, &white, &error), error);
    sketch_free(&sketch);
    expect_printed("pdftotext", path, "momentum:k=20, 0.55 s\n10⁻⁷\n10¹²\n");
    expect_printed("pdfinfo", path, "Title:           Distances, 1 µm to ∞\n");
}

/* Every entry of the table points to its object, and the file contains no date or path. */
TEST(a_pdf_has_a_valid_object_table) {
    Sketch sketch;
    size_t size;
    draw_something(&sketch);
    FREED char *pdf = sketch_as_pdf(&sketch, &white, &size, &error);
    assert_ok(pdf != NULL, error);
    sketch_free(&sketch);
    assert_memory_equal(pdf, "%PDF-1.5\n", 9);
    char *tail = pdf + size - 40;
    const char *start = strstr(tail, "startxref\n");
    assert_non_null(start);
    const char *table = pdf + atol(start + 10);
    int count = 0, used = 0;
    assert_int_equal(sscanf(table, "xref\n0 %d\n%n", &count, &used), 1);
    assert_int_equal(count, 13); /* ten, a picture and its alpha, and number 0 */
    for (int i = 1; i < count; i++) {
        long offset = atol(table + used + 20 * i);
        const char *begin = printed("%d 0 obj\n", i);
        assert_memory_equal(pdf + offset, begin, strlen(begin));
    }
    assert_non_null(strstr(table, "trailer\n<</Size 13/Root 1 0 R/Info 10 0 R>>"));
    static const char *const untold[] = {"CreationDate", "ModDate", "/ID", "/Creator", "/Producer"};
    for (size_t k = 0; k < sizeof untold / sizeof *untold; k++)
        for (size_t i = 0; i + strlen(untold[k]) < size; i++)
            assert_memory_not_equal(pdf + i, untold[k], strlen(untold[k]));
}

static void expect_refused(const char *path, double width, double dpi, const char *message) {
    Error error = {0};
    OWN(Sketch) sketch;
    sketch_begin(&sketch, width, width);
    assert_false(sketch_write(&sketch, path, &(SketchOutput){.dpi = dpi}, &error));
    if (strstr(error.message, message) == NULL) fail_msg("'%s' lacks '%s'", error.message, message);
}

TEST(what_cannot_be_written_is_refused) {
    expect_refused(temporary_path("a.gif"), 10, 300, "the name of a figure must end in .png, .svg or .pdf");
    expect_refused("png", 10, 300, "png: error: the name of a figure must end in");
    expect_refused(".d.png/figure", 10, 300, "the name of a figure must end in");
    expect_refused(temporary_path("large.png"), 400, 1200, "18898 x 18898 pixels; at most 40000000");
    expect_refused("/nowhere/at/all.pdf", 10, 300, "/nowhere/at/all.pdf");
    assert_int_equal(access(temporary_path("large.png"), F_OK), -1);
}

/* Runs can reach any coordinate; those far from the page are not drawn. */
TEST(invalid_coordinates_draw_nothing) {
    static const double nowhere[] = {NAN, INFINITY, -INFINITY, 1e30};
    Sketch sketch;
    sketch_begin(&sketch, 10, 10);
    const Pen dashed = pen_line(0, 2, "(1,1)");
    for (size_t i = 0; i < sizeof nowhere / sizeof *nowhere; i++) {
        sketch_line(&sketch, (Point){1, 1}, (Point){nowhere[i], 2}, &dashed);
        sketch_dot(&sketch, (Point){nowhere[i], 2}, 1, &black);
        sketch_arrow(&sketch, (Point){1, 1}, (Point){2, nowhere[i]}, 0, 1);
        sketch_text(&sketch, (Point){nowhere[i], 2}, &(TextStyle){8, TEXT_LEFT, 0, 0, false}, "lost");
    }
    assert_int_equal(sketch.mark_count, 0);
    assert_near(covered(&sketch), 0, 0);
}

RUN_TESTS(NULL, NULL)
