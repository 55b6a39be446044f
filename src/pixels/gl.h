/* SPDX-License-Identifier: GPL-3.0-or-later */
/* OpenGL without a display: contexts, canvas, shapes, text in the built-in font. */
#pragma once
#include "base/base.h"
#include "pixels/png.h"
#include "pixels/type.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct GlFunctions GlFunctions; /* pixels/gl_functions.h, for those that create one or call them */
typedef void (*GlFunction)(void);

/* Fills the table with `find`, in the current context. ERROR_SYSTEM if a function is missing or OpenGL is older than
   3.3. */
bool gl_load(GlFunctions *gl, GlFunction (*find)(void *state, const char *name), void *state, Error *error);

/* The content of a frame before OpenGL: rectangles, above them shapes, above these glyphs, each in the order they
   were added. The rectangles and the first `static_shapes` shapes form the static layer. Pixels, y down, (0, 0) is
   the picture's upper left corner; colours are 0xRRGGBB. */

/* Whole pixels: left <= x < right, top <= y < bottom. */
typedef struct Rect {
    int left, top, right, bottom;
} Rect;

/* The input of shaders/rect.vert. */
typedef struct RectInstance {
    Rect rect;
    uint32_t color;
} RectInstance;

/* A rounded box. */
typedef struct Shape {
    double x, y; /* centre */
    double half_width, half_height;
    double cosine, sine;    /* of the angle, counter-clockwise on the screen */
    double radius, outline; /* corner radius; width of the outline, inside the box */
    double band;            /* thickness of the band along the local top; 0: none */
    bool hollow;            /* only the outline is drawn, in `line` */
    uint32_t fill, line, band_color;
} Shape;

enum { SHAPE_HOLLOW = 1 << 24 }; /* flag in the bits above the colour */

/* The input of shaders/shape.vert: lengths in 1/65536 pixel. */
typedef struct ShapeInstance {
    int32_t bounds[4];  /* the whole pixels to paint: left, top, right, bottom */
    int32_t axis[4];    /* direction of the local x axis; local position of the first pixel's centre */
    int32_t extents[4]; /* half width, half height, corner radius, outline */
    uint32_t paint[4];  /* fill or SHAPE_HOLLOW, line, band colour, band thickness */
} ShapeInstance;

/* The input of shaders/text.vert. */
typedef struct GlyphInstance {
    int32_t box[4];  /* left, top, width, height */
    uint32_t bitmap; /* index of the first texel in font_bitmaps, or after its end in the drawing's own bitmaps */
    uint32_t stride; /* texels from one row of the bitmap to the next */
    uint32_t color;
} GlyphInstance;

/* Initialise with zeros. */
typedef struct Drawing {
    RectInstance *rects;
    ShapeInstance *shapes;
    GlyphInstance *glyphs;
    size_t rect_count, rect_capacity, shape_count, shape_capacity, glyph_count, glyph_capacity;
    uint8_t *bitmaps; /* of glyphs that font_bitmaps lacks, as there */
    size_t bitmap_size, bitmap_capacity;
    size_t static_shapes; /* the first shapes: like the rectangles, equal in almost every frame */
    bool failed;          /* out of memory: the drawing is incomplete */
} Drawing;

/* Removes all content, keeps the memory. */
void drawing_clear(Drawing *drawing);
void drawing_free(Drawing *drawing);

/* Adds the part of a shape inside `clip`. Ignores a shape that is outside or has NaN or infinite values. */
void drawing_add_shape(Drawing *drawing, const Shape *shape, const Rect *clip);

void drawing_add_rect(Drawing *drawing, Rect rect, uint32_t color);

void drawing_add_glyph(Drawing *drawing, const GlyphInstance *glyph);

/* Room for a bitmap of `size` bytes, zeros, with the index for its glyph; NULL if out of memory (`failed`). */
uint8_t *drawing_add_bitmap(Drawing *drawing, size_t size, uint32_t *bitmap);

/* Adds what is inside `part` of the shapes and glyphs of `from`, except its static shapes. */
void drawing_add_part(Drawing *drawing, const Drawing *from, const Rect *part);

/* The glyphs of the most common characters as bitmaps, which tools/make_atlas.c embeds in the binary: the fonts of
   font/ in FONT_SIZES sizes. Others are drawn when they are needed (font.c). */

enum { FONT_FACES = 2, FONT_SIZES = 24, FONT_GLYPHS = 106 };

typedef struct FontGlyph {
    unsigned code;       /* Unicode, ascending within a size */
    unsigned offset;     /* of the bitmap in font_bitmaps */
    short width, height; /* of the bitmap, pixels */
    short left, top;     /* of the bitmap, right of and above the pen */
    short advance;       /* of the pen, 1/64 pixel; equal for all digits */
} FontGlyph;

extern const int font_sizes[FONT_SIZES]; /* pixels per em, ascending */
extern const FontGlyph font_glyphs[FONT_FACES][FONT_SIZES][FONT_GLYPHS];
extern const uint8_t font_bitmaps[]; /* alpha, row by row */
extern const unsigned font_bitmaps_size;

/* One line of UTF-8 text at whole pixels. */

typedef enum FontFace { FONT_REGULAR, FONT_SEMIBOLD } FontFace;

/* A face at a size. If it is too small to read, `glyphs` is NULL: all text has width 0 and adds nothing. */
typedef struct Font {
    const FontGlyph *glyphs;
    const Typeface *face; /* for the characters that these lack */
    int pixels;           /* per em */
} Font;

/* A space as wide as a digit, to pad numbers. */
#define FIGURE_SPACE "\xE2\x80\x87"

/* The largest size not above `pixels`. */
Font font_pick(FontFace face, double pixels);

/* In pixels, rounded up. */
int font_width(const Font *font, const char *text);

/* Adds text that starts at x and returns the x where it ends. Characters missing from the font and bytes that are
   not UTF-8 become '?'; type_check() refuses them before. */
int font_add(Drawing *drawing, const Font *font, const char *text, int x, int baseline, uint32_t color);

/* The same, shortened with an ellipsis to at most max_width pixels. */
int font_add_fitting(Drawing *drawing, const Font *font, const char *text, int x, int baseline, int max_width,
                     uint32_t color);

/* Damage: what may differ from one drawing to the next, as rows and as square tiles. Most of a frame equals the one
   before. */
typedef struct Damage {
    int width, height;
    bool *rows;  /* [height] */
    bool *tiles; /* row by row, from the top left */
} Damage;

/* Also after a failure, damage_free() is needed. */
bool damage_init(Damage *damage, int width, int height, Error *error);
void damage_free(Damage *damage);

/* Returns false if the static layer has changed, or nothing is known of the drawing before (NULL): then all is
   damaged. */
bool damage_find(Damage *damage, const Drawing *before, const Drawing *after);

/* Replaces *part, all zeros at first, by the next damaged part: tiles side by side. False at the end. */
bool damage_next(const Damage *damage, Rect *part);

/* Paints drawings with OpenGL and reads back the pixels. */

typedef struct Canvas Canvas;

/* This and all later calls need a current context. `gl` must outlive the canvas. */
Canvas *canvas_create(const GlFunctions *gl, int width, int height, Error *error);
void canvas_destroy(Canvas *canvas);

/* Paints a drawing over the background into `image`, which has the canvas's size. `damage` selects the parts to paint;
   the image must hold the others already, and the static layer and the background must be those of the last call.
   NULL: paint everything. */
bool canvas_paint(Canvas *canvas, const Drawing *drawing, uint32_t background, const Damage *damage, Image *image,
                  Error *error);

/* Lines, dots and arrows, all made of Shape, which is pixel-exact on every machine. Pixels, y down. */

/* A line with round caps. */
void stroke_line(Drawing *drawing, Point from, Point to, double thickness, uint32_t color, const Rect *clip);

/* A disc with a rim. */
void stroke_dot(Drawing *drawing, Point center, double radius, uint32_t fill, uint32_t rim, const Rect *clip);

typedef struct ArrowStyle {
    double thickness;
    uint32_t color, halo; /* the halo separates it from what is below */
} ArrowStyle;

/* An open head at `to`; two heads if the arrow is drawn shorter than its value (`truncated`). */
void stroke_arrow(Drawing *drawing, Point from, Point to, bool truncated, const ArrowStyle *style, const Rect *clip);

/* Alternating lengths of dashes and gaps, in units of the line's thickness; `on` = 0: solid. */
typedef struct Dash {
    double on, off, on2, off2;
} Dash;

/* Carries the dash phase from one segment of a polyline to the next; start with travelled = 0. */
typedef struct DashedLine {
    double thickness, travelled;
    uint32_t color;
    Dash dash;
} DashedLine;
void stroke_dashed(Drawing *drawing, Point from, Point to, DashedLine *line, const Rect *clip);

/* What is left of the dash (`on`) or gap at this place of a line, at least 0.01. parts: a Dash in pixels, not all 0. */
double dash_left(const double parts[4], double travelled, bool *on);

/* An OpenGL context without a display: OSMesa or EGL's surfaceless platform. A build has one of them or both (Mesa
   dropped OSMesa in 25.1). Both are loaded at run time, so the program runs if one is missing. Nothing is drawn to the
   context's own surface: the canvas has a framebuffer, so both run the same code. */

typedef enum ContextChoice { CONTEXT_AUTO, CONTEXT_OSMESA, CONTEXT_EGL } ContextChoice;

typedef struct ContextKind {
    ContextChoice choice;
    const char *name;
    /* Loads the libraries and creates a context; NULL with error set on failure. */
    void *(*create)(Error *error);
    bool (*make_current)(void *state);
    GlFunction (*find)(void *state, const char *name);
    void (*destroy)(void *state);
} ContextKind;

extern const ContextKind context_osmesa, context_egl;

/* What context_egl creates, but on a platform's display (EGL_EXT_platform_device: a graphics card) and of a version. */
void *context_egl_open(unsigned platform, void *native, int major, int minor, Error *error);

/* Those that are built in, in the order in which CONTEXT_AUTO tries them. NULL ends them. */
extern const ContextKind *const context_kinds[];

typedef struct Context {
    const ContextKind *kind;
    void *state;
} Context;

/* NULL: CONTEXT_AUTO, or not built in. */
const ContextKind *context_kind(ContextChoice wanted);

/* Creates a context of this kind; CONTEXT_AUTO takes the first kind that works. ERROR_SYSTEM names the packages to
   install, ERROR_INPUT a kind that is not built in. */
bool context_create(Context *context, ContextChoice wanted, Error *error);
bool context_make_current(const Context *context, Error *error);
void context_destroy(Context *context);

/* A function to load, and its offset in the struct that holds it. */
typedef struct ContextFunction {
    const char *name;
    size_t offset;
} ContextFunction;

/* Opens a library and fills `table`. The library is never closed: Mesa does not survive it. `package` is its Debian
   package. */
bool context_load(const char *library, const char *package, const ContextFunction *functions, int count, void *table,
                  Error *error);
