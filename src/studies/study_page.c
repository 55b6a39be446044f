/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Live pages of studies, and links into them. */
#include "studies/study_page.h"

#include "base/file.h"
#include "live/live.h"
#include "methods/methods.h"
#include "pictures/page.h"
#include "pictures/player.h"
#include "runs/runs.h"
#include "runs/trajectory.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

enum { SHOWN = 2 };

static const char *const shown[SHOWN] = {"engine", "interior"};

/* The module, and the scene with all networks that links need. */
static bool pack(PlayerLive *live, const char *path, const Scene *scene, const ContenderList *methods, Error *error) {
    enum { TEXT = CHART_NAME_SIZE + CHART_SETTING_SIZE + 1 };
    const size_t most = (size_t)methods->count + 1;
    char(*texts)[TEXT] = malloc(most * sizeof *texts);
    const char **packed = malloc(most * sizeof *packed);
    void *bundle = NULL;
    bool networks = false;
    int count = 0;
    bool ok = (texts != NULL && packed != NULL) || error_memory(error, path);
    for (int i = 0; ok && i < methods->count; i++) {
        const Contender *contender = &methods->items[i];
        const MethodDescription *description = contender->method.kind->description;
        if (!description->needs_network || !live_has_method(description) ||
            method_lacks_network(&contender->method, scene))
            continue;
        snprintf(texts[count], TEXT, "%s%s%s", contender->name, contender->setting[0] != '\0' ? ":" : "",
                 contender->setting);
        packed[count] = texts[count];
        count++;
        networks = true;
    }
    live->module = live_module(networks);
    ok = ok && live_pack(path, packed, count, &bundle, &live->bundle_size, error);
    live->bundle = bundle;
    free(packed);
    free(texts);
    return ok;
}

bool study_page_write(StudyPage *page, const char *scene_path, const ContenderList *methods, const char *folder,
                      Error *error) {
    char path[PATH_MAX];
    Trajectory *runs[SHOWN] = {0};
    PlayerLive live = {0};
    PlayerResult result;
    *page = (StudyPage){0};
    if (live_module(false).size == 0) return true;
    Scene *scene = scene_read(scene_path, error);
    bool ok = scene != NULL, whole = true;
    PlayerOptions options = {.last = -1, .live = &live, .describe = method_describe};
    for (int i = 0; ok && whole && i < SHOWN; i++) {
        Method method;
        Error failure = {0};
        ok = method_parse(&method, shown[i], error);
        runs[i] = ok ? simulate(scene, &method, NULL, &failure) : NULL;
        whole = runs[i] != NULL;
        if (!whole && failure.failure == FAILURE_NONE) ok = false, *error = failure;
        if (whole) live.methods[i] = runs[i]->method;
        options.scenes[i] = scene_path + file_folder_length(scene_path); /* folders differ between machines */
    }
    if (ok && whole) {
        snprintf(page->file, sizeof page->file, "live-%s.html", scene->name);
        ok = file_path(path, sizeof path, error, "%s/%s", folder, page->file) &&
             pack(&live, scene_path, scene, methods, error) &&
             player_write((const Trajectory *const *)runs, SHOWN, &options, path, &result, error);
    }
    free((void *)live.bundle);
    for (int i = 0; i < SHOWN; i++) trajectory_destroy(runs[i]);
    scene_destroy(scene);
    return ok;
}

void study_link_put(FILE *out, const StudyPage *page, const char *set, const char *method, const char *setting,
                    const char *text) {
    const MethodDescription *description = method_describe(method);
    const bool linked = page->file[0] != '\0' && description != NULL && live_has_method(description);
    if (linked) {
        fputs("<a href=\"", out);
        html_put_address(out, page->file);
        fputs("#set=", out);
        html_put_address(out, set);
        fputs("&amp;methods=", out);
        html_put_address(out, method);
        if (setting[0] != '\0') fputs("%3A", out);
        html_put_address(out, setting);
        fprintf(out, ";%s\">", strcmp(method, shown[1]) == 0 ? shown[0] : shown[1]);
    }
    html_put(out, text);
    if (linked) fputs("</a>", out);
}

typedef struct Text {
    TextWrite *write;
    void *context;
    bool whole;
    Error *error;
} Text;

static void print_text(FILE *out, const void *context) {
    Text *text = (Text *)context;
    text->whole = text->write(text->context, out, text->error);
}

bool text_write(const char *path, TextWrite *write, void *context, Error *error) {
    size_t size;
    Text printed = {write, context, true, error};
    char *text = file_print(print_text, &printed, &size);
    if (text == NULL && printed.whole) error_memory(error, path);
    const bool written = text != NULL && printed.whole && file_write(path, text, size, error);
    free(text);
    return written;
}
