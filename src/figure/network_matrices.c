/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A picture per matrix. If it has more weights than pixels, each pixel shows the largest weight that it covers. */
#include "common/file.h"
#include "figure/network_drawing.h"
#include "figure/run_view.h"
#include "picture/style.h"
#include "type/type.h"

#include <math.h>

enum { MATRICES_MAX = NETWORK_MAX_LAYERS };

static const double max_width = 56, min_width = 36, gap = 4, aspect = 0.6; /* mm, width of a picture and gap; height /
                                                                          width */
static const double small_type = 0.85;

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
    double width, height, row; /* mm: size of a picture; distance between rows of pictures */
} Matrices;

static double weight_at(const Matrix *matrix, int input, int output) {
    size_t i = matrix->by_input ? (size_t)input * (size_t)matrix->outputs + (size_t)output
                                : (size_t)output * (size_t)matrix->inputs + (size_t)input;
    return (double)matrix->weights[i];
}

static double find_largest(const Matrix *matrix) {
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

static bool draw_matrix(const Matrices *all, Sketch *sketch, int i, Error *error) {
    const Matrix *matrix = &all->matrices[i];
    const double points = all->spec->points, line = line_height(points), small = small_type * points;
    const double largest = find_largest(matrix), column = i % all->columns;
    const double top = sketch->height - network_title_height(all->spec) - (i / all->columns) * all->row;
    const Point low = {0.2 + column * (all->width + gap), top - line - all->height};
    char words[96];
    if (!draw_weights(all, sketch, matrix, low, largest, error)) return false;
    sketch_rectangle(sketch, low, (Point){low.x + all->width, low.y + all->height},
                     &(Pen){NO_COLOUR, 1, FRAME, 1, NULL});
    snprintf(words, sizeof words, "%s%s%s", matrix->name, matrix->activation[0] != '\0' ? ", " : "",
             matrix->activation);
    text_fit(words, sizeof words, points, all->width);
    sketch_text(sketch, (Point){low.x, top - line / 2}, &(TextStyle){points, TEXT_LEFT, INK, 0, false}, "%s", words);
    snprintf(words, sizeof words, "%d to %d, max |w| %.2g", matrix->inputs, matrix->outputs, largest);
    text_fit(words, sizeof words, small, all->width);
    sketch_text(sketch, (Point){low.x, low.y - 0.6 * line}, &(TextStyle){small, TEXT_LEFT, INK_SOFT, 0, false}, "%s",
                words);
    return true;
}

/* The colour scale, from the most negative to the most positive weight. */
static void draw_color_scale(const Matrices *all, Sketch *sketch) {
    enum { STEPS = 20 };
    const double points = small_type * all->spec->points, y = 0.5 * line_height(points), high = 2, cell = 1;
    const TextStyle words = {points, TEXT_LEFT, INK, 0, false};
    sketch_text(sketch, (Point){0.2, y}, &words, "negative");
    double x = 0.2 + type_width("negative", points) + 1.2;
    const double start = x;
    for (int i = 0; i < STEPS; i++, x += cell) {
        const Pen pen = {weight_colour(2.0 * i / (STEPS - 1) - 1), 1, NO_COLOUR, 0, NULL};
        sketch_rectangle(sketch, (Point){x, y - high / 2}, (Point){x + cell, y + high / 2}, &pen);
    }
    sketch_rectangle(sketch, (Point){start, y - high / 2}, (Point){x, y + high / 2},
                     &(Pen){NO_COLOUR, 1, FRAME, 1, NULL});
    sketch_text(sketch, (Point){x + 1.2, y}, &words, "positive; columns: inputs, rows: outputs");
}

static bool draw_all(Sketch *sketch, const FigureSpec *spec, const Matrix *matrices, int count, const char *title,
                     Error *error) {
    Matrices all = {.spec = spec, .count = count, .matrices = matrices};
    const double usable = spec->width - 0.4, line = line_height(spec->points);
    all.columns = (int)fmax(floor((usable + gap) / (min_width + gap)), 1);
    if (all.columns > count) all.columns = count;
    all.rows = (count + all.columns - 1) / all.columns;
    all.width = fmin((usable - (all.columns - 1) * gap) / all.columns, max_width);
    all.height = aspect * all.width;
    all.row = all.height + 2.5 * line;
    sketch_begin(sketch, spec->width, network_title_height(spec) + all.rows * all.row + 1.2 * line);
    for (int i = 0; i < count; i++)
        if (!draw_matrix(&all, sketch, i, error)) return false;
    draw_color_scale(&all, sketch);
    draw_network_title(sketch, spec, title);
    return true;
}

bool draw_dense_matrices(Sketch *sketch, const FigureSpec *spec, const Network *network, Error *error) {
    Matrix matrices[MATRICES_MAX];
    char title[NETWORK_TEXT_SIZE + 128], widths[WIDTHS_TEXT_SIZE], names[MATRICES_MAX][24];
    for (int i = 0; i < network->layers; i++) {
        snprintf(names[i], sizeof names[i], "layer %d", i + 1);
        matrices[i] = (Matrix){names[i],
                               activation_name(network->activations[i]),
                               network->weights[i],
                               network->widths[i],
                               network->widths[i + 1],
                               false};
    }
    format_widths(widths, network);
    snprintf(title, sizeof title, "%s: %s, %d parameters", spec->network + file_folder_length(spec->network), widths,
             network_parameter_count(network));
    return draw_all(sketch, spec, matrices, network->layers, title, error);
}

static Matrix projection_matrix(const char *name, const Projection *projection) {
    return (Matrix){name, "", projection->rows, projection->from, projection->to, true};
}

static Matrix layer_matrix(const char *name, const SlotLayer *layer) {
    return (Matrix){name, "tanh", layer->rows, layer->from, layer->to, true};
}

bool draw_slot_matrices(Sketch *sketch, const FigureSpec *spec, const SlotNetwork *network, Error *error) {
    const Matrix matrices[] = {
        projection_matrix("bomb's state", &network->bomb_state),
        projection_matrix("other bodies' state", &network->state),
        projection_matrix("contact flags", &network->present),
        projection_matrix("warm-start impulses", &network->warm),
        layer_matrix("layer 1", &network->first),
        layer_matrix("layer 2", &network->second),
        {"impulses", "linear", network->rows, network->second.to, 2 * network->slot_count, false},
    };
    char title[NETWORK_TEXT_SIZE + 160];
    snprintf(title, sizeof title, "%s: %d bodies, %d contacts, %zu parameters",
             spec->network + file_folder_length(spec->network), network->body_count, network->slot_count,
             network->parameter_count);
    return draw_all(sketch, spec, matrices, (int)(sizeof matrices / sizeof *matrices), title, error);
}
