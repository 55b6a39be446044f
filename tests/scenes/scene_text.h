/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scene files made up by a test. */
#pragma once
#include "testing.h"

#include "scenes/scenes.h"

/* The first four lines of a scene, and a ground: bodies begin in line 5, their list in line 6. */
#define BASE "gravity: [0, -10]\ndt: 1/60\niterations: 10\nframes: 300\n"
#define GROUND "bodies:\n  - {static: true, size: [100, 20], position: [0, -10]}\n"
/* What a message about an unknown key lists. */
#define SCENE_KEYS                                                                                                 \
    "gravity, dt, iterations, warm_starting, accumulate_impulses, position_correction, frames, overlaps, camera, " \
    "bodies, "                                                                                                     \
    "bomb, networks, parameters"
/* A single body is a line of its own: line 6. */
#define BODY(keys) BASE "bodies:\n  - {" keys "}\n"

static inline const char *write_scene(const void *text, size_t size) {
    return write_bytes(temporary_path("scene.yaml"), text, size);
}

/* The error's message begins with the path returned. */
static inline Scene *read_bytes(const void *text, size_t size, Error *error) {
    *error = (Error){.kind = ERROR_NONE};
    return scene_read(write_scene(text, size), error);
}

static inline Scene *read_text(const char *text, Error *error) { return read_bytes(text, strlen(text), error); }

/* A scene that must be in order. */
static inline Scene *good_scene(const char *text) {
    Error error;
    Scene *scene = read_text(text, &error);
    assert_ok(scene != NULL, error);
    return scene;
}

/* The part of an error behind "path:". */
static inline const char *behind_path(const Error *error) {
    const char *path = temporary_path("scene.yaml");
    if (strncmp(error->message, path, strlen(path)) != 0 || error->message[strlen(path)] != ':')
        fail_msg("no path in: %s", error->message);
    return error->message + strlen(path) + 1;
}

/* Fails unless the text is refused with exactly this message behind "path:", as far as `expected` goes (a
   line or more of it). */
static inline void expect_refused_bytes(const void *text, size_t size, const char *expected) {
    Error error;
    Scene *scene = read_bytes(text, size, &error);
    if (scene != NULL) fail_msg("not refused, but expected: %s", expected);
    assert_int_equal(error.kind, ERROR_INPUT);
    size_t length = strlen(expected);
    const char *found = behind_path(&error);
    bool same = strncmp(found, expected, length) == 0 && (found[length] == '\n' || found[length] == '\0');
    if (!same) fail_msg("\nfound    %s\nexpected %s", found, expected);
}

static inline void expect_refused(const char *text, const char *expected) {
    expect_refused_bytes(text, strlen(text), expected);
}

/* A text, and why it is refused; NULL: it is not. */
typedef struct Refused {
    const char *text, *message; /* behind "path:", up to the excerpt */
} Refused;

static inline void check_table(const Refused *table, size_t count) {
    for (size_t i = 0; i < count; i++) {
        if (table[i].message != NULL)
            expect_refused(table[i].text, table[i].message);
        else
            scene_destroy(good_scene(table[i].text));
    }
}

#define CHECK_TABLE(table) check_table((table), sizeof(table) / sizeof *(table))
