/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Networks of gns: where the parameters of each perceptron are, and files of kind "gns". */
#include "base/base.h"
#include "base/npz.h"
#include "nets/kinds.h"
#include "nets/nets.h"

#include <stdlib.h>

static int take(int *next, int count) {
    const int at = *next;
    *next += count;
    return at;
}

static GnsMlp make_mlp(int *next, int inputs, int width, int outputs, bool normalised) {
    GnsMlp mlp = {.inputs = inputs, .width = width, .outputs = outputs, .gain = -1, .offset = -1};
    const int widths[4] = {inputs, width, width, outputs};
    for (int l = 0; l < 3; l++) {
        mlp.weights[l] = take(next, widths[l] * widths[l + 1]);
        mlp.biases[l] = take(next, widths[l + 1]);
    }
    if (normalised) {
        mlp.gain = take(next, outputs);
        mlp.offset = take(next, outputs);
    }
    return mlp;
}

/* width: a multiple of GNS_WIDTH_STEP up to GNS_MAX_WIDTH; rounds: 1 to GNS_MAX_ROUNDS. */
static GnsLayout lay_out(int width, int rounds) {
    GnsLayout layout = {.width = width, .rounds = rounds};
    int next = 0;
    layout.nodes = make_mlp(&next, GNS_NODE_INPUTS, width, width, true);
    layout.edges = make_mlp(&next, GNS_EDGE_INPUTS, width, width, true);
    for (int m = 0; m < rounds; m++) {
        layout.edge_rounds[m] = make_mlp(&next, 3 * width, width, width, true);
        layout.node_rounds[m] = make_mlp(&next, 2 * width, width, width, true);
    }
    layout.decoder = make_mlp(&next, width, width, GNS_OUTPUTS, false);
    layout.parameters = next;
    return layout;
}

bool gns_net_create(GnsNet *net, int width, int rounds, Error *error) {
    *net = (GnsNet){.layout = lay_out(width, rounds)};
    net->parameters = calloc((size_t)net->layout.parameters, sizeof *net->parameters);
    return net->parameters != NULL || error_memory(error, "gns");
}

void gns_net_free(GnsNet *net) {
    free(net->parameters);
    net->parameters = NULL;
}

static int list_fields(void *of, NetField *fields) {
    GnsNet *net = of;
    const NetField all[] = {
        {"command", NPZ_TEXT, 0, {sizeof net->command}, .data = net->command},
        {"shape", NPZ_INT32, 1, {2}, .data = &net->layout, .known = true}, /* width, rounds */
        {"scales",
         NPZ_FLOAT32,
         1,
         {sizeof net->scales / sizeof(float)},
         .data = &net->scales,
         .range = &float_positive},
        {"gravity", NPZ_FLOAT32, 1, {2}, .data = net->gravity, .range = &float_any},
        {"parameters", NPZ_FLOAT32, 1, {net->layout.parameters}, .data = net->parameters, .range = &float_any}};
    memcpy(fields, all, sizeof all);
    return sizeof all / sizeof *all;
}

static bool read_sizes(void *of, NpzFile *file, Error *error) {
    int32_t shape[2];
    if (net_file_integers(file, "shape", 2, 2, shape, error) == 0) return false;
    const int width = shape[0], rounds = shape[1];
    if (width < GNS_WIDTH_STEP || width > GNS_MAX_WIDTH || width % GNS_WIDTH_STEP != 0)
        return error_input(error, npz_path(file), "the width is %d; expected a multiple of %d up to %d", width,
                           GNS_WIDTH_STEP, GNS_MAX_WIDTH);
    if (rounds < 1 || rounds > GNS_MAX_ROUNDS)
        return error_input(error, npz_path(file), "there are %d rounds; expected 1 to %d", rounds, GNS_MAX_ROUNDS);
    ((GnsNet *)of)->layout = lay_out(width, rounds);
    return true;
}

static bool create_gns_net(void *of, Error *error) {
    GnsNet *net = of;
    return gns_net_create(net, net->layout.width, net->layout.rounds, error);
}

static const NetFileKind kind = {"gns", GNS_VERSION, list_fields, read_sizes, create_gns_net, NULL};

bool gns_net_write(const GnsNet *net, const char *path, Error *error) {
    return net_file_write(&kind, net, path, error);
}

bool gns_net_read(GnsNet *net, const char *path, Error *error) {
    *net = (GnsNet){.parameters = NULL};
    return net_file_read(&kind, net, path, error);
}
