/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A column of units per layer, and a line per weight: stronger ones are darker and wider. */
#include "common/file.h"
#include "figure/network_drawing.h"
#include "figure/run_view.h"
#include "picture/style.h"
#include "type/type.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double small_type = 0.85;                           /* font size of names / the figure's font size */
static const double min_width = 0.5, max_width = 4.5;            /* LINE_UNIT */
static const double max_height = 120, max_step = 5.2, gap = 1.5; /* mm: height of the largest layer; between units;
                                                                 beside a name */

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

static double widest_name(const Units *units, const char *words, int count) {
    double widest = 0;
    for (int i = 0; i < count; i++) {
        char name[32];
        unit_name(words, i, count, name);
        widest = fmax(widest, type_width(name, small_type * units->spec->points));
    }
    return widest;
}

static double find_largest(const Network *network) {
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
    return pen_line(weight_colour(share), min_width + (max_width - min_width) * fabs(share), NULL);
}

static bool draw_weights(const Units *units, Sketch *sketch, Error *error) {
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
    const double small = small_type * units->spec->points, beside = units->radius + gap;
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

/* Below the columns the layers' sizes and activations, below these the meaning of lines. */
static void draw_footer(const Units *units, Sketch *sketch) {
    const Network *network = units->network;
    const double line = line_height(units->spec->points), points = units->spec->points;
    const TextStyle center = {points, TEXT_CENTER, INK, 0, false}, left = {points, TEXT_LEFT, INK, 0, false};
    const double sample = 7;
    for (int layer = 0; layer <= network->layers; layer++) {
        const double x = unit_place(units, layer, 0).x;
        sketch_text(sketch, (Point){x, 2.6 * line}, &center, "%d %s", network->widths[layer],
                    layer == 0                 ? network->widths[0] == 1 ? "input" : "inputs"
                    : layer == network->layers ? network->widths[layer] == 1 ? "output" : "outputs"
                                               : "units");
        if (layer > 0)
            sketch_text(sketch, (Point){x, 1.7 * line},
                        &(TextStyle){small_type * points, TEXT_CENTER, INK_SOFT, 0, false}, "%s",
                        activation_name(network->activations[layer - 1]));
    }
    double x = 0.2;
    for (int sign = 1; sign >= -1; sign -= 2) {
        const Pen pen = weight_pen(sign);
        const Point from = {x, 0.6 * line}, to = {x + sample, 0.6 * line};
        char words[64];
        snprintf(words, sizeof words, "weight %s", show_decimals(sign * units->largest, 2).text);
        sketch_line(sketch, from, to, &pen);
        sketch_text(sketch, (Point){to.x + 1.2, to.y}, &left, "%s", words);
        x = to.x + 1.2 + type_width(words, points) + 4;
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

bool draw_units(Sketch *sketch, const FigureSpec *spec, const Network *network, Error *error) {
    const double line = line_height(spec->points), foot = 3.3 * line;
    const int last = network->layers;
    int most = 0;
    for (int i = 0; i <= last; i++) most = network->widths[i] > most ? network->widths[i] : most;
    Units units = {.spec = spec, .network = network, .largest = find_largest(network)};
    units.step = fmin(max_step, max_height / most);
    units.radius = fmin(0.3 * units.step, 1.4);
    const double beside = units.radius + gap, words = type_width("99 outputs", spec->points) / 2;
    units.left = fmax(widest_name(&units, network->inputs, network->widths[0]) + beside, words) + 0.3;
    units.right =
        spec->width - fmax(widest_name(&units, network->outputs, network->widths[last]) + beside, words) - 0.3;
    if (!check_room(&units, error)) return false;
    units.middle = foot + most * units.step / 2;
    sketch_begin(sketch, spec->width, foot + most * units.step + network_title_height(spec));
    bool done = draw_weights(&units, sketch, error);
    draw_unit_dots(&units, sketch);
    draw_footer(&units, sketch);
    char title[NETWORK_TEXT_SIZE + 128], widths[WIDTHS_TEXT_SIZE];
    format_widths(widths, network);
    snprintf(title, sizeof title, "%s: %s, %d parameters", spec->network + file_folder_length(spec->network), widths,
             network_parameter_count(network));
    draw_network_title(sketch, spec, title);
    return done;
}
