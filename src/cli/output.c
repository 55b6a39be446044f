/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Results as JSON, the pages of a study, and the installed scenes. */
#include "base/base.h"
#include "base/file.h"
#include "base/json.h"
#include "base/machine.h"
#include "cli/cli.h"
#include "pictures/player.h"
#include "runs/pieces.h"
#include "runs/trajectory.h"
#include "studies/piece_tables.h"

#include <inttypes.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct Output {
    const char *format;
    JsonOutputWrite *write;
    const void *context;
} Output;

static void print(FILE *out, const void *context) {
    const Output *output = context;
    JsonWriter json = {.out = out};
    json_begin_object(&json, NULL, JSON_LINES);
    json_put_text(&json, "format", output->format);
    output->write(&json, output->context);
    json_end(&json);
}

bool json_output_check(bool json, Error *error) {
    return !json || !standard_output_is_reserved() ||
           error_input(error, "--json", "cannot be combined with a file written to standard output");
}

/* Through memory, because JsonWriter needs the C locale. */
bool json_output(const char *format, JsonOutputWrite *write, const void *context, Error *error) {
    const Output output = {format, write, context};
    size_t size;
    char *text = file_print(print, &output, &size);
    if (text == NULL) return error_memory(error, "--json");
    fwrite(text, 1, size, stdout); /* main() checks standard output */
    free(text);
    return true;
}

void json_output_pair(JsonWriter *json, const char *key, double x, double y) {
    json_begin_array(json, key, JSON_ONE_LINE);
    json_put_number(json, NULL, x);
    json_put_number(json, NULL, y);
    json_end(json);
}

/* The last two fields of a row, without a moment: "pages/NAME.html" and BYTES. */
static char *page_of(char *row, int64_t *bytes) {
    char *comma = strrchr(row, ',');
    *bytes = atoll(comma + 1);
    *comma = '\0';
    char *page = strrchr(row, ',') + 1;
    page[strcspn(page, "#")] = '\0';
    return page;
}

static void count_row(PageSet *set, char *row) {
    int64_t bytes;
    const char *page = page_of(row, &bytes);
    if (page[0] == '\0') {
        set->left_out++;
        return;
    }
    if (strcmp(page, set->last) == 0) return;
    snprintf(set->last, sizeof set->last, "%s", page);
    set->pages++;
    set->bytes += bytes;
}

/* The pages of the parts before this one, whichever run wrote them. */
static bool count_parts(PageSet *set, int64_t part, Error *error) {
    for (; set->counted < part; set->counted++) {
        size_t size;
        char *rows = pieces_read(&set->pieces, set->counted, &size, NULL, error), *rest = rows;
        if (rows == NULL) return false;
        for (char *row; (row = strtok_r(rest, "\n", &rest)) != NULL;) count_row(set, row);
        free(rows);
    }
    return true;
}

static void describe(void *context, int64_t part, PieceInfo *info) {
    (void)context;
    snprintf(info->name, sizeof info->name, "pages %" PRId64, part + 1);
    info->weight = 1;
    info->alone = true; /* whether there is room for a page depends on those before */
}

static bool work(void *context, int64_t part, FILE *rows, const Progress *progress, Error *error) {
    PageSet *set = context;
    return count_parts(set, part, error) && set->write(set->context, (int)part, rows, progress, error);
}

/* The study's own pieces are in another folder, and shards have no pages. */
static bool open_parts(PageSet *set, uint64_t key, Error *error) {
    Pieces *pieces = &set->pieces;
    *pieces = (Pieces){.shard = {1, 1}, .key = key ^ UINT64_C(0x7061676573)};
    set->plan = (PiecePlan){.count = set->parts, .describe = describe, .work = work, .context = set};
    return file_path(pieces->folder, sizeof pieces->folder, error, "%s/parts-%016" PRIx64, set->folder, pieces->key);
}

bool page_set_make(PageSet *set, uint64_t key, const Progress *progress, Error *error) {
    char pages[PATH_MAX];
    return file_path(pages, sizeof pages, error, "%s/pages", set->folder) && file_make_directory(pages, error) &&
           open_parts(set, key, error) && pieces_do(&set->pieces, &set->plan, progress, error) &&
           count_parts(set, set->parts, error) &&
           piece_tables_write(&set->pieces, set->folder, &set->layout, 1, NULL, 0, error);
}

bool page_set_end(const PageSet *set, Error *error) { return pieces_end(&set->pieces, error); }

static int frames_of(const Trajectory *const *runs, int count, const PlayerOptions *options) {
    int most = 0;
    for (int i = 0; i < count; i++) most = runs[i]->frames > most ? runs[i]->frames : most;
    return (options->last < 0 || options->last >= most ? most : options->last + 1) - options->first;
}

/* A page of all frames if its states fit, else of every n-th. */
static int every_that_fits(const Trajectory *const *runs, int count, const PlayerOptions *options) {
    double bytes = 0;
    for (int i = 0; i < count; i++) bytes += 6.0 * sizeof(float) * runs[i]->bodies;
    bytes *= frames_of(runs, count, options);
    return 1 + (int)(bytes / PAGE_SET_STATE_BYTES);
}

bool page_set_write(const PageSet *set, const char *name, const Trajectory *const *runs, int count,
                    const PlayerOptions *options, PageFile *file, Error *error) {
    char path[PATH_MAX], plain[PAGE_NAME_SIZE - sizeof "pages/.html"];
    PlayerResult result;
    *file = (PageFile){0};
    if (set->bytes >= PAGE_SET_MAX_BYTES) return true;
    PlayerOptions fitting = *options;
    fitting.every = every_that_fits(runs, count, options);
    snprintf(plain, sizeof plain, "%s", name);
    file_name_clean(plain);
    if (!file_path(path, sizeof path, error, "%s/pages/%s.html", set->folder, plain) ||
        !player_write(runs, count, &fitting, path, &result, error))
        return false;
    snprintf(file->path, sizeof file->path, "pages/%s.html", plain);
    file->bytes = (int)result.bytes;
    return true;
}

void page_set_link(char link[PAGE_LINK_SIZE], const PageFile *file, double time, int body, int run) {
    char moment[PLAYER_LINK_SIZE];
    link[0] = '\0';
    if (file->path[0] == '\0') return;
    player_link(moment, time, body);
    snprintf(link, PAGE_LINK_SIZE, "%s%s", file->path, moment);
    if (body >= 0 && run > 0) text_add(link, PAGE_LINK_SIZE, "&run=%d", run);
}

void page_set_print(const PageSet *set, const char *html) {
    printf("%d page%s of %.3g MB together -> %s/pages; links to them -> %s/%s\n", set->pages, plural(set->pages),
           (double)set->bytes / 1e6, set->folder, set->folder, html);
    if (set->left_out > 0)
        printf("    without a page, as pages take at most %d MB: %d\n", PAGE_SET_MAX_BYTES >> 20, set->left_out);
}

enum { PATH_SIZE = 4096 };

/* What was found; a list, because callers keep the paths. */
typedef struct Found {
    struct Found *next;
    char path[PATH_SIZE];
} Found;

static Found *all_found;

/* The path below TWINBOX_DATA, which is relative to the program's folder: an installed prefix can be moved. */
static bool find(char found[PATH_SIZE], const char *path) {
    char program[PATH_SIZE];
    ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    if (length < 0) return false;
    program[length] = '\0';
    Error ignored = {0};
    return file_path(found, PATH_SIZE, &ignored, "%.*s%s/%s", (int)file_folder_length(program), program, TWINBOX_DATA,
                     path) &&
           access(found, R_OK) == 0;
}

/* Where a scene is looked for by its name. */
static const char *const scene_folders[] = {"scenes", "scenes/families", "scenes/stability"};
enum { SCENE_FOLDERS = sizeof scene_folders / sizeof *scene_folders };

static bool find_scene(char found[PATH_SIZE], const char *name) {
    if (strpbrk(name, "./") != NULL) return false;
    for (int i = 0; i < SCENE_FOLDERS; i++) {
        char path[PATH_SIZE];
        Error ignored = {0};
        if (!file_path(path, sizeof path, &ignored, "%s/%s.yaml", scene_folders[i], name)) return false;
        if (access(path, R_OK) == 0) return memcpy(found, path, sizeof path), true;
        if (find(found, path)) return true;
    }
    return false;
}

const char *installed_path(const char *path) {
    if (path[0] == '/' || access(path, F_OK) == 0) return path;
    Found *found = malloc(sizeof *found);
    if (found == NULL || !(find(found->path, path) || find_scene(found->path, path))) {
        free(found);
        return path;
    }
    found->next = all_found;
    all_found = found;
    return found->path;
}

const char *installed_network(const char *method) {
    static const char key[] = "network=";
    const char *value = strstr(method, key);
    if (value == NULL || (value > method && value[-1] != ':' && value[-1] != ',')) return method;
    char path[PATH_SIZE];
    value += strlen(key);
    const int length = (int)strcspn(value, ",");
    Error ignored = {0};
    if (!file_path(path, sizeof path, &ignored, "%.*s", length, value)) return method;
    const char *found = installed_path(path);
    Found *text = found != path ? malloc(sizeof *text) : NULL;
    if (text == NULL || !file_path(text->path, sizeof text->path, &ignored, "%.*s%s%s", (int)(value - method), method,
                                   found, value + length)) {
        free(text);
        return method;
    }
    text->next = all_found;
    all_found = text;
    return text->path;
}

static bool is_scene(const char *name) {
    const char *ending = strrchr(name, '.');
    return ending != NULL && strcmp(ending, ".yaml") == 0;
}

/* `shown`: the folder as in paths; NULL: names alone. */
static void list_scenes(const char *folder, const char *shown, InstalledScene *found, void *context) {
    FolderList list;
    Error ignored = {0};
    if (!folder_list(&list, folder, is_scene, false, &ignored)) return;
    for (size_t i = 0; i < list.count; i++) {
        char path[PATH_SIZE];
        const int length = (int)(strlen(list.names[i]) - strlen(".yaml"));
        const bool fits = shown != NULL ? file_path(path, sizeof path, &ignored, "%s/%s", shown, list.names[i])
                                        : file_path(path, sizeof path, &ignored, "%.*s", length, list.names[i]);
        if (fits && (shown == NULL || access(path, F_OK) != 0)) found(path, context);
    }
    folder_list_free(&list);
}

void installed_scenes(InstalledScene *found, void *context) {
    for (int i = 0; i < SCENE_FOLDERS; i++) {
        char folder[PATH_SIZE];
        list_scenes(scene_folders[i], NULL, found, context);
        if (!find(folder, scene_folders[i])) continue;
        list_scenes(folder, NULL, found, context);
        list_scenes(folder, scene_folders[i], found, context);
    }
}

bool output_check_folder_name(const char *path, Error *error) {
    static const char *const endings[] = {".png", ".svg",  ".pdf", ".html", ".csv",  ".json",
                                          ".npz", ".yaml", ".md",  ".mp4",  ".webm", ".gif"};
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++)
        if (file_name_ends_with(path, endings[i]))
            return error_input(error, path, "is the name of a file; expected that of a folder, such as %.*s",
                               (int)(strlen(path) - strlen(endings[i])), path);
    return true;
}
