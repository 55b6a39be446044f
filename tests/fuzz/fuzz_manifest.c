/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What --resume takes from an earlier manifest.json and from its journal. */
#include "fuzz.h"

#include "base/file.h"
#include "pictures/render_internal.h"

#include <stdlib.h>
#include <string.h>

enum { FRAMES = 6, BODIES = 2 };

static RenderOptions options = {.width = 160, .height = 90, .last = -1, .jobs = 1, .slow = 1};
static Picture picture;
static MomentPlan plan;

/* A box that falls on the ground; made once, and kept. */
static void make_picture(const char *directory) {
    static const Trajectory *runs[1];
    Error error = {0};
    Trajectory *run = trajectory_create(FRAMES, BODIES, &error);
    if (run == NULL) fuzz_fail("%s", error.message);
    runs[0] = run;
    strcpy(run->scene, "fuzz");
    strcpy(run->method, "engine");
    run->dt = 0.25F;
    run->bomb = -1;
    run->fixed[0] = 1;
    run->size[0] = (Vec2){8, 2}, run->size[1] = (Vec2){1, 1};
    for (int i = 0; i < FRAMES * BODIES; i++) {
        run->position[i] = i % BODIES == 0 ? (Vec2){0, -1} : (Vec2){0, 4 - 0.5F * (float)(i / BODIES)};
        run->velocity[i] = (Vec2){0, i % BODIES == 0 ? 0 : -2};
        run->angle[i] = run->angular_velocity[i] = 0;
    }
    trajectory_end_contacts(run);
    options.directory = directory;
    if (!picture_plan(&picture, runs, 1, options.width, options.height, &error) ||
        !picture_apply_options(&picture, &options, &error) ||
        !moments_plan(&plan, runs, 1, 0, FRAMES - 1, &options, &error))
        fuzz_fail("%s", error.message);
}

/* The folder of fuzz_file(). */
static const char *directory_of(const char *path) {
    static char directory[512];
    const size_t length = file_folder_length(path) - 1;
    fuzz_text(directory, sizeof directory, (const uint8_t *)path, length);
    return directory;
}

/* The text, maybe behind the head that this sequence has. */
static void write_text(const char *name, bool with_head, const uint8_t *text, size_t size, const char *head) {
    const size_t length = with_head ? strlen(head) : 0;
    char *whole = malloc(length + size + 1);
    if (whole == NULL) fuzz_fail("out of memory");
    memcpy(whole, head, length);
    if (size > 0) memcpy(whole + length, text, size);
    fuzz_file(name, whole, length + size);
    free(whole);
}

/* A picture is known if and only if a line of the texts is the one that its hashes give. */
static void check_known(const Manifest *manifest, const uint8_t *data, size_t size) {
    char *texts = malloc(size + 1);
    if (texts == NULL) fuzz_fail("out of memory");
    for (size_t i = 0; i < size; i++) texts[i] = (char)(data[i] == 0 ? '\n' : data[i]);
    texts[size] = '\0';
    for (int i = 0; i < FRAMES; i++) {
        size_t length;
        if (!manifest->known[i]) continue;
        char *line = file_print(manifest_print_line, &(ManifestLine){manifest, i, manifest->hashes[i]}, &length);
        if (line == NULL) fuzz_fail("out of memory");
        line[length - 1] = '\0';
        if (strstr(texts, line) == NULL) fuzz_fail("picture %d is known from no line", i);
        free(line);
    }
    free(texts);
}

/* Options: bit 0 and 1, whether the head stands before manifest.json and before its journal. Then both texts, separated
   by a NUL. */
void fuzz_manifest(const uint8_t *data, size_t size) {
    Manifest manifest;
    Error error = {0};
    char why[512] = "";
    if (size == 0) return;
    if (plan.last == 0) make_picture(directory_of(fuzz_file("manifest.json", "", 0)));
    const uint8_t *text = data + 1, *end = memchr(text, '\0', size - 1);
    const size_t length = end == NULL ? size - 1 : (size_t)(end - text), rest = end == NULL ? 0 : size - length - 2;
    if (!manifest_open(&manifest, &picture, &options, &plan, 0, FRAMES - 1, &error)) fuzz_fail("%s", error.message);
    write_text("manifest.json", (data[0] & 1) != 0, text, length, manifest.head);
    write_text("manifest.json.part", (data[0] & 2) != 0, text + size - 1 - rest, rest, manifest.head);
    fuzz_begin();
    manifest_recall(&manifest, why, sizeof why);
    fuzz_end(true, &(Error){0}, "");
    if (!manifest.valid && (data[0] & 2) == 0 && why[0] == '\0') fuzz_fail("no reason");
    check_known(&manifest, data + 1, size - 1);
    manifest_close(&manifest);
}
