/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The figure of a network: its units and weights, or its matrices if it has too many units. */
#include "base/base.h"
#include "base/file.h"
#include "base/npz.h"
#include "figures/figure.h"
#include "figures/figures_internal.h"
#include "figures/sketch.h"
#include "nets/kinds.h"
#include "nets/nets.h"
#include "pictures/picture.h"
#include "pixels/png.h"
#include "pixels/type.h"

#include <assert.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* "sigmoid" */
static const char *activation_name(Activation activation) {
    static const char *const words[] = {[ACTIVATION_LINEAR] = "linear",
                                        [ACTIVATION_SIGMOID] = "sigmoid",
                                        [ACTIVATION_TANH] = "tanh",
                                        [ACTIVATION_RELU] = "relu"};
    return words[activation];
}

/* Mixes a colour with white. */
static uint32_t mix(uint32_t colour, double share) {
    uint32_t mixed = 0;
    for (int shift = 0; shift < 24; shift += 8) {
        double channel = (double)(colour >> shift & 255);
        mixed |= (uint32_t)lrint(255 + share * (channel - 255)) << shift;
    }
    return mixed;
}

uint32_t weight_colour(double share) {
    const uint32_t above = 0x004C80, below = 0xE69F00;
    return mix(share > 0 ? above : below, fmin(fabs(share), 1));
}

/* The title: the file, and what is in it. */
static WrappedText network_title(const FigureSpec *spec, const char *format, ...) PRINTF_LIKE(2, 3);
static WrappedText network_title(const FigureSpec *spec, const char *format, ...) {
    char title[NETWORK_TEXT_SIZE + 160];
    const int used = snprintf(title, NETWORK_TEXT_SIZE, "%s: ", spec->network + file_folder_length(spec->network));
    const size_t begin = used < NETWORK_TEXT_SIZE ? (size_t)used : NETWORK_TEXT_SIZE - 1;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(title + begin, sizeof title - begin, format, arguments);
    va_end(arguments);
    if (spec->facts != NULL) snprintf(spec->facts->network, sizeof spec->facts->network, "%s", title);
    return wrap_text(spec->points, spec->width - 2 * PAGE_EDGE, "%s", title);
}

/* In mm. */
static double network_title_height(const FigureSpec *spec, const WrappedText *title) {
    return (title->lines + 0.5) * line_height(spec->points);
}

static void draw_network_title(Sketch *sketch, const FigureSpec *spec, const WrappedText *title) {
    draw_wrapped(sketch, (Point){PAGE_EDGE, sketch->height - 0.6 * line_height(spec->points)}, INK, title);
}

/* "10-10-2, 132 parameters" */
static WrappedText dense_title(const FigureSpec *spec, const Network *network) {
    char widths[64];
    for (int i = 0, used = 0; i <= network->layers; i++)
        used += snprintf(widths + used, sizeof widths - (size_t)used, "%s%d", i > 0 ? "-" : "", network->widths[i]);
    return network_title(spec, "%s, %d parameters", widths, network_parameter_count(network));
}

/* A picture per matrix. If it has more weights than pixels, each pixel shows the largest weight that it covers. */

enum { MATRICES_MAX = NETWORK_MAX_LAYERS };

static const double widest_matrix = 56, narrowest_matrix = 36, matrix_gap = 4; /* mm */
static const double aspect = 0.6;                                              /* height / width of a picture */

typedef struct Matrix {
    const char *name;
    const char *activation;
    const float *weights; /* [outputs, inputs], or with by_input [inputs, outputs] */
    int inputs, outputs;
    bool by_input;
} Matrix;

typedef struct Matrices {
    const FigureSpec *spec;
    int count, columns, rows;
    const Matrix *matrices;
    double width, height; /* mm: size of a picture */
    int above, below;     /* lines of text above and below each picture */
    double top;           /* mm: of the first row */
} Matrices;

static double weight_at(const Matrix *matrix, int input, int output) {
    size_t i = matrix->by_input ? (size_t)input * (size_t)matrix->outputs + (size_t)output
                                : (size_t)output * (size_t)matrix->inputs + (size_t)input;
    return (double)matrix->weights[i];
}

static double largest_in_matrix(const Matrix *matrix) {
    double largest = 0;
    for (size_t i = 0; i < (size_t)matrix->inputs * (size_t)matrix->outputs; i++)
        largest = fmax(largest, fabs((double)matrix->weights[i]));
    return largest;
}

/* The weight of the largest magnitude that the pixel covers. */
static double weight_of_pixel(const Matrix *matrix, int x, int y, int columns, int rows) {
    int first = (int)((int64_t)x * matrix->inputs / columns), top = (int)((int64_t)y * matrix->outputs / rows);
    int end = (int)((int64_t)(x + 1) * matrix->inputs / columns),
        bottom = (int)((int64_t)(y + 1) * matrix->outputs / rows);
    double largest = 0;
    for (int output = top; output < bottom || output == top; output++)
        for (int input = first; input < end || input == first; input++) {
            double weight = weight_at(matrix, input, output);
            if (fabs(weight) > fabs(largest)) largest = weight;
        }
    return largest;
}

static bool draw_weights(const Matrices *all, Sketch *sketch, const Matrix *matrix, Point low, double largest,
                         Error *error) {
    const double dots = all->spec->dpi / 25.4;
    const int columns = (int)fmax(rint(all->width * dots), 1), rows = (int)fmax(rint(all->height * dots), 1);
    Image *image = image_create(columns, rows, error);
    if (image == NULL) return false;
    for (int y = 0; y < rows; y++)
        for (int x = 0; x < columns; x++) {
            double weight = weight_of_pixel(matrix, x, y, columns, rows);
            uint32_t colour = weight_colour(largest > 0 ? weight / largest : 0);
            uint8_t *pixel = image->pixels + 4 * ((size_t)y * (size_t)columns + (size_t)x);
            pixel[0] = (uint8_t)(colour >> 16), pixel[1] = (uint8_t)(colour >> 8), pixel[2] = (uint8_t)colour;
            pixel[3] = 255;
        }
    sketch_image(sketch, image, low, columns / dots);
    image_destroy(image);
    return true;
}

static WrappedText matrix_name(const Matrices *all, const Matrix *matrix) {
    return wrap_text(all->spec->points, all->width, "%s%s%s", matrix->name, matrix->activation[0] != '\0' ? ", " : "",
                     matrix->activation);
}

static WrappedText matrix_facts(const Matrices *all, const Matrix *matrix) {
    return wrap_text(SMALL_TYPE * all->spec->points, all->width, "%d to %d, max |w| %.2g", matrix->inputs,
                     matrix->outputs, largest_in_matrix(matrix));
}

/* mm: between rows of pictures. */
static double row_of_matrices(const Matrices *all) {
    return all->height + (all->above + all->below + 0.5) * line_height(all->spec->points);
}

static bool draw_matrix(const Matrices *all, Sketch *sketch, int i, Error *error) {
    const Matrix *matrix = &all->matrices[i];
    const double line = line_height(all->spec->points), column = i % all->columns;
    const double top = all->top - (i / all->columns) * row_of_matrices(all);
    const Point low = {PAGE_EDGE + column * (all->width + matrix_gap), top - all->above * line - all->height};
    const WrappedText name = matrix_name(all, matrix), facts = matrix_facts(all, matrix);
    if (!draw_weights(all, sketch, matrix, low, largest_in_matrix(matrix), error)) return false;
    sketch_rectangle(sketch, low, (Point){low.x + all->width, low.y + all->height},
                     &(Pen){NO_COLOUR, 1, FRAME, 1, NULL});
    draw_wrapped(sketch, (Point){low.x, low.y + all->height + (name.lines - 0.5) * line}, INK, &name);
    draw_wrapped(sketch, (Point){low.x, low.y - 0.6 * line}, INK_SOFT, &facts);
    return true;
}

/* The colour scale, from the most negative to the most positive weight, and the axes. Returns the rows; without a sketch, it
   only counts them. */
static int draw_color_scale(const Matrices *all, Sketch *sketch, double top) {
    enum { STEPS = 20 };
    const double points = SMALL_TYPE * all->spec->points, high = 2, gap = 1.2;
    const double width = all->spec->width - 2 * PAGE_EDGE, before = type_width("negative", points) + gap;
    const double after = gap + type_width("positive", points), cell = fmin(1, (width - before - after) / STEPS);
    const WrappedText axes = wrap_text(points, width, "columns: inputs, rows: outputs");
    const TextStyle words = {points, TEXT_LEFT, INK, 0, false};
    Flow flow = {.first = {PAGE_EDGE, top - 0.5 * line_height(points)}, .width = width, .points = points};
    const Point at = flow_place(&flow, before + STEPS * cell + after, 1);
    flow_text(&flow, sketch, INK, &axes);
    if (sketch == NULL) return flow.row + 1;
    const Point low = {at.x + before, at.y - high / 2}, end = {low.x + STEPS * cell, low.y + high};
    for (int i = 0; i < STEPS; i++) {
        const Pen pen = {weight_colour(2.0 * i / (STEPS - 1) - 1), 1, NO_COLOUR, 0, NULL};
        sketch_rectangle(sketch, (Point){low.x + i * cell, low.y}, (Point){low.x + (i + 1) * cell, end.y}, &pen);
    }
    sketch_rectangle(sketch, low, end, &(Pen){NO_COLOUR, 1, FRAME, 1, NULL});
    sketch_text(sketch, at, &words, "negative");
    sketch_text(sketch, (Point){end.x + gap, at.y}, &words, "positive");
    return flow.row + 1;
}

static bool draw_all(Sketch *sketch, const FigureSpec *spec, const WrappedText *title, const Matrix *matrices,
                     int count, Error *error) {
    assert(count > 0);
    Matrices all = {.spec = spec, .count = count, .matrices = matrices};
    const double usable = spec->width - 2 * PAGE_EDGE, line = line_height(SMALL_TYPE * spec->points);
    all.columns = (int)fmax(floor((usable + matrix_gap) / (narrowest_matrix + matrix_gap)), 1);
    if (all.columns > count) all.columns = count;
    all.rows = (count + all.columns - 1) / all.columns;
    all.width = fmin((usable - (all.columns - 1) * matrix_gap) / all.columns, widest_matrix);
    all.height = aspect * all.width;
    for (int i = 0; i < count; i++) {
        const int above = matrix_name(&all, &matrices[i]).lines, below = matrix_facts(&all, &matrices[i]).lines;
        if (above > all.above) all.above = above;
        if (below > all.below) all.below = below;
    }
    const double foot = (draw_color_scale(&all, NULL, 0) + 0.2) * line;
    sketch_begin(sketch, spec->width, network_title_height(spec, title) + all.rows * row_of_matrices(&all) + foot);
    all.top = sketch->height - network_title_height(spec, title);
    draw_network_title(sketch, spec, title);
    for (int i = 0; i < count; i++)
        if (!draw_matrix(&all, sketch, i, error)) return false;
    draw_color_scale(&all, sketch, foot);
    return true;
}

static bool draw_dense_matrices(Sketch *sketch, const FigureSpec *spec, const Network *network, Error *error) {
    Matrix matrices[MATRICES_MAX];
    char names[MATRICES_MAX][24];
    for (int i = 0; i < network->layers; i++) {
        snprintf(names[i], sizeof names[i], "layer %d", i + 1);
        matrices[i] = (Matrix){names[i],
                               activation_name(network->activations[i]),
                               network->weights[i],
                               network->widths[i],
                               network->widths[i + 1],
                               false};
    }
    const WrappedText title = dense_title(spec, network);
    return draw_all(sketch, spec, &title, matrices, network->layers, error);
}

static Matrix projection_matrix(const char *name, const Projection *projection) {
    return (Matrix){name, "", projection->rows, projection->from, projection->to, true};
}

static Matrix layer_matrix(const char *name, const SlotLayer *layer) {
    return (Matrix){name, "tanh", layer->rows, layer->from, layer->to, true};
}

static bool draw_slot_matrices(Sketch *sketch, const FigureSpec *spec, const SlotNetwork *network, Error *error) {
    const Matrix matrices[] = {
        projection_matrix("bomb's state", &network->bomb_state),
        projection_matrix("other bodies' state", &network->state),
        projection_matrix("contact flags", &network->present),
        projection_matrix("warm-start impulses", &network->warm),
        layer_matrix("layer 1", &network->first),
        layer_matrix("layer 2", &network->second),
        {"impulses", "linear", network->rows, network->second.to, 2 * network->slot_count, false},
    };
    const WrappedText title = network_title(spec, "%d bodies, %d contacts, %zu parameters", network->body_count,
                                            network->slot_count, network->parameter_count);
    return draw_all(sketch, spec, &title, matrices, (int)(sizeof matrices / sizeof *matrices), error);
}

/* A column of units per layer, and a line per weight: stronger ones are darker and wider. */

static const double thinnest = 0.5, thickest = 4.5; /* LINE_UNIT */
static const double max_height = 120, max_step = 5.2,
                    name_gap = 1.5; /* mm: the largest layer; between units; to a name */

typedef struct Units {
    const FigureSpec *spec;
    const Network *network;
    double left, right; /* mm, x of the first and the last column */
    double middle, step, radius;
    double largest; /* weight */
} Units;

static Point unit_place(const Units *units, int layer, int i) {
    double share = (double)layer / units->network->layers;
    double up = ((units->network->widths[layer] - 1) / 2.0 - i) * units->step;
    return (Point){units->left + share * (units->right - units->left), units->middle + up};
}

/* The i-th word of a list such as "dx dy v1x"; false if it has not `count` words. */
static bool nth_word(const char *words, int i, int count, char *word, size_t size) {
    int found = 0;
    for (const char *at = words; *at != '\0';) {
        size_t length = strcspn(at, " ");
        if (length > 0 && found++ == i) snprintf(word, size, "%.*s", (int)length, at);
        at += length + (at[length] == ' ');
    }
    return found == count;
}

static void unit_name(const char *words, int i, int count, char name[32]) {
    if (!nth_word(words, i, count, name, 32)) snprintf(name, 32, "%d", i + 1);
}

/* Of names beside units, which are not farther apart than their step. */
static double name_points(const Units *units) {
    return fmin(SMALL_TYPE * units->spec->points, units->step / MM_PER_POINT);
}

static double widest_name(const Units *units, const char *words, int count) {
    double widest = 0;
    for (int i = 0; i < count; i++) {
        char name[32];
        unit_name(words, i, count, name);
        widest = fmax(widest, type_width(name, name_points(units)));
    }
    return widest;
}

static double largest_weight(const Network *network) {
    double largest = 0;
    for (int l = 0; l < network->layers; l++)
        for (int i = 0; i < network->widths[l] * network->widths[l + 1]; i++)
            largest = fmax(largest, fabs((double)network->weights[l][i]));
    return largest;
}

typedef struct WeightLine {
    double share; /* relative to the largest weight, -1 .. 1 */
    int layer, from, to;
} WeightLine;

/* The strongest last, drawn on top. */
static int by_strength(const void *a, const void *b) {
    const WeightLine *p = a, *q = b;
    double difference = fabs(p->share) - fabs(q->share);
    if (difference != 0) return difference > 0 ? 1 : -1;
    if (p->layer != q->layer) return p->layer - q->layer;
    return p->from != q->from ? p->from - q->from : p->to - q->to;
}

static Pen weight_pen(double share) {
    return pen_line(weight_colour(share), thinnest + (thickest - thinnest) * fabs(share), NULL);
}

static bool draw_weight_lines(const Units *units, Sketch *sketch, Error *error) {
    const Network *network = units->network;
    int count = 0;
    for (int l = 0; l < network->layers; l++) count += network->widths[l] * network->widths[l + 1];
    WeightLine *lines = malloc((size_t)count * sizeof *lines);
    if (lines == NULL) return error_memory(error, "figure");
    count = 0;
    for (int l = 0; l < network->layers; l++)
        for (int to = 0; to < network->widths[l + 1]; to++)
            for (int from = 0; from < network->widths[l]; from++) {
                double weight = (double)network->weights[l][to * network->widths[l] + from];
                lines[count++] = (WeightLine){units->largest > 0 ? weight / units->largest : 0, l, from, to};
            }
    qsort(lines, (size_t)count, sizeof *lines, by_strength);
    for (int i = 0; i < count; i++) {
        const Pen pen = weight_pen(lines[i].share);
        sketch_line(sketch, unit_place(units, lines[i].layer, lines[i].from),
                    unit_place(units, lines[i].layer + 1, lines[i].to), &pen);
    }
    free(lines);
    return true;
}

static void draw_unit_dots(const Units *units, Sketch *sketch) {
    const Network *network = units->network;
    const double small = name_points(units), beside = units->radius + name_gap;
    const Pen pen = {0xFFFFFF, 1, INK, 1.4, NULL};
    const int last = network->layers;
    for (int layer = 0; layer <= last; layer++)
        for (int i = 0; i < network->widths[layer]; i++) {
            const Point at = unit_place(units, layer, i);
            char name[32];
            sketch_dot(sketch, at, units->radius, &pen);
            if (layer > 0 && layer < last) continue;
            unit_name(layer == 0 ? network->inputs : network->outputs, i, network->widths[layer], name);
            sketch_text(sketch, (Point){at.x + (layer == 0 ? -beside : beside), at.y},
                        &(TextStyle){small, layer == 0 ? TEXT_RIGHT : TEXT_LEFT, INK, 0, false}, "%s", name);
        }
}

/* "10 inputs", in two lines where columns are narrow. */
static WrappedText size_of_layer(const Units *units, int layer) {
    const Network *network = units->network;
    const int width = network->widths[layer];
    const double room = (units->right - units->left) / network->layers - name_gap;
    return wrap_text(text_points("outputs", units->spec->points, room), room, "%d %s", width,
                     layer == 0                 ? width == 1 ? "input" : "inputs"
                     : layer == network->layers ? width == 1 ? "output" : "outputs"
                                                : "units");
}

static int lines_of_sizes(const Units *units) {
    int lines = 1;
    for (int layer = 0; layer <= units->network->layers; layer++)
        lines = (int)fmax(lines, size_of_layer(units, layer).lines);
    return lines;
}

/* The meaning of lines. Returns the rows; without a sketch, it only counts them. */
static int draw_samples(const Units *units, Sketch *sketch, double top) {
    const double points = units->spec->points, sample = 7, gap = number_gap(points);
    Flow flow = {.first = {PAGE_EDGE, top - 0.6 * line_height(points)},
                 .width = units->spec->width - 2 * PAGE_EDGE,
                 .points = points};
    for (int sign = 1; sign >= -1; sign -= 2) {
        const Pen pen = weight_pen(sign);
        char words[64];
        snprintf(words, sizeof words, "weight %s", show_decimals(sign * units->largest, 2).text);
        const Point at = flow_place(&flow, sample + gap + type_width(words, points), 1);
        if (sketch == NULL) continue;
        sketch_line(sketch, at, (Point){at.x + sample, at.y}, &pen);
        sketch_text(sketch, (Point){at.x + sample + gap, at.y}, &(TextStyle){points, TEXT_LEFT, INK, 0, false}, "%s",
                    words);
    }
    return flow.row + 1;
}

/* Below the columns the layers' sizes and activations, down from `top`. */
static void draw_footer(const Units *units, Sketch *sketch, double top) {
    const Network *network = units->network;
    const double points = units->spec->points, line = line_height(points);
    for (int layer = 0; layer <= network->layers; layer++) {
        const double x = unit_place(units, layer, 0).x;
        const WrappedText size = size_of_layer(units, layer);
        sketch_lines(sketch, (Point){x, top - 0.7 * line}, &(TextStyle){size.points, TEXT_CENTER, INK, 0, false},
                     size.text);
        if (layer > 0)
            sketch_text(sketch, (Point){x, top - (size.lines + 0.6) * line},
                        &(TextStyle){SMALL_TYPE * points, TEXT_CENTER, INK_SOFT, 0, false}, "%s",
                        activation_name(network->activations[layer - 1]));
    }
}

static bool check_room(const Units *units, Error *error) {
    const double least = 8 * units->network->layers;
    return units->right - units->left >= least ||
           error_input(error, units->spec->network,
                       "the names of inputs and outputs leave %.1f mm for %d layers at a width of %g mm; at least %g "
                       "mm are needed",
                       fmax(units->right - units->left, 0), units->network->layers, units->spec->width, least);
}

static bool draw_units(Sketch *sketch, const FigureSpec *spec, const Network *network, Error *error) {
    const double line = line_height(spec->points);
    const int last = network->layers;
    int most = 0;
    for (int i = 0; i <= last; i++) most = network->widths[i] > most ? network->widths[i] : most;
    Units units = {.spec = spec, .network = network, .largest = largest_weight(network)};
    units.step = fmin(fmax(max_step, 0.8 * line), max_height / most);
    units.radius = fmin(0.3 * units.step, 1.4);
    const double beside = units.radius + name_gap, words = type_width("2 outputs", spec->points) / 2 + 0.3;
    units.left = fmax(widest_name(&units, network->inputs, network->widths[0]) + beside, words) + 0.3;
    units.right =
        spec->width - fmax(widest_name(&units, network->outputs, network->widths[last]) + beside, words) - 0.3;
    if (!check_room(&units, error)) return false;
    const WrappedText title = dense_title(spec, network);
    const double samples = (draw_samples(&units, NULL, 0) + 0.2) * line;
    const double foot = samples + (lines_of_sizes(&units) + 1.1) * line;
    units.middle = foot + most * units.step / 2;
    sketch_begin(sketch, spec->width, foot + most * units.step + network_title_height(spec, &title));
    bool done = draw_weight_lines(&units, sketch, error);
    draw_unit_dots(&units, sketch);
    draw_footer(&units, sketch, foot);
    draw_samples(&units, sketch, samples);
    draw_network_title(sketch, spec, &title);
    return done;
}

/* With more units in a layer, the matrices are drawn. */
enum { UNITS_MAX = 40 };

static bool draw_dense(Sketch *sketch, const FigureSpec *spec, Error *error) {
    Network *network = network_read(spec->network, error);
    if (network == NULL) return false;
    int widest = 0;
    for (int i = 0; i <= network->layers; i++) widest = network->widths[i] > widest ? network->widths[i] : widest;
    bool done = widest <= UNITS_MAX ? draw_units(sketch, spec, network, error)
                                    : draw_dense_matrices(sketch, spec, network, error);
    network_destroy(network);
    return done;
}

static bool draw_slots(Sketch *sketch, const FigureSpec *spec, Error *error) {
    SlotNetwork *network = slot_network_read(spec->network, error);
    bool done = network != NULL && draw_slot_matrices(sketch, spec, network, error);
    slot_network_destroy(network);
    return done;
}

static bool draw(Sketch *sketch, const FigureSpec *spec, Error *error) {
    char kind[64] = "";
    NpzFile *file = npz_open(spec->network, error);
    if (file == NULL) return false;
    Error cause = {0};
    bool known = npz_has(file, "kind") && npz_read_text(file, "kind", kind, sizeof kind, &cause);
    npz_close(file);
    if (cause.kind == ERROR_SYSTEM) {
        *error = cause;
        return false;
    }
    if (known && strcmp(kind, "network") == 0) return draw_dense(sketch, spec, error);
    if (known && strcmp(kind, "scene-net") == 0) return draw_slots(sketch, spec, error);
    return error_input(error, spec->network, "contains no network with layers%s", known ? "" : ": it states no kind");
}

static void caption(FILE *out, const FigureSpec *spec) {
    const char *name = spec->network + file_folder_length(spec->network), *facts = spec->facts->network;
    fputs("Layers and weights of the network ", out);
    latex_code(out, name);
    latex_text(out, strncmp(facts, name, strlen(name)) == 0 ? facts + strlen(name) : "");
    fputs(".", out);
}

const FigureKind figure_network = {
    .name = "network",
    .summary = "layers, sizes and weights of a network's file",
    .example = "network scenes/networks/pair-net.npz -o network.pdf",
    .draw = draw,
    .caption = caption,
};
