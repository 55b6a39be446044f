/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files: .npz with version, kind ("gns"), command, shape[2] (width, rounds) as int32, and as float32 scales[5] and
   parameters [layout.parameters]. */
#include "base/base.h"
#include "base/npz.h"
#include "nets/kinds.h"
#include "nets/nets.h"

#include <stdlib.h>
#include <string.h>

#define KIND "gns"

enum { ARRAYS = 2, SHAPE = 2 };

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

GnsLayout gns_layout(int width, int rounds) {
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
    *net = (GnsNet){.layout = gns_layout(width, rounds)};
    net->parameters = calloc((size_t)net->layout.parameters, sizeof *net->parameters);
    return net->parameters != NULL || error_memory(error, KIND);
}

void gns_net_free(GnsNet *net) {
    free(net->parameters);
    net->parameters = NULL;
}

/* One list for writing and reading. */
static void list_floats(GnsNet *net, float scales[5], FileFloats list[ARRAYS]) {
    list[0] = (FileFloats){"scales", 1, {5}, scales, &float_positive};
    list[1] = (FileFloats){"parameters", 1, {net->layout.parameters}, net->parameters, &float_any};
}

bool gns_net_write(const GnsNet *net, const char *path, Error *error) {
    const int32_t version = GNS_VERSION, shape[SHAPE] = {net->layout.width, net->layout.rounds};
    float scales[5] = {net->scales.radius, net->scales.velocity, net->scales.acceleration, net->scales.fastest,
                       net->scales.strongest};
    GnsNet copy = *net;
    FileFloats list[ARRAYS];
    list_floats(&copy, scales, list);
    NpzArray arrays[4 + ARRAYS] = {{.name = "version", .type = NPZ_INT32, .data = &version},
                                   {.name = "kind", .type = NPZ_TEXT, .data = KIND},
                                   {.name = "command", .type = NPZ_TEXT, .data = net->command},
                                   {.name = "shape", .type = NPZ_INT32, .rank = 1, .shape = {SHAPE}, .data = shape}};
    for (int i = 0; i < ARRAYS; i++) arrays[4 + i] = file_floats_array(&list[i]);
    return npz_write(path, arrays, 4 + ARRAYS, error);
}

static bool read_shape(NpzFile *file, int *width, int *rounds, Error *error) {
    const int64_t count = SHAPE;
    int32_t *shape = npz_read(file, "shape", NPZ_INT32, 1, &count, error);
    if (shape == NULL) return false;
    *width = shape[0];
    *rounds = shape[1];
    free(shape);
    if (*width < GNS_WIDTH_STEP || *width > GNS_MAX_WIDTH || *width % GNS_WIDTH_STEP != 0)
        return error_input(error, npz_path(file), "the width is %d; expected a multiple of %d up to %d", *width,
                           GNS_WIDTH_STEP, GNS_MAX_WIDTH);
    if (*rounds < 1 || *rounds > GNS_MAX_ROUNDS)
        return error_input(error, npz_path(file), "there are %d rounds; expected 1 to %d", *rounds, GNS_MAX_ROUNDS);
    return true;
}

static bool read_all(NpzFile *file, GnsNet *net, Error *error) {
    int width, rounds;
    float scales[5];
    FileFloats list[ARRAYS];
    char command[GNS_COMMAND_SIZE];
    if (!npz_check_kind(file, KIND, GNS_VERSION, error) ||
        !npz_read_text(file, "command", command, sizeof command, error) || !read_shape(file, &width, &rounds, error))
        return false;
    GnsNet shape = {.layout = gns_layout(width, rounds)};
    list_floats(&shape, scales, list);
    /* Before memory is taken: a file can claim any shape. */
    if (!file_floats_expect(file, list, ARRAYS, error) || !gns_net_create(net, width, rounds, error)) return false;
    list_floats(net, scales, list);
    if (!file_floats_read(file, list, ARRAYS, error)) return false;
    net->scales = (GnsScales){scales[0], scales[1], scales[2], scales[3], scales[4]};
    memcpy(net->command, command, sizeof command);
    return true;
}

bool gns_net_read(GnsNet *net, const char *path, Error *error) {
    *net = (GnsNet){.parameters = NULL};
    NpzFile *file = npz_open(path, error);
    if (file == NULL) return false;
    const bool ok = read_all(file, net, error);
    npz_close(file);
    return ok;
}
