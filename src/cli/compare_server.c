/* SPDX-License-Identifier: GPL-3.0-or-later */
/* twinbox compare --server: the protocol of `odiff --server` (odiff-bin 4.5), so that its clients work unchanged. A
   request is a line of JSON; with "type": "buffer", the bytes of both files follow it. Each request gets a line, in
   their order. */
#include "base/base.h"
#include "base/file.h"
#include "base/json.h"
#include "cli/larger_commands.h"
#include "pixels/png.h"
#include "regression/odiff.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { REQUEST_SIZE = 1 << 19, FILE_SIZE = 100 << 20 /* bytes, as in odiff */, REGIONS_MAX = 4096 };

static const char name[] = "request";

typedef struct Request {
    bool has_id;
    int64_t id;
    bool lost; /* how many bytes follow it is not known */
    const char *paths[2], *output;
    uint8_t *data[2];
    size_t sizes[2];
    bool same_layout, rows, columns; /* failOnLayoutDiff, captureDiffLines, captureDiffCols */
    OdiffOptions compared;
    OdiffPicture picture;
    OdiffRegion regions[REGIONS_MAX];
} Request;

typedef enum AnswerKind { ANSWER_READY, ANSWER_ERROR, ANSWER_MATCH, ANSWER_LAYOUT, ANSWER_PIXELS } AnswerKind;

typedef struct Answer {
    AnswerKind kind;
    const Request *request;
    OdiffDifference difference;
    const Error *error;
} Answer;

/* The indices of the flags that are set. */
static void put_indices(JsonWriter *json, const char *key, const bool *flags, int count) {
    json_begin_array(json, key, JSON_ONE_LINE);
    for (int i = 0; i < count; i++)
        if (flags[i]) json_put_int(json, NULL, i);
    json_end(json);
}

static void put_difference(JsonWriter *json, const Answer *answer) {
    const OdiffDifference *found = &answer->difference;
    const double percent = 100.0 * (double)found->count / ((double)found->width * found->height);
    json_put_text(json, "reason", "pixel-diff");
    json_put_int(json, "diffCount", found->count);
    json_put_number(json, "diffPercentage", round(100 * percent) / 100);
    if (answer->request->rows) put_indices(json, "diffLines", found->rows, found->height);
    if (answer->request->columns) put_indices(json, "diffCols", found->columns, found->width);
}

static void print_answer(FILE *out, const void *context) {
    const Answer *answer = context;
    JsonWriter json = {.out = out};
    json_begin_object(&json, NULL, JSON_ONE_LINE);
    if (answer->request->has_id) json_put_int(&json, "requestId", answer->request->id);
    if (answer->kind == ANSWER_READY) json_put_bool(&json, "ready", true);
    if (answer->kind == ANSWER_ERROR) json_put_text(&json, "error", answer->error->message);
    if (answer->kind >= ANSWER_MATCH) json_put_bool(&json, "match", answer->kind == ANSWER_MATCH);
    if (answer->kind == ANSWER_LAYOUT) json_put_text(&json, "reason", "layout-diff");
    if (answer->kind == ANSWER_PIXELS) put_difference(&json, answer);
    json_end(&json);
}

/* False with error set if nobody can read it. */
static bool compare_server_send(const Answer *answer, Error *error) {
    size_t size;
    char *text = file_print(print_answer, answer, &size);
    if (text == NULL) return error_memory(error, name);
    const bool sent = fwrite(text, 1, size, stdout) == size && fflush(stdout) == 0;
    free(text);
    return sent || error_system(error, "standard output", "cannot write");
}

/* The value of a key that is given and not null. */
static const json_t *compare_server_find(const json_t *object, const char *key) {
    const json_t *value = json_object_get(object, key);
    return json_is_null(value) ? NULL : value;
}

static bool read_path(const json_t *object, const char *key, const char **path, Error *error) {
    const json_t *value = compare_server_find(object, key);
    *path = json_string_value(value);
    if (value != NULL && *path == NULL) return error_input(error, name, "%s must be a text", key);
    return *path == NULL || !path_is_standard(*path) || error_input(error, name, "%s must be a file, not '-'", key);
}

static bool read_flag(const json_t *object, const char *key, bool *flag, Error *error) {
    const json_t *value = compare_server_find(object, key);
    *flag = json_is_true(value);
    return value == NULL || json_is_boolean(value) || error_input(error, name, "%s must be true or false", key);
}

static bool read_share(const json_t *value, const char *key, double *share, Error *error) {
    *share = json_number_value(value);
    return (json_is_number(value) && *share >= 0 && *share <= 1) ||
           error_input(error, name, "%s must be a number from 0 to 1", key);
}

/* "#cd2cc9", with or without '#'; "" is red. */
static bool read_color(const json_t *value, uint8_t color[3], Error *error) {
    const char *text = json_string_value(value);
    memcpy(color, (const uint8_t[3]){255, 0, 0}, 3);
    if (value == NULL || (text != NULL && text[0] == '\0')) return true;
    if (text != NULL && text[0] == '#') text++;
    if (text == NULL || strlen(text) != 6 || strspn(text, "0123456789abcdefABCDEF") != 6)
        return error_input(error, name, "diffColor must be six hex digits, such as \"#cd2cc9\"");
    const unsigned long number = strtoul(text, NULL, 16);
    for (int c = 0; c < 3; c++) color[c] = (uint8_t)(number >> (16 - 8 * c));
    return true;
}

static bool read_picture(const json_t *options, OdiffPicture *picture, Error *error) {
    const json_t *overlay = compare_server_find(options, "diffOverlay");
    bool mask;
    *picture = (OdiffPicture){.white = 0.5};
    if (!read_color(compare_server_find(options, "diffColor"), picture->color, error) ||
        !read_flag(options, "outputDiffMask", &mask, error))
        return false;
    if (mask) picture->ground = ODIFF_ON_NOTHING;
    if (overlay == NULL || json_is_false(overlay)) return true;
    picture->ground = ODIFF_ON_PALE;
    return json_is_true(overlay) || read_share(overlay, "diffOverlay", &picture->white, error);
}

static bool read_region(const json_t *value, int index, OdiffRegion *region, Error *error) {
    static const char *const keys[] = {"x1", "y1", "x2", "y2"};
    int64_t numbers[4];
    for (int i = 0; i < 4; i++) {
        const json_t *number = json_object_get(value, keys[i]);
        numbers[i] = json_integer_value(number);
        if (!json_is_integer(number) || numbers[i] < 0)
            return error_input(error, name, "ignoreRegions[%d]: %s must be a whole number from 0", index, keys[i]);
    }
    *region = (OdiffRegion){numbers[0], numbers[1], numbers[2], numbers[3]};
    return true;
}

static bool read_regions(const json_t *value, Request *request, Error *error) {
    request->compared.regions = request->regions;
    if (value == NULL) return true;
    if (!json_is_array(value) || json_array_size(value) > REGIONS_MAX)
        return error_input(error, name, "ignoreRegions must be an array of at most %d", REGIONS_MAX);
    request->compared.region_count = (int)json_array_size(value);
    for (int i = 0; i < request->compared.region_count; i++)
        if (!read_region(json_array_get(value, (size_t)i), i, &request->regions[i], error)) return false;
    return true;
}

static bool read_options(const json_t *options, Request *request, Error *error) {
    const json_t *threshold = compare_server_find(options, "threshold");
    if (options != NULL && !json_is_object(options)) return error_input(error, name, "options must be an object");
    request->compared.threshold = 0.1;
    return (threshold == NULL || read_share(threshold, "threshold", &request->compared.threshold, error)) &&
           read_flag(options, "antialiasing", &request->compared.antialias, error) &&
           read_flag(options, "failOnLayoutDiff", &request->same_layout, error) &&
           read_flag(options, "captureDiffLines", &request->rows, error) &&
           read_flag(options, "captureDiffCols", &request->columns, error) &&
           read_picture(options, &request->picture, error) &&
           read_regions(compare_server_find(options, "ignoreRegions"), request, error);
}

static bool load_files(const json_t *json, Request *request, Error *error) {
    static const char *const keys[] = {"base", "compare"};
    for (int i = 0; i < 2; i++) {
        if (!read_path(json, keys[i], &request->paths[i], error)) return false;
        if (request->paths[i] == NULL) return error_input(error, name, "%s is missing", keys[i]);
        if ((request->data[i] = image_load_png(request->paths[i], &request->sizes[i], error)) == NULL) return false;
    }
    return true;
}

static void skip(int64_t size) {
    while (size > 0 && getchar() != EOF) size--;
}

/* Both are read, or skipped, also after an error: what follows them is the next request. */
static bool load_buffers(const json_t *json, Request *request, Error *error) {
    static const char *const keys[] = {"baseLength", "compareLength"}, *const kinds[] = {"baseFormat", "compareFormat"};
    int64_t sizes[2];
    for (int i = 0; i < 2; i++) {
        sizes[i] = json_integer_value(json_object_get(json, keys[i]));
        request->lost = sizes[i] <= 0;
        if (request->lost) return error_input(error, name, "%s must be a whole number from 1", keys[i]);
    }
    for (int i = 0; i < 2; i++) {
        const char *kind = json_string_value(json_object_get(json, kinds[i]));
        request->paths[i] = i == 0 ? "base" : "compare";
        request->sizes[i] = (size_t)sizes[i];
        if (kind == NULL || strcmp(kind, "png") != 0) error_input(error, name, "%s must be \"png\"", kinds[i]);
        if (sizes[i] > FILE_SIZE) error_input(error, name, "%s must be at most %d", keys[i], FILE_SIZE);
        if (error->kind == ERROR_NONE && (request->data[i] = malloc(request->sizes[i])) == NULL)
            error_memory(error, name);
        if (request->data[i] == NULL)
            skip(sizes[i]);
        else if (fread(request->data[i], 1, request->sizes[i], stdin) != request->sizes[i])
            error_input(error, name, "ends before its files do");
    }
    return error->kind == ERROR_NONE;
}

static bool compare_server_judge(Request *request, Image *images[2], Answer *answer, Error *error) {
    const Image *a = images[0], *b = images[1];
    if (request->same_layout && (a->width != b->width || a->height != b->height)) {
        answer->kind = ANSWER_LAYOUT;
        return true;
    }
    if (!odiff_compare(a, b, &request->compared, request->paths[1], &answer->difference, error)) return false;
    if (answer->difference.count == 0) return true;
    answer->kind = ANSWER_PIXELS;
    return request->output == NULL ||
           odiff_picture_write(images[0], &answer->difference, &request->picture, request->output, error);
}

/* Files of equal bytes are checked, but not decompressed. */
static bool compare_files(Request *request, Answer *answer, Error *error) {
    int width, height;
    Image *images[2] = {NULL, NULL};
    const uint8_t *const data[] = {request->data[0], request->data[1]};
    answer->kind = ANSWER_MATCH;
    if (request->sizes[0] == request->sizes[1] && memcmp(data[0], data[1], request->sizes[0]) == 0)
        return png_check_start(data[0], request->sizes[0], request->paths[0], error) &&
               png_check(data[0], request->sizes[0], request->paths[0], &width, &height, error);
    const bool ok = image_decode_png_pair(data, request->sizes, request->paths, IMAGE_MAX_PIXELS, images, error) &&
                    (images[0] == images[1] || compare_server_judge(request, images, answer, error));
    image_destroy_pair(images);
    return ok;
}

static bool answer_request(const json_t *json, Request *request, Answer *answer, Error *error) {
    const char *kind = json_string_value(json_object_get(json, "type"));
    const bool buffers = kind != NULL && strcmp(kind, "buffer") == 0;
    const json_t *id = json_object_get(json, "requestId");
    request->has_id = json_is_integer(id);
    request->id = json_integer_value(id);
    return (buffers ? load_buffers(json, request, error) : load_files(json, request, error)) &&
           (request->has_id || error_input(error, name, "requestId must be a whole number")) &&
           read_path(json, "output", &request->output, error) &&
           read_options(compare_server_find(json, "options"), request, error) && compare_files(request, answer, error);
}

/* Of a line that is no request: its number, for which a client waits, and whether files may follow it. */
static void guess(const char *line, bool whole, Request *request) {
    static const char key[] = "\"requestId\"";
    const char *at = strstr(line, key), *rest;
    request->lost = !whole || strstr(line, "\"buffer\"") != NULL;
    if (at == NULL || (at > line && at[-1] == '\\')) return;
    at += sizeof key - 1;
    at += strspn(at, " \t");
    if (*at != ':') return;
    at += 1 + strspn(at + 1, " \t");
    request->has_id =
        parse_leading_int(at, INT64_MIN, INT64_MAX, &request->id, &rest) && strchr(" \t\r,}", *rest) != NULL;
}

/* line[size] is 0. */
static void read_request(const char *line, size_t size, bool whole, JsonReader *reader, Request *request,
                         Answer *answer, Error *error) {
    const json_t *json = NULL;
    if (!whole)
        error_input(error, name, "must have at most %d bytes", REQUEST_SIZE);
    else if (json_read_text(reader, name, line, size, error) && (json = json_read_value(reader, error)) != NULL &&
             !json_read_end(reader, error))
        json = NULL;
    if (json != NULL)
        answer_request(json, request, answer, error);
    else
        guess(line, whole, request);
}

/* Answers one line. False with error set if nobody can read the answer, or if files follow whose end is not known:
   their bytes are not requests. */
static bool serve(const char *line, size_t size, bool whole, Request *request, Error *error) {
    Error failure = {0};
    JsonReader reader = {.path = name};
    Answer answer = {.request = request, .error = &failure};
    *request = (Request){.id = 0};
    read_request(line, size, whole, &reader, request, &answer, &failure);
    if (failure.kind != ERROR_NONE) answer.kind = ANSWER_ERROR;
    const bool sent = compare_server_send(&answer, error);
    json_read_close(&reader);
    for (int i = 0; i < 2; i++) free(request->data[i]);
    odiff_difference_free(&answer.difference);
    if (sent && request->lost)
        return error_input(error, name, "how many bytes follow it is not known: the server ends");
    return sent;
}

/* The next line without its end, cut to `size` and ended by 0; false at the end of the input. */
static bool read_line(char *line, size_t size, size_t *length, bool *whole) {
    int c = getchar();
    *length = 0, *whole = true;
    if (c == EOF) return false;
    for (; c != '\n' && c != EOF; c = getchar())
        if (*length < size)
            line[(*length)++] = (char)c;
        else
            *whole = false;
    line[*length] = '\0';
    return true;
}

bool compare_serve(Error *error) {
    static char line[REQUEST_SIZE + 1];
    static Request request;
    size_t length;
    bool whole;
    bool ok = compare_server_send(&(Answer){.kind = ANSWER_READY, .request = &request}, error);
    while (ok && read_line(line, REQUEST_SIZE, &length, &whole))
        ok = length == 0 || serve(line, length, whole, &request, error);
    return ok;
}
