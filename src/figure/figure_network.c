/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A network: its layers, their widths, its weights. */
#include "common/file.h"
#include "figure/figure_kinds.h"
#include "figure/latex.h"
#include "figure/network_drawing.h"
#include "figure/run_view.h"
#include "npz/npz.h"
#include "picture/style.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

const char *activation_name(Activation activation) {
    static const char *const words[] = {[ACTIVATION_LINEAR] = "linear",
                                        [ACTIVATION_SIGMOID] = "sigmoid",
                                        [ACTIVATION_TANH] = "tanh",
                                        [ACTIVATION_RELU] = "relu"};
    return words[activation];
}

void format_widths(char text[WIDTHS_TEXT_SIZE], const Network *network) {
    int used = 0;
    for (int i = 0; i <= network->layers; i++)
        used += snprintf(text + used, (size_t)(WIDTHS_TEXT_SIZE - used), "%s%d", i > 0 ? "-" : "", network->widths[i]);
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

double network_title_height(const FigureSpec *spec) { return 1.5 * line_height(spec->points); }

void draw_network_title(Sketch *sketch, const FigureSpec *spec, const char *title) {
    const double line = line_height(spec->points);
    char words[NETWORK_TEXT_SIZE];
    snprintf(words, sizeof words, "%s", title);
    if (spec->facts != NULL) snprintf(spec->facts->network, sizeof spec->facts->network, "%s", title);
    text_fit(words, sizeof words, spec->points, sketch->width);
    sketch_text(sketch, (Point){0.2, sketch->height - 0.6 * line}, &(TextStyle){spec->points, TEXT_LEFT, INK, 0, false},
                "%s", words);
}

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
    .example = "network scenes/networks/pair-net.npz --width column -o network.pdf",
    .draw = draw,
    .caption = caption,
};
