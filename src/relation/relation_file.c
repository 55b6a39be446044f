/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files of sain: .npz with version, kind ("sain"), command, and as float32 for each form F = on, off, shuffled:
   F_pair_weights and F_body_weights, weights and biases of the relation and the object network, each as one vector
   (network_gradient.h); offsets and scales of their inputs, F_pair_offset, F_pair_scale, F_body_offset, F_body_scale;
   ranges, F_pair_low, F_pair_high, F_body_low, F_body_high; F_limit. */
#include "relation/relation_network.h"

#include "network/file_floats.h"

#include <stdio.h>
#include <string.h>

#define KIND "sain"

enum { FORM_ARRAYS = 11, ARRAYS = RELATION_FORMS * FORM_ARRAYS };

/* One list for writing and reading. */
static void list_form(RelationNetwork *network, const char *form, FileFloats list[FORM_ARRAYS]) {
    Network *relation = network->relation, *object = network->object;
    const FileFloats all[FORM_ARRAYS] = {
        {"pair_weights", 1, {network_parameter_count(relation)}, relation->weights[0], &float_any},
        {"pair_offset", 1, {RELATION_PAIR_INPUTS}, relation->input.offset, &float_any},
        {"pair_scale", 1, {RELATION_PAIR_INPUTS}, relation->input.scale, &float_positive},
        {"body_weights", 1, {network_parameter_count(object)}, object->weights[0], &float_any},
        {"body_offset", 1, {RELATION_OBJECT_INPUTS}, object->input.offset, &float_any},
        {"body_scale", 1, {RELATION_OBJECT_INPUTS}, object->input.scale, &float_positive},
        {"pair_low", 1, {RELATION_PAIR_INPUTS}, network->pair_low, &float_any},
        {"pair_high", 1, {RELATION_PAIR_INPUTS}, network->pair_high, &float_any},
        {"body_low", 1, {RELATION_BODY_INPUTS}, network->body_low, &float_any},
        {"body_high", 1, {RELATION_BODY_INPUTS}, network->body_high, &float_any},
        {"limit", 1, {RELATION_OUTPUTS}, network->limit, &float_not_negative},
    };
    for (int i = 0; i < FORM_ARRAYS; i++) {
        list[i] = all[i];
        snprintf(list[i].name, sizeof list[i].name, "%.8s_%.12s", form, all[i].name);
    }
}

static void list_floats(RelationNetworks *networks, FileFloats list[ARRAYS]) {
    for (int f = 0; f < RELATION_FORMS; f++)
        list_form(&networks->forms[f], relation_form_names[f], list + f * FORM_ARRAYS);
}

bool relation_networks_write(const RelationNetworks *networks, const char *path, Error *error) {
    const int32_t version = RELATION_VERSION;
    RelationNetworks copy = *networks; /* the list has pointers that are not const */
    FileFloats list[ARRAYS];
    list_floats(&copy, list);
    NpzArray arrays[3 + ARRAYS] = {{.name = "version", .type = NPZ_INT32, .data = &version},
                                   {.name = "kind", .type = NPZ_TEXT, .data = KIND},
                                   {.name = "command", .type = NPZ_TEXT, .data = networks->command}};
    for (int i = 0; i < ARRAYS; i++) arrays[3 + i] = file_floats_array(&list[i]);
    return npz_write(path, arrays, 3 + ARRAYS, error);
}

static bool create_forms(RelationNetworks *networks, Error *error) {
    for (int f = 0; f < RELATION_FORMS; f++)
        if (!relation_network_create(&networks->forms[f], error)) return false;
    return true;
}

bool relation_networks_read(RelationNetworks *networks, const char *path, Error *error) {
    *networks = (RelationNetworks){0};
    NpzFile *file = npz_open(path, error);
    if (file == NULL) return false;
    FileFloats list[ARRAYS];
    bool ok = npz_check_kind(file, KIND, RELATION_VERSION, error) && create_forms(networks, error);
    if (ok) {
        list_floats(networks, list);
        ok = file_floats_read(file, list, ARRAYS, error) &&
             npz_read_text(file, "command", networks->command, sizeof networks->command, error);
    }
    npz_close(file);
    if (!ok) relation_networks_destroy(networks);
    return ok;
}
