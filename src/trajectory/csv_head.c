/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "trajectory/csv_head.h"

#include "common/array.h"
#include "common/nearest.h"
#include "common/parse.h"
#include "csv/csv_table.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum { LINE_SIZE = 256, NUMBERS_MAX = 4, BODIES_MAX = 1000000 };
/* m */
#define SIZE_LEAST 1e-6
#define SIZE_MOST 1e6

typedef struct SizeRow {
    int body, fixed;
    float width, height;
} SizeRow;

static const CsvColumn size_columns[] = {
    {"body", CSV_INTEGER, .offset = offsetof(SizeRow, body), .maximum = INT32_MAX - 1, .key = true},
    {"width", CSV_FLOAT, .offset = offsetof(SizeRow, width), .minimum = SIZE_LEAST, .maximum = SIZE_MOST},
    {"height", CSV_FLOAT, .offset = offsetof(SizeRow, height), .minimum = SIZE_LEAST, .maximum = SIZE_MOST},
    {"static", CSV_INTEGER, .offset = offsetof(SizeRow, fixed), .maximum = 1},
};
static const CsvLayout size_layout =
    CSV_LAYOUT("sizes", size_columns, SizeRow, .min_rows = 1, .max_rows = BODIES_MAX, .header = CSV_SUBSET);

static bool is_size(float side) { return (double)side >= SIZE_LEAST && (double)side <= SIZE_MOST; }

static bool add_body(CsvHead *head, const char *path, CsvBody body, Error *error) {
    void *bodies = head->bodies;
    if (!array_reserve(&bodies, &head->capacity, head->count + 1, sizeof *head->bodies))
        return error_memory(error, path);
    head->bodies = bodies;
    head->bodies[head->count++] = body;
    return true;
}

static bool read_sizes(CsvHead *head, const char *path, Error *error) {
    CsvTable table;
    if (!csv_table_read(&table, path, &size_layout, error)) return false;
    bool ok = true;
    for (int i = 0; ok && i < 3; i++)
        if (table.fields[i] < 0)
            ok = csv_error(&table.csv, 0, 0, error, "the column '%s' is missing; expected body,width,height",
                           size_columns[i].name);
    head->states_static = ok && table.fields[3] >= 0;
    for (int i = 0; ok && i < table.count; i++) {
        const SizeRow *row = (const SizeRow *)table.rows + i;
        ok = add_body(head, path, (CsvBody){row->body, vec2(row->width, row->height), row->fixed != 0}, error);
    }
    csv_table_free(&table);
    return ok;
}

/* "1,2.5": `least` to `most` numbers; returns how many, 0 if the text is something else. */
static int take_numbers(char *text, int least, int most, float numbers[NUMBERS_MAX]) {
    int count = 0;
    for (char *next = text; next != NULL && count < most; count++) {
        char *field = next + strspn(next, " "), *comma = strchr(field, ',');
        next = comma != NULL ? comma + 1 : NULL;
        if (comma != NULL) *comma = '\0';
        if (!parse_float(field, &numbers[count])) return 0;
        if (next == NULL) return count + 1 >= least ? count + 1 : 0;
    }
    return 0;
}

/* Cuts the last field off if it is "static" or "dynamic". */
static void take_kind(CsvHead *head, char *text, CsvBody *body) {
    char *last = strrchr(text, ',');
    const char *word = last != NULL ? last + 1 + strspn(last + 1, " ") : "";
    body->fixed = strcmp(word, "static") == 0;
    if (!body->fixed && strcmp(word, "dynamic") != 0) return;
    head->states_static = true;
    *last = '\0';
}

/* "0,100,20" or "0,100,20,static" */
static bool take_size(CsvHead *head, const char *path, char *text, Error *error, bool *right) {
    CsvBody body = {0};
    float size[NUMBERS_MAX] = {0};
    take_kind(head, text, &body);
    char *comma = strchr(text, ',');
    *right = comma != NULL;
    if (comma == NULL) return true;
    *comma = '\0';
    *right = parse_int(text, 0, INT32_MAX - 1, &body.number) && take_numbers(comma + 1, 2, 2, size) == 2 &&
             is_size(size[0]) && is_size(size[1]);
    body.size = vec2(size[0], size[1]);
    return !*right || add_body(head, path, body, error);
}

static bool take_name(char name[TRAJECTORY_NAME_SIZE], const char *text) {
    for (const char *c = text; *c != '\0'; c++)
        if ((unsigned char)*c < 0x20 || *c == 0x7f) return false;
    return snprintf(name, TRAJECTORY_NAME_SIZE, "%s", text) < TRAJECTORY_NAME_SIZE;
}

static bool take_hash(const char *text, uint64_t *hash) {
    char *end;
    *hash = strtoull(text, &end, 16);
    return strlen(text) == 16 && strspn(text, "0123456789abcdef") == 16 && *end == '\0';
}

static bool take_camera(CsvHead *head, char *text) {
    float numbers[NUMBERS_MAX];
    if (take_numbers(text, 4, 4, numbers) != 4) return false;
    head->camera[0] = vec2(numbers[0], numbers[1]);
    head->camera[1] = vec2(numbers[2], numbers[3]);
    return true;
}

/* What a key states; in the order of the keys. */
enum { KEY_SCENE, KEY_METHOD, KEY_SCENE_HASH, KEY_ITERATIONS, KEY_DT, KEY_BOMB, KEY_CAMERA, KEY_SIZE, KEYS };
static const struct {
    const char *name, *form;
} keys[KEYS] = {
    {"scene", "a name of at most 127 bytes"},
    {"method", "a name of at most 127 bytes"},
    {"scene_hash", "16 hexadecimal digits"},
    {"iterations", "a whole number from 1"},
    {"dt", "a time in seconds such as 0.01 or 1/60"},
    {"bomb", "the number of a body"},
    {"camera", "X,Y,WIDTH,HEIGHT"},
    {"size", "BODY,WIDTH,HEIGHT from 1e-06 to 1e+06 m, perhaps with static or dynamic"},
};

static bool take_value(CsvHead *head, const char *path, int key, char *text, Error *error, bool *right) {
    switch (key) {
    case KEY_SCENE: *right = take_name(head->scene, text); break;
    case KEY_METHOD: *right = take_name(head->method, text); break;
    case KEY_SCENE_HASH: *right = take_hash(text, &head->scene_hash); break;
    case KEY_ITERATIONS: *right = parse_int(text, 1, INT32_MAX, &head->iterations); break;
    case KEY_DT: *right = parse_float(text, &head->dt) && head->dt > 0; break;
    case KEY_BOMB: *right = parse_int(text, 0, INT32_MAX - 1, &head->bomb); break;
    case KEY_CAMERA: *right = take_camera(head, text); break;
    default: return take_size(head, path, text, error, right);
    }
    return true;
}

static bool fail(const char *path, int line, Error *error, const char *format, const char *first, const char *second)
    __attribute__((format(printf, 4, 0)));

static bool fail(const char *path, int line, Error *error, const char *format, const char *first, const char *second) {
    char where[1280], what[256];
    snprintf(where, sizeof where, "%.1200s:%d", path, line);
    snprintf(what, sizeof what, format, first, second);
    return error_input(error, where, "%s", what);
}

/* "key: value"; comments of another form mean nothing. */
static bool take_comment(CsvHead *head, const char *path, int line, char *text, Error *error) {
    const char *known[KEYS];
    char *colon = strchr(text, ':');
    if (colon == NULL || strcspn(text, " \t") < (size_t)(colon - text)) return true;
    *colon = '\0';
    char *value = colon + 1 + strspn(colon + 1, " \t");
    for (int key = 0; key < KEYS; key++) {
        bool right = true;
        known[key] = keys[key].name;
        if (strcmp(text, keys[key].name) != 0) continue;
        if (!take_value(head, path, key, value, error, &right)) return false;
        return right || fail(path, line, error, "%s: expected %s", keys[key].name, keys[key].form);
    }
    const char *near = nearest_word(text, known, KEYS);
    return near == NULL || fail(path, line, error, "'# %s:': did you mean '# %s:'?", csv_show(text).text, near);
}

static int compare_bodies(const void *left, const void *right) {
    const CsvBody *a = left, *b = right;
    return (a->number > b->number) - (a->number < b->number);
}

static bool sort_bodies(CsvHead *head, const char *path, Error *error) {
    if (head->count > 0) qsort(head->bodies, head->count, sizeof *head->bodies, compare_bodies);
    for (size_t i = 1; i < head->count; i++)
        if (head->bodies[i].number == head->bodies[i - 1].number)
            return error_input(error, path, "body %" PRId64 " has two sizes", head->bodies[i].number);
    return head->count > 0 ||
           error_input(error, path,
                       "the sizes of the bodies are missing: give --sizes FILE.csv with body,width,height, or "
                       "lines '# size: BODY,WIDTH,HEIGHT' above the header");
}

bool csv_head_read(CsvHead *head, const char *path, const char **text, int *line, const char *sizes, Error *error) {
    *head = (CsvHead){.bomb = -1};
    if (strncmp(*text, "\xef\xbb\xbf", 3) == 0) *text += 3;
    for (*line = 1; **text == '#'; ++*line) {
        char comment[LINE_SIZE];
        const char *begin = *text + 1 + strspn(*text + 1, " \t");
        size_t length = strcspn(begin, "\n"), used = length;
        *text = begin + length + (begin[length] == '\n');
        while (used > 0 && strchr(" \t\r", begin[used - 1]) != NULL) used--;
        if (used >= LINE_SIZE) return fail(path, *line, error, "a comment longer than 255 bytes%s%s", "", "");
        memcpy(comment, begin, used);
        comment[used] = '\0';
        if (!take_comment(head, path, *line, comment, error)) return false;
    }
    if (sizes != NULL && head->count > 0)
        return error_input(error, sizes, "the comments of %s have sizes, too; give only one of the two", path);
    return (sizes == NULL || read_sizes(head, sizes, error)) && sort_bodies(head, path, error);
}

int csv_head_body(const CsvHead *head, int64_t number) {
    const CsvBody key = {.number = number};
    const CsvBody *found = bsearch(&key, head->bodies, head->count, sizeof *head->bodies, compare_bodies);
    return found != NULL ? (int)(found - head->bodies) : -1;
}
