/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files: .npz with version, kind ("interior-net"), command, and as float32 hidden_weights[hidden, inputs],
   output_weights[outputs, hidden], hidden_biases[globals, hidden], output_biases[globals, outputs]. */
#include "network/interior_net.h"

#include "network/file_floats.h"

#define KIND "interior-net"

enum { ARRAYS = 4 };

/* One list for writing and reading. */
static void list_floats(float weights[INTERIOR_NET_WEIGHTS], FileFloats list[ARRAYS]) {
    const FileFloats all[ARRAYS] = {{"hidden_weights",
                                     2,
                                     {INTERIOR_NET_HIDDEN, INTERIOR_NET_INPUTS},
                                     weights + INTERIOR_NET_HIDDEN_WEIGHTS,
                                     &float_any},
                                    {"output_weights",
                                     2,
                                     {INTERIOR_NET_OUTPUTS, INTERIOR_NET_HIDDEN},
                                     weights + INTERIOR_NET_OUTPUT_WEIGHTS,
                                     &float_any},
                                    {"hidden_biases",
                                     2,
                                     {INTERIOR_NET_GLOBALS, INTERIOR_NET_HIDDEN},
                                     weights + INTERIOR_NET_HIDDEN_BIASES,
                                     &float_any},
                                    {"output_biases",
                                     2,
                                     {INTERIOR_NET_GLOBALS, INTERIOR_NET_OUTPUTS},
                                     weights + INTERIOR_NET_OUTPUT_BIASES,
                                     &float_any}};
    memcpy(list, all, sizeof all);
}

bool interior_net_write(const InteriorNet *net, const char *path, Error *error) {
    const int32_t version = INTERIOR_NET_VERSION;
    float weights[INTERIOR_NET_WEIGHTS];
    for (int i = 0; i < INTERIOR_NET_WEIGHTS; i++) weights[i] = (float)net->weights[i];
    FileFloats list[ARRAYS];
    list_floats(weights, list);
    NpzArray arrays[3 + ARRAYS] = {{.name = "version", .type = NPZ_INT32, .data = &version},
                                   {.name = "kind", .type = NPZ_TEXT, .data = KIND},
                                   {.name = "command", .type = NPZ_TEXT, .data = net->command}};
    for (int i = 0; i < ARRAYS; i++) arrays[3 + i] = file_floats_array(&list[i]);
    return npz_write(path, arrays, 3 + ARRAYS, error);
}

bool interior_net_read(InteriorNet *net, const char *path, Error *error) {
    *net = (InteriorNet){0};
    NpzFile *file = npz_open(path, error);
    if (file == NULL) return false;
    float weights[INTERIOR_NET_WEIGHTS];
    FileFloats list[ARRAYS];
    list_floats(weights, list);
    const bool ok = npz_check_kind(file, KIND, INTERIOR_NET_VERSION, error) &&
                    npz_read_text(file, "command", net->command, sizeof net->command, error) &&
                    file_floats_read(file, list, ARRAYS, error);
    npz_close(file);
    for (int i = 0; ok && i < INTERIOR_NET_WEIGHTS; i++) net->weights[i] = (double)weights[i];
    return ok;
}
