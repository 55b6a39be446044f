/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A run as text, in CSV: its head (comments with sizes and names) and its rows, read and written. */
#include "base/base.h"
#include "base/csv.h"
#include "base/file.h"
#include "engine/engine.h"
#include "runs/compare_runs.h"
#include "runs/run_files.h"
#include "runs/runs_internal.h"
#include "runs/trajectory.h"

#include <ctype.h>
#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { CSV_HEAD_LINE_SIZE = 256, NUMBERS_MAX = 4, BODIES_MAX = 1000000 };
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
static int take_list(char *text, int least, int most, float numbers[NUMBERS_MAX]) {
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

/* "0,100,20", "0,100,20,static" or "0,100,20,dynamic" */
static bool take_size(CsvHead *head, const char *path, char *text, Error *error, bool *right) {
    CsvBody body = {0};
    float size[NUMBERS_MAX] = {0};
    char *last = strrchr(text, ',');
    const char *word = last != NULL ? last + 1 + strspn(last + 1, " ") : "";
    body.fixed = strcmp(word, "static") == 0;
    if (body.fixed || strcmp(word, "dynamic") == 0) {
        head->states_static = true;
        *last = '\0';
    }
    char *comma = strchr(text, ',');
    *right = comma != NULL;
    if (comma == NULL) return true;
    *comma = '\0';
    *right = parse_int(text, 0, INT32_MAX - 1, &body.number) && take_list(comma + 1, 2, 2, size) == 2 &&
             is_size(size[0]) && is_size(size[1]);
    body.size = vec2(size[0], size[1]);
    return !*right || add_body(head, path, body, error);
}

static bool take_name(char name[TRAJECTORY_NAME_SIZE], const char *text) {
    for (const char *c = text; *c != '\0'; c++)
        if ((unsigned char)*c < 0x20 || *c == 0x7f) return false;
    return snprintf(name, TRAJECTORY_NAME_SIZE, "%s", text) < TRAJECTORY_NAME_SIZE;
}

/* What a key states; in the order of the keys. */
enum {
    KEY_SCENE,
    KEY_METHOD,
    KEY_SCENE_HASH,
    KEY_ITERATIONS,
    KEY_DT,
    KEY_BOMB,
    KEY_CAMERA,
    KEY_NUMBERS,
    KEY_SIZE,
    KEYS
};
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
    {"numbers", "float32 or float64"},
    {"size", "BODY,WIDTH,HEIGHT from 1e-06 to 1e+06 m, perhaps with static or dynamic"},
};

static bool take_value(CsvHead *head, const char *path, int key, char *text, Error *error, bool *right) {
    float camera[NUMBERS_MAX];
    char *end;
    switch (key) {
    case KEY_SCENE: *right = take_name(head->scene, text); break;
    case KEY_METHOD: *right = take_name(head->method, text); break;
    case KEY_SCENE_HASH:
        head->scene_hash = strtoull(text, &end, 16);
        *right = strlen(text) == 16 && strspn(text, "0123456789abcdef") == 16 && *end == '\0';
        break;
    case KEY_ITERATIONS: *right = parse_int(text, 1, INT32_MAX, &head->iterations); break;
    case KEY_DT: *right = parse_float(text, &head->dt) && head->dt > 0; break;
    case KEY_BOMB: *right = parse_int(text, 0, INT32_MAX - 1, &head->bomb); break;
    case KEY_CAMERA:
        *right = take_list(text, 4, 4, camera) == 4;
        if (!*right) break;
        head->camera[0] = vec2(camera[0], camera[1]);
        head->camera[1] = vec2(camera[2], camera[3]);
        break;
    case KEY_NUMBERS:
        head->single = strcmp(text, "float32") == 0;
        *right = head->single || strcmp(text, "float64") == 0;
        break;
    default: return take_size(head, path, text, error, right);
    }
    return true;
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
        return right || csv_fail(path, line, 0, error, "%s: expected %s", keys[key].name, keys[key].form);
    }
    const char *near = nearest_word(text, known, KEYS);
    return near == NULL || csv_fail(path, line, 0, error, "'# %s:': did you mean '# %s:'?", csv_show(text).text, near);
}

static int compare_bodies(const void *left, const void *right) {
    const CsvBody *a = left, *b = right;
    return (a->number > b->number) - (a->number < b->number);
}

bool csv_head_read(CsvHead *head, const char *path, const char **text, int *line, const CsvRunOptions *options,
                   Error *error) {
    const char *sizes = options->sizes;
    *head = (CsvHead){.bomb = -1};
    if (strncmp(*text, "\xef\xbb\xbf", 3) == 0) *text += 3;
    const char first = (*text)[strspn(*text, " \t\r\n")];
    if (first == '{' || first == '[')
        return error_input(error, path,
                           "is JSON, and only CSV can be imported; 'twinbox export RUN.npz -o RUN.csv' writes it");
    for (*line = 1; **text == '#'; ++*line) {
        char comment[CSV_HEAD_LINE_SIZE];
        const char *begin = *text + 1 + strspn(*text + 1, " \t");
        size_t length = strcspn(begin, "\n"), used = length;
        *text = begin + length + (begin[length] == '\n');
        while (used > 0 && strchr(" \t\r", begin[used - 1]) != NULL) used--;
        if (used >= CSV_HEAD_LINE_SIZE) return csv_fail(path, *line, 0, error, "a comment longer than 255 bytes");
        memcpy(comment, begin, used);
        comment[used] = '\0';
        if (!take_comment(head, path, *line, comment, error)) return false;
    }
    if (sizes != NULL && head->count > 0)
        return error_input(error, sizes, "the comments of %s also have sizes; give one of the two", path);
    if (sizes != NULL && !read_sizes(head, sizes, error)) return false;
    if (head->count > 0) qsort(head->bodies, head->count, sizeof *head->bodies, compare_bodies);
    for (size_t i = 1; i < head->count; i++)
        if (head->bodies[i].number == head->bodies[i - 1].number)
            return error_input(error, path, "body %" PRId64 " has two sizes", head->bodies[i].number);
    return head->count > 0 || options->as_trace ||
           error_input(error, path,
                       "the sizes of the bodies are missing: give --sizes FILE.csv with body,width,height, or "
                       "lines '# size: BODY,WIDTH,HEIGHT' above the header");
}

int csv_head_body(const CsvHead *head, int64_t number) {
    const CsvBody key = {.number = number};
    const CsvBody *found = bsearch(&key, head->bodies, head->count, sizeof *head->bodies, compare_bodies);
    return found != NULL ? (int)(found - head->bodies) : -1;
}

enum { CSV_ROWS_LINE_SIZE = 1024, FIELDS_MAX = 64, INDEX_MAX = INT32_MAX - 1 };

static const char *const names[COL_COUNT] = {"frame", "body", "x", "y", "angle", "vx", "vy", "omega", "hash", "time"};

/* The fields of a line, in the file's text. */
typedef struct Field {
    const char *begin, *end; /* without quotes and blanks around it */
    int column;              /* in the line, from 1 */
} Field;
typedef struct Fields {
    int count;
    Field list[FIELDS_MAX];
} Fields;

/* Takes the next line. */
static bool split(CsvRows *rows, Fields *fields, Error *error) {
    const char *begin = rows->at, *line_end = strchr(begin, '\n'), *end = line_end;
    if (end == NULL) line_end = end = begin + strlen(begin);
    fields->count = 0;
    if (end > begin && end[-1] == '\r') end--;
    if (end == begin) return csv_fail(rows->path, rows->line, 0, error, "the line is empty");
    if (end - begin >= CSV_ROWS_LINE_SIZE)
        return csv_fail(rows->path, rows->line, 0, error, "longer than %d bytes", CSV_ROWS_LINE_SIZE - 1);
    rows->at = line_end + (*line_end == '\n');
    /* In the first pass no field behind the numbers of frame and body is looked at. */
    for (const char *next = begin; next != NULL && fields->count < rows->needed;) {
        if (fields->count == FIELDS_MAX)
            return csv_fail(rows->path, rows->line, 0, error, "more than %d fields", FIELDS_MAX);
        Field *field = &fields->list[fields->count++];
        *field = (Field){.begin = next, .column = (int)(next - begin) + 1};
        while (*field->begin == ' ' || *field->begin == '\t') field->begin++;
        if (*field->begin == '"') {
            const char *close = ++field->begin;
            while (close < end && (*close != '"' || close[1] == '"')) close += *close == '"' ? 2 : 1;
            if (close >= end) return csv_fail(rows->path, rows->line, field->column, error, "this quote is not closed");
            field->end = close++;
            for (next = close; *next == ' ' || *next == '\t';) next++;
        } else {
            for (next = field->begin; next < end && *next != ',';) next++;
            for (field->end = next; field->end > field->begin && (field->end[-1] == ' ' || field->end[-1] == '\t');)
                field->end--;
        }
        if (next < end && *next != ',')
            return csv_fail(rows->path, rows->line, field->column, error, "expected a comma after the closing quote");
        next = next < end ? next + 1 : NULL;
    }
    return true;
}

/* What a field has, for messages and names; longer ones are cut. */
typedef struct FieldText {
    char text[64];
} FieldText;

static FieldText field_text(const Field *field) {
    FieldText of;
    snprintf(of.text, sizeof of.text, "%.*s", (int)(field->end - field->begin), field->begin);
    return of;
}

static bool is_absent(const CsvRows *rows, int column) { return rows->field[column] < 0; }

/* Finds the columns. Names that mean nothing are kept for a note, unless one looks like a name that is missing. */
static bool find_columns(CsvRows *rows, const Fields *fields, Error *error) {
    const char *missing[COL_COUNT];
    int lacks = 0;
    for (int i = 0; i < COL_COUNT; i++) rows->field[i] = -1;
    for (int i = 0; i < fields->count; i++) {
        int column = 0;
        while (column < COL_COUNT && strcmp(names[column], field_text(&fields->list[i]).text) != 0) column++;
        if (column == COL_COUNT) continue;
        if (!is_absent(rows, column))
            return csv_fail(rows->path, rows->line, fields->list[i].column, error, "the column '%s' appears twice",
                            names[column]);
        rows->field[column] = i;
    }
    for (int i = 0; i < COL_COUNT; i++)
        if (is_absent(rows, i) && i != COL_HASH) missing[lacks++] = names[i]; /* 'mass' is no mistyped hash */
    for (int i = 0; i < fields->count; i++) {
        const FieldText name = field_text(&fields->list[i]);
        bool known = false;
        for (int column = 0; column < COL_COUNT; column++) known = known || rows->field[column] == i;
        if (known) continue;
        const char *right = strlen(name.text) > 3 ? nearest_word(name.text, missing, lacks) : NULL;
        const CsvShown shown = csv_show(name.text);
        if (right != NULL)
            return csv_fail(rows->path, rows->line, fields->list[i].column, error,
                            "unknown column '%s': did you mean '%s'? Rename or remove it", shown.text, right);
        text_join(rows->ignored, sizeof rows->ignored, ", ", "%s", shown.text);
    }
    return true;
}

bool csv_rows_begin(CsvRows *rows, const char *path, const char *text, int line, bool as_trace, Error *error) {
    Fields fields;
    *rows = (CsvRows){.path = path, .at = text, .line = line, .as_trace = as_trace, .needed = INT_MAX};
    if (*text == '\0') return csv_fail(rows->path, line, 0, error, "there is no header 'frame,body,x,y,angle'");
    if (!split(rows, &fields, error)) return false;
    const FieldText first = field_text(&fields.list[0]);
    const char *separator = fields.count == 1 ? strpbrk(first.text, ";\t|") : NULL;
    if (separator != NULL)
        return csv_fail(rows->path, line, 0, error, "the fields are separated by %s; expected commas",
                        *separator == ';'   ? "semicolons"
                        : *separator == '|' ? "bars"
                                            : "tabs");
    if (!find_columns(rows, &fields, error)) return false;
    /* A trace may have a hash of each state instead of its numbers. */
    const bool hashed = as_trace && !is_absent(rows, COL_HASH);
    for (int i = COL_FRAME; i <= COL_ANGLE; i++)
        if (is_absent(rows, i) && (i <= COL_BODY || !hashed || is_absent(rows, COL_X) != is_absent(rows, i)))
            return csv_fail(rows->path, line, 0, error, "the column '%s' is missing; expected frame,body,x,y,angle%s",
                            names[i], as_trace ? ", or frame,body,hash" : "");
    for (int i = COL_VX; i <= COL_OMEGA; i++)
        if (is_absent(rows, i) != is_absent(rows, COL_VX))
            return csv_fail(rows->path, line, 0, error, "give all of vx, vy and omega, or none of them");
    rows->width = fields.count;
    rows->first = rows->at;
    rows->first_line = rows->line = line + 1;
    return true;
}

void csv_rows_rewind(CsvRows *rows, bool indices_only) {
    const int *field = rows->field;
    rows->indices_only = indices_only && field[COL_TIME] < 0;
    rows->needed =
        !rows->indices_only ? INT_MAX : 1 + (field[COL_FRAME] > field[COL_BODY] ? field[COL_FRAME] : field[COL_BODY]);
    rows->at = rows->first;
    rows->line = rows->first_line;
}

static bool fail_field(const CsvRows *rows, const Fields *fields, int column, Error *error, const char *what) {
    const Field *field = &fields->list[rows->field[column]];
    return csv_fail(rows->path, rows->line, field->column, error, "%s: '%s' %s", names[column],
                    csv_show(field_text(field).text).text, what);
}

static bool take_index(const CsvRows *rows, const Fields *fields, int column, int64_t *index, Error *error) {
    const Field *field = &fields->list[rows->field[column]];
    const char *c = field->begin;
    for (*index = 0; c < field->end && *c >= '0' && *c <= '9' && *index <= INDEX_MAX; c++)
        *index = *index * 10 + *c - '0';
    return (c == field->end && c > field->begin && *index <= INDEX_MAX) ||
           fail_field(rows, fields, column, error, "is not a whole number from 0 to 2147483646");
}

enum { DIGITS = 19 }; /* that a uint64_t holds */
__extension__ typedef unsigned __int128 Wide;

/* The float64 nearest to digits / power, ties to even; digits > 0. */
static double nearest_double(uint64_t digits, uint64_t power) {
    if (digits <= (uint64_t)1 << 53) return (double)digits / (double)power; /* both are exact: powers to 1e19 are */
    const int shift = __builtin_clzll(digits) + 64;
    const Wide dividend = (Wide)digits << shift, quotient = dividend / power; /* at least 64 bits */
    const uint64_t high = (uint64_t)(quotient >> 64);
    const int dropped = (high > 0 ? 128 - __builtin_clzll(high) : 64) - 54;
    const uint64_t kept = (uint64_t)(quotient >> dropped); /* 54 bits: a float64, and the bit behind it */
    const bool exact = ((Wide)kept << dropped) * power == dividend;
    return ldexp((double)((kept >> 1) + ((kept & 1) != 0 && (!exact || (kept & 2) != 0))), dropped + 1 - shift);
}

/* "0x1.8p-3", as "%a" of C prints a float64; false if it is of another form. */
static bool take_hexadecimal(const char *c, const char *end, double *value) {
    enum { LENGTH = 16 }; /* of "1.", 13 digits and "p": 53 bits are exact */
    const char *const first = c += 2;
    uint64_t digits = 0;
    int behind = 0, exponent = 0;
    bool point = false;
    for (; c < end && (isxdigit((unsigned char)*c) || (*c == '.' && !point)); c++) {
        if (*c != '.') digits = digits << 4 | (unsigned)((*c & 15) + 9 * (*c >> 6));
        behind += 4 * point;
        point = point || *c == '.';
    }
    if (c - first == point || c - first >= LENGTH || digits >> 53 != 0 || end - c < 2 || (*c != 'p' && *c != 'P'))
        return false;
    const bool negative = *++c == '-';
    c += negative || *c == '+';
    if (c == end || end - c > 4) return false;
    for (; c < end && *c >= '0' && *c <= '9'; c++) exponent = 10 * exponent + *c - '0';
    *value = ldexp((double)digits, (negative ? -exponent : exponent) - behind);
    return c == end;
}

/* Up to 19 digits without an exponent; false if it is of another form. */
static bool take_decimal(const char *c, const char *end, double *value) {
    const char *const first = c;
    uint64_t digits = 0, power = 1; /* of 10, behind the point */
    bool point = false;
    for (; c < end && ((*c >= '0' && *c <= '9') || (*c == '.' && !point)); c++) {
        if (*c == '.')
            point = true;
        else
            digits = digits * 10 + (uint64_t)(*c - '0'), power *= point ? 10 : 1;
    }
    const int64_t count = c - first - point;
    if (c < end || count == 0 || count > DIGITS) return false;
    *value = digits == 0 ? 0.0 : nearest_double(digits, power);
    return true;
}

/* Decimal, or hexadecimal, or nan or inf; rounded to the nearest float64. The thread has the C locale. strtod() takes
   five times as long as the two forms that most numbers have. */
static bool take_number(const Field *field, double *value) {
    const char *c = field->begin + (*field->begin == '-' || *field->begin == '+');
    if (c[0] == '0' && (c[1] == 'x' || c[1] == 'X') ? take_hexadecimal(c, field->end, value)
                                                    : take_decimal(c, field->end, value)) {
        if (*field->begin == '-') *value = -*value;
        return true;
    }
    char *end;
    *value = strtod(field->begin, &end);
    if (isnan(*value)) *value = NAN; /* its sign and payload mean nothing */
    return end == field->end && end > field->begin;
}

static bool take_hash(const Field *field, uint64_t *hash) {
    const char *first = field->begin + (strncasecmp(field->begin, "0x", 2) == 0 ? 2 : 0);
    char *end;
    *hash = strtoull(first, &end, 16);
    return end == field->end && isxdigit((unsigned char)*first) && end - first <= 16;
}

/* The value of one in the last digit of a decimal number. */
static double last_digit(const char *text) {
    const size_t length = strcspn(text, "eE"), whole = strcspn(text, ".");
    const int exponent = text[length] != '\0' ? atoi(text + length + 1) : 0;
    return pow(10, whole < length ? exponent - (int)(length - whole - 1) : exponent);
}

bool csv_rows_next(CsvRows *rows, CsvRow *row, Error *error) {
    Fields fields;
    *row = (CsvRow){.line = rows->line};
    if (((unsigned char)*rows->at <= ' ' && rows->at[strspn(rows->at, " \t\r\n")] == '\0') ||
        !split(rows, &fields, error))
        return false;
    if (rows->indices_only ? fields.count < rows->needed : fields.count != rows->width)
        return csv_fail(rows->path, rows->line, 0, error, "%d fields, but the header has %d", fields.count,
                        rows->width);
    if (!take_index(rows, &fields, COL_FRAME, &row->frame, error) ||
        !take_index(rows, &fields, COL_BODY, &row->body, error))
        return false;
    for (int column = COL_X; column <= COL_OMEGA && !rows->indices_only; column++) {
        double *number = &row->state[column - COL_X];
        if (is_absent(rows, column)) continue;
        if (!take_number(&fields.list[rows->field[column]], number))
            return fail_field(rows, &fields, column, error, "is not a finite number");
        row->not_finite = row->not_finite || !isfinite((float)*number);
    }
    if (!is_absent(rows, COL_HASH) && !rows->indices_only && rows->as_trace &&
        !take_hash(&fields.list[rows->field[COL_HASH]], &row->hash))
        return fail_field(rows, &fields, COL_HASH, error, "is not a hash of 1 to 16 hexadecimal digits");
    if (!is_absent(rows, COL_TIME)) {
        const Field *field = &fields.list[rows->field[COL_TIME]];
        if (!take_number(field, &row->time) || !isfinite(row->time))
            return fail_field(rows, &fields, COL_TIME, error, "is not a finite number");
        row->time_digit = last_digit(field_text(field).text);
    }
    rows->line++;
    return true;
}

int csv_rows_find(CsvRows *rows, int64_t frame, int64_t body) {
    CsvRow row;
    Error ignored = {0};
    csv_rows_rewind(rows, false);
    while (csv_rows_next(rows, &row, &ignored))
        if (row.frame == frame && row.body == body) return row.line;
    return 0;
}

/* Nine digits keep every bit of a float32, 17 those of a float64. */
static void print_head(FILE *out, const Trajectory *run) {
    fprintf(out, "# scene: %s\n# method: %s\n", run->scene, run->method);
    if (run->iterations > 0) fprintf(out, "# iterations: %d\n", run->iterations);
    if (run->scene_hash != 0) fprintf(out, "# scene_hash: %016" PRIx64 "\n", run->scene_hash);
    fprintf(out, "# numbers: %s\n# dt: %.9g\n", run->exact == NULL ? "float32" : "float64", (double)run->dt);
    if (run->bomb >= 0) fprintf(out, "# bomb: %d\n", run->bomb);
    if (run->camera_size.x > 0 && run->camera_size.y > 0)
        fprintf(out, "# camera: %.9g,%.9g,%.9g,%.9g\n", (double)run->camera_center.x, (double)run->camera_center.y,
                (double)run->camera_size.x, (double)run->camera_size.y);
    for (int body = 0; body < run->bodies; body++)
        fprintf(out, "# size: %d,%.9g,%.9g,%s\n", body, (double)run->size[body].x, (double)run->size[body].y,
                run->fixed[body] ? "static" : "dynamic");
}

static void print_run(FILE *out, const void *context) {
    const Trajectory *run = context;
    print_head(out, run);
    fprintf(out, "frame,body,x,y,angle%s\n", run->no_velocities ? "" : ",vx,vy,omega");
    for (int frame = 0; frame < run->frames; frame++) {
        bool alone = true; /* no body that is not static is there */
        for (int body = 0; alone && body < run->bodies; body++)
            alone = run->fixed[body] || !trajectory_has(run, frame, body);
        for (int body = 0; body < run->bodies; body++) {
            const size_t i = trajectory_at(run, frame, body);
            if (!trajectory_has(run, frame, body)) continue;
            /* A static body is written once, as readers keep it where it is, and where it is alone: each frame has a
               row. */
            if (run->fixed[body] && !alone && frame > 0 && trajectory_same_states(run, frame, run, frame - 1, body))
                continue;
            fprintf(out, "%d,%d", frame, body);
            for (int column = 0; column < (run->no_velocities ? 3 : STATE_COLUMNS); column++)
                fprintf(out, ",%.*g", run->exact == NULL ? 9 : 17, trajectory_number(run, i, column));
            fputc('\n', out);
        }
    }
}

bool csv_run_write(const Trajectory *run, const char *path, Error *error) {
    return file_write_text(path, print_run, run, error);
}
