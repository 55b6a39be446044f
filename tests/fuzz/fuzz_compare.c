/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a comparison and approve read: results.json, the view in manifest.json, rules with masks. */
#include "fuzz.h"

#include "fuzz_png.h"
#include "regression/approve.h"
#include "regression/limits.h"
#include "regression/view.h"

#include <stdlib.h>
#include <string.h>

/* approve writes files of these names. */
static void check_name(const ApprovalFile *file) {
    const char *name = file->name;
    if (name == NULL) return;
    const size_t length = strlen(name);
    if (name[0] == '/' || name[0] == '.' || strstr(name, "/.") != NULL || strstr(name, "//") != NULL || length < 5 ||
        (strcmp(name + length - 4, ".png") != 0 && strcmp(name + length - 4, ".npz") != 0))
        fuzz_fail("approve accepts the name '%s'", name);
}

void fuzz_results(const uint8_t *data, size_t size) {
    ApprovalList list;
    Error error = {0};
    const char *path = fuzz_file("results.json", data, size);
    const bool ok = FUZZ_READ(approval_read(&list, path, &error), path);
    if (!ok) return;
    for (size_t i = 0; i < list.count; i++) {
        const ApprovalItem *item = &list.items[i];
        if (!item->failed || (item->expected.name == NULL && item->actual.name == NULL))
            fuzz_fail("item %zu is no failure", i);
        check_name(&item->expected);
        check_name(&item->actual);
    }
    approval_free(&list);
}

void fuzz_view(const uint8_t *data, size_t size) {
    FrameView view;
    Error error = {0};
    const char *path = fuzz_file("manifest.json", data, size);
    const bool ok = FUZZ_READ(view_read(&view, path, &error), path);
    if (!ok && (view.width != 0 || view.panel_count != 0)) fuzz_fail("a view that was refused is not empty");
    for (int i = 0; i < view.panel_count; i++) {
        const ViewPanel *panel = &view.panels[i];
        if (!(panel->scale > 0) || panel->rect.left < 0 || panel->rect.right > view.width || panel->rect.top < 0 ||
            panel->rect.bottom > view.height || strchr(panel->run, '/') != NULL)
            fuzz_fail("panel %d is not in the picture", i + 1);
    }
    if (view_difference(&view, &view).text[0] != '\0') fuzz_fail("a view differs from itself");
}

/* Masks hide no more than the rules say. */
static void check_masks(const Rules *rules, const char *name, const Image *picture) {
    uint8_t masked[64] = {0};
    const size_t pixels = (size_t)picture->width * (size_t)picture->height;
    double hidden = 0;
    Error error = {0};
    Tolerance tolerance = {0};
    rules_override(rules, name, &tolerance);
    const bool ok = rules_draw_masks(rules, name, picture, "picture.png", masked, &error);
    if (!ok && error.kind != ERROR_INPUT) fuzz_fail("%s", error.message);
    for (size_t i = 0; i < pixels; i++) hidden += masked[i] != IGNORED_NOT;
    const double most = rules_most_hidden(rules, name, picture->width, picture->height);
    if (ok && hidden > 0 && !rules_have_masks(rules, name)) fuzz_fail("masks of no rule");
    if (ok && hidden / (double)pixels > most + 1e-9)
        fuzz_fail("%g of %zu pixels are hidden, and at most %g can be", hidden, pixels, most);
}

/* Rules, then behind a NUL the PNG file mask.png. */
void fuzz_rules(const uint8_t *data, size_t size) {
    static const char *const names[] = {"a.png", "stack_000001.png"};
    static uint8_t mask[1 << 10], pixels[8 * 8 * 4]; /* deflated pixels take 32 KiB for each byte, as RGBA */
    const Image picture = {.width = 8, .height = 8, .pixels = pixels};
    const uint8_t *end = memchr(data, '\0', size);
    const size_t length = end == NULL ? size : (size_t)(end - data), rest = end == NULL ? 0 : size - length - 1;
    if (rest > sizeof mask) return;
    if (rest > 0) memcpy(mask, end + 1, rest);
    png_repair(mask, rest);
    fuzz_file("mask.png", mask, rest);
    const char *path = fuzz_file("compare.yaml", data, length);
    Error error = {0};
    Rules *rules = FUZZ_READ(rules_read(path, &error), path);
    if (rules != NULL) {
        for (int i = 0; i < 2; i++) check_masks(rules, names[i], &picture);
        rules_check_names(rules, names, 2, &error);
        if (error.kind == ERROR_SYSTEM) fuzz_fail("%s", error.message);
    }
    rules_destroy(rules);
}
