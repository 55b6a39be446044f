/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "trajectory/run_arrays.h"

#include "common/nearest.h"

#include <string.h>

/* Arrays that come together or not at all. */
enum { ALONE, VELOCITIES, CONTACTS, VERDICT, GROUPS };

static const char *const group_words[GROUPS] = {
    [VELOCITIES] = "the two", [CONTACTS] = "the six contact arrays", [VERDICT] = "the three of the verdict"};

static const struct {
    const char *name;
    int group;
    const char *others[8]; /* what other programs call it, where that is not near its name */
} arrays[] = {
    {"version", ALONE, {NULL}},
    {"scene", ALONE, {NULL}},
    {"method", ALONE, {"engine", "solver", "simulator"}},
    {"scene_hash", ALONE, {NULL}},
    {"iterations", ALONE, {NULL}},
    {"dt", ALONE, {"DT", "Dt", "delta_t", "h", "step", "time_step", "timestep"}},
    {"bomb", ALONE, {NULL}},
    {"camera", ALONE, {NULL}},
    {"size", ALONE, {"box_size", "dimensions", "extent", "extents"}},
    {"fixed", ALONE, {"is_static", "static"}},
    {"position", ALONE, {"center", "centers", "centre", "centres", "pos", "xy"}},
    {"angle", ALONE, {"orientation", "orientations", "rot", "rotation", "rotations", "theta"}},
    {"velocity", VELOCITIES, {"linear_velocity", "vel"}},
    {"angular_velocity", VELOCITIES, {"omega", "spin"}},
    {"contact_start", CONTACTS, {NULL}},
    {"contact_bodies", CONTACTS, {NULL}},
    {"contact_feature", CONTACTS, {NULL}},
    {"contact_point", CONTACTS, {NULL}},
    {"contact_normal", CONTACTS, {NULL}},
    {"contact_impulse", CONTACTS, {NULL}},
    {"verdict", VERDICT, {NULL}},
    {"verdict_frame", VERDICT, {NULL}},
    {"verdict_body", VERDICT, {NULL}},
};
enum { COUNT = sizeof arrays / sizeof *arrays, OTHERS = sizeof arrays[0].others / sizeof *arrays[0].others };

static bool is_known(const char *name) {
    for (int i = 0; i < COUNT; i++)
        if (strcmp(arrays[i].name, name) == 0) return true;
    return false;
}

static bool is_other_name(const char *name, int array) {
    for (int k = 0; k < OTHERS && arrays[array].others[k] != NULL; k++)
        if (strcmp(arrays[array].others[k], name) == 0) return true;
    return false;
}

/* The array that an unknown name probably means, among those that the file lacks; NULL: none. */
static const char *meant(const NpzFile *file, const char *name) {
    const char *missing[COUNT];
    int count = 0;
    for (int i = 0; i < COUNT; i++) {
        if (npz_has(file, arrays[i].name)) continue;
        if (is_other_name(name, i)) return arrays[i].name;
        missing[count++] = arrays[i].name;
    }
    return strlen(name) > 3 ? nearest_word(name, missing, count) : NULL;
}

static bool check_names(const NpzFile *file, Error *error) {
    const char *name, *right;
    for (size_t i = 0; (name = npz_name(file, i)) != NULL; i++)
        if (!is_known(name) && (right = meant(file, name)) != NULL)
            return error_input(error, npz_path(file), "unknown array '%s': did you mean '%s'? Rename or remove it",
                               name, right);
    return true;
}

static bool check_needed(const NpzFile *file, Error *error) {
    static const char *const needed[] = {"position", "angle", "size", "dt"};
    const char *missing = NULL;
    int found = 0;
    for (int i = 3; i >= 0; i--) {
        if (npz_has(file, needed[i]))
            found++;
        else
            missing = needed[i];
    }
    return missing == NULL ||
           error_input(error, npz_path(file), "%shas no array '%s'; a trajectory needs position, angle, size and dt",
                       found == 0 ? "not a trajectory: " : "", missing);
}

static bool check_groups(const NpzFile *file, Error *error) {
    for (int i = 0; i < COUNT; i++)
        for (int k = 0; k < COUNT && arrays[i].group != ALONE; k++)
            if (arrays[i].group == arrays[k].group && npz_has(file, arrays[i].name) && !npz_has(file, arrays[k].name))
                return error_input(error, npz_path(file), "has '%s' but not '%s'; give both, or none of %s",
                                   arrays[i].name, arrays[k].name, group_words[arrays[i].group]);
    return true;
}

/* Other files of twinbox have a text that states their kind. */
static bool has_kind(const NpzFile *file) {
    Error ignored = {0};
    return npz_shape(file, "kind", NPZ_TEXT, 0, NULL, &ignored);
}

bool run_arrays_check(NpzFile *file, Error *error) {
    char kind[64];
    if (has_kind(file))
        return npz_read_name(file, "kind", kind, sizeof kind, error) &&
               error_input(error, npz_path(file), "not a trajectory but a file of kind '%s'", kind);
    /* A wrong name is the likely cause of a missing array, so it is told first. */
    return check_names(file, error) && check_needed(file, error) && check_groups(file, error);
}
