/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What identifies a study (its key), which shard this process does, and the record of both (run.json). */
#include "base/base.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/json.h"
#include "base/numbers.h"
#include "runs/pieces.h"

#include <assert.h>
#include <inttypes.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MAX_SIZE = 1 << 28 };

static void add_hash(StudyKey *key, uint64_t hash) {
    const uint64_t words[2] = {key->value, hash};
    key->value = hash_xxh3(words, sizeof words);
}

void study_key_add(StudyKey *key, const void *data, size_t size) { add_hash(key, hash_xxh3(data, size)); }

static bool hash_file(const char *path, uint64_t *hash, Error *error) {
    size_t size;
    char *data = file_read(path, MAX_SIZE, &size, error);
    if (data == NULL) return false;
    *hash = hash_xxh3(data, size);
    free(data);
    return true;
}

bool study_key_add_input(StudyKey *key, const char *path, uint64_t hash, Error *error) {
    char *copy = strdup(path);
    if (copy == NULL || !array_reserve((void **)&key->inputs, &key->capacity, key->count + 1, sizeof *key->inputs)) {
        free(copy);
        return error_memory(error, path);
    }
    add_hash(key, hash);
    key->inputs[key->count++] = (StudyInput){copy, hash};
    return true;
}

bool study_key_add_file(StudyKey *key, const char *path, Error *error) {
    uint64_t hash;
    return hash_file(path, &hash, error) && study_key_add_input(key, path, hash, error);
}

bool study_key_begin(StudyKey *key, Error *error) {
    *key = (StudyKey){0};
    if (!hash_file("/proc/self/exe", &key->program, error)) {
        error->kind = ERROR_SYSTEM; /* no input of the user's */
        return false;
    }
    add_hash(key, key->program);
    return true;
}

void study_key_free(StudyKey *key) {
    for (size_t i = 0; i < key->count; i++) free(key->inputs[i].path);
    free(key->inputs);
    *key = (StudyKey){0};
}

static bool take_text(const JsonReader *json, const json_t *object, const char *name, char **text, Error *error) {
    const json_t *value = json_object_get(object, name);
    if (!json_is_string(value)) return json_read_error(json, error, "'%s' must be a text", name);
    *text = strdup(json_string_value(value));
    return *text != NULL || error_memory(error, json->path);
}

static bool take_hash(const JsonReader *json, const json_t *object, const char *name, uint64_t *hash, Error *error) {
    const json_t *value = json_object_get(object, name);
    const char *text = json_string_value(value);
    enum { DIGITS = 16 };
    if (text == NULL || strlen(text) != DIGITS || strspn(text, "0123456789abcdef") != DIGITS)
        return json_read_error(json, error, "'%s' must be %d hex digits", name, DIGITS);
    *hash = strtoull(text, NULL, 16);
    return true;
}

static bool take_number(const JsonReader *json, const json_t *object, const char *name, int least, int most,
                        int *number, Error *error) {
    const json_t *value = json_object_get(object, name);
    const json_int_t read = json_integer_value(value);
    if (!json_is_integer(value) || read < least || read > most)
        return json_read_error(json, error, "'%s' must be a number from %d to %d", name, least, most);
    *number = (int)read;
    return true;
}

static bool take_arguments(const JsonReader *json, const json_t *object, StudyCommand *command, Error *error) {
    const json_t *list = json_object_get(object, "arguments");
    const size_t count = json_array_size(list);
    if (count < 2) return json_read_error(json, error, "'arguments' must be an array of a command and its arguments");
    command->argv = calloc(count + 1, sizeof *command->argv);
    if (command->argv == NULL) return error_memory(error, json->path);
    for (size_t i = 0; i < count; i++) {
        const char *text = json_string_value(json_array_get(list, i));
        if (text == NULL) return json_read_error(json, error, "'arguments' must be texts");
        command->argv[command->argc] = strdup(text);
        if (command->argv[command->argc++] == NULL) return error_memory(error, json->path);
    }
    return true;
}

static bool take_inputs(const JsonReader *json, const json_t *object, StudyKey *key, Error *error) {
    const json_t *list = json_object_get(object, "inputs");
    const size_t count = json_array_size(list);
    if (!json_is_array(list)) return json_read_error(json, error, "'inputs' must be an array");
    key->inputs = calloc(count + 1, sizeof *key->inputs);
    if (key->inputs == NULL) return error_memory(error, json->path);
    for (size_t i = 0; i < count; i++) {
        const json_t *input = json_array_get(list, i);
        key->count++;
        if (!take_text(json, input, "file", &key->inputs[i].path, error) ||
            !take_hash(json, input, "hash", &key->inputs[i].hash, error))
            return false;
    }
    return true;
}

static bool take_record(const JsonReader *json, const json_t *object, StudyRecord *record, Error *error) {
    const char *format = json_string_value(json_object_get(object, "format"));
    if (format == NULL || strcmp(format, STUDY_RECORD_FORMAT) != 0)
        return json_read_error(json, error, "not a record of shards of twinbox");
    return take_text(json, object, "version", &record->version, error) &&
           take_hash(json, object, "program", &record->key.program, error) &&
           take_hash(json, object, "key", &record->key.value, error) &&
           take_number(json, object, "shards", 2, SHARDS_MAX, &record->shards, error) &&
           take_number(json, object, "array_first", 0, INT32_MAX, &record->array.first, error) &&
           take_number(json, object, "array_step", 0, INT32_MAX, &record->array.step, error) &&
           take_text(json, object, "folder", &record->command.folder, error) &&
           take_text(json, object, "output", &record->command.output, error) &&
           take_arguments(json, object, &record->command, error) && take_inputs(json, object, &record->key, error) &&
           take_hash(json, object, "hash", &record->hash, error);
}

bool study_record_read(StudyRecord *record, const char *path, Error *error) {
    JsonReader json;
    *record = (StudyRecord){0};
    if (!json_read_open(&json, path, STUDY_RECORD_SIZE, error)) return false;
    const json_t *value = json_read_value(&json, error);
    const bool done = value != NULL && take_record(&json, value, record, error) && json_read_end(&json, error);
    json_read_close(&json);
    return done;
}

void study_record_free(StudyRecord *record) {
    for (int i = 0; i < record->command.argc; i++) free(record->command.argv[i]);
    free(record->command.argv);
    free(record->command.folder);
    free(record->command.output);
    free(record->version);
    study_key_free(&record->key);
    *record = (StudyRecord){0};
}

bool shard_parse(Shard *shard, const char *text, Error *error) {
    int64_t values[2];
    const char *rest;
    if (!parse_leading_int(text, 0, INT32_MAX, &values[0], &rest) || *rest != '/' ||
        !parse_int(rest + 1, 0, INT32_MAX, &values[1]))
        return error_input(error, "--shard", "'%s' is not I/N, such as 3/16", text);
    if (values[1] < 1 || values[1] > SHARDS_MAX)
        return error_input(error, "--shard", "'%s': N must be from 1 to %d", text, SHARDS_MAX);
    if (values[0] < 1 || values[0] > values[1])
        return error_input(error, "--shard", "'%s': I must be from 1 to N", text);
    *shard = (Shard){(int)values[0], (int)values[1]};
    return true;
}

/* Pieces are put in an order that a step coprime to their number gives, and this order is cut into shards. The step is
   near the golden section, which no regular pattern of long and short pieces meets again and again. */
int shard_of(int64_t piece, int64_t pieces, int shards) {
    const double golden = 0.6180339887498949;
    if (shards <= 1 || pieces <= 1) return 1;
    int64_t step = (int64_t)((double)pieces * golden);
    if (step < 1) step = 1;
    while (greatest_divisor(step, pieces) != 1) step++;
    const int64_t place = piece * step % pieces; /* within 64 bits: PIECES_MAX */
    return (int)(place * shards / pieces) + 1;
}

/* What schedulers tell a process about its share. */

/* The rank of a process, from 0, and their number. */
typedef struct Ranks {
    const char *rank, *count;
} Ranks;

static const Ranks mpi[] = {{"PMI_RANK", "PMI_SIZE"}, {"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"}},
                   slurm_tasks = {"SLURM_PROCID", "SLURM_NTASKS"};

static bool is_set(const char *name) {
    const char *text = getenv(name);
    return text != NULL && text[0] != '\0';
}

static bool read_number(const char *name, int64_t least, int64_t most, int *number, Error *error) {
    int64_t value;
    if (!parse_int(getenv(name), least, most, &value))
        return error_input(error, name, "'%s' in the environment is not a number from %lld to %lld; use --shard",
                           getenv(name), (long long)least, (long long)most);
    *number = (int)value;
    return true;
}

static bool read_ranks(ShardRequest *request, const Ranks *ranks, Error *error) {
    int rank = 0, count = 1;
    if (!read_number(ranks->count, 1, SHARDS_MAX, &count, error) ||
        !read_number(ranks->rank, 0, count - 1, &rank, error))
        return false;
    request->shard = (Shard){rank + 1, count};
    if (count > 1)
        snprintf(request->source, sizeof request->source, "%s=%d, %s=%d", ranks->rank, rank, ranks->count, count);
    return true;
}

static bool read_array(ShardRequest *request, Error *error) {
    int first = 1, last = 1, step = 1, id = 0;
    if (!read_number("SLURM_ARRAY_TASK_ID", 0, INT32_MAX, &id, error)) return false;
    first = last = id;
    if ((is_set("SLURM_ARRAY_TASK_MIN") && !read_number("SLURM_ARRAY_TASK_MIN", 0, id, &first, error)) ||
        (is_set("SLURM_ARRAY_TASK_MAX") && !read_number("SLURM_ARRAY_TASK_MAX", id, INT32_MAX, &last, error)) ||
        (is_set("SLURM_ARRAY_TASK_STEP") && !read_number("SLURM_ARRAY_TASK_STEP", 1, INT32_MAX, &step, error)))
        return false;
    const int64_t count = ((int64_t)last - first) / step + 1;
    if (count > SHARDS_MAX)
        return error_input(error, "SLURM_ARRAY_TASK_MAX", "the job array has %lld tasks; at most %d are allowed",
                           (long long)count, SHARDS_MAX);
    /* A list such as 3,17 has no step: the record of the study's first start tells what its ids mean. */
    request->array = (JobArray){first, step, id};
    request->shard = (Shard){(id - first) / step + 1, (int)count};
    snprintf(request->source, sizeof request->source, "SLURM_ARRAY_TASK_ID=%d of %d-%d:%d", id, first, last, step);
    return true;
}

static const Ranks *find_mpi(void) {
    for (size_t i = 0; i < sizeof mpi / sizeof *mpi; i++)
        if (is_set(mpi[i].rank) && is_set(mpi[i].count)) return &mpi[i];
    return NULL;
}

bool shard_request(ShardRequest *request, const char *option, Error *error) {
    const Ranks *ranks = find_mpi();
    *request = (ShardRequest){.shard = {1, 1}};
    if (option != NULL) return shard_parse(&request->shard, option, error);
    if (is_set("SLURM_ARRAY_TASK_ID")) {
        ShardRequest rank = {0};
        if (ranks != NULL && !read_ranks(&rank, ranks, error)) return false;
        if (rank.shard.count > 1)
            return error_input(error, "--shard", "is needed: this is a task of a job array, and one of %d ranks (%s)",
                               rank.shard.count, ranks->rank);
        return read_array(request, error);
    }
    if (ranks != NULL) return read_ranks(request, ranks, error);
    return !is_set(slurm_tasks.rank) || !is_set(slurm_tasks.count) || read_ranks(request, &slurm_tasks, error);
}

/* Of all that the file has. */
static uint64_t record_hash(const StudyRecord *record) {
    const StudyCommand *command = &record->command;
    const int numbers[] = {record->shards, record->array.first, record->array.step, command->argc};
    const char *const texts[] = {record->version, command->folder, command->output};
    StudyKey sum = {.value = record->key.value};
    add_hash(&sum, record->key.program);
    study_key_add(&sum, numbers, sizeof numbers);
    for (int i = 0; i < 3; i++) study_key_add(&sum, texts[i], strlen(texts[i]));
    for (int i = 0; i < command->argc; i++) study_key_add(&sum, command->argv[i], strlen(command->argv[i]));
    for (size_t i = 0; i < record->key.count; i++) {
        study_key_add(&sum, record->key.inputs[i].path, strlen(record->key.inputs[i].path));
        add_hash(&sum, record->key.inputs[i].hash);
    }
    return sum.value;
}

static void study_record_print(FILE *out, const void *context) {
    const StudyRecord *record = context;
    JsonWriter json = {.out = out};
    json_begin_object(&json, NULL, JSON_LINES);
    json_put_text(&json, "format", STUDY_RECORD_FORMAT);
    json_put_text(&json, "version", record->version);
    json_put_hash(&json, "program", record->key.program);
    json_put_hash(&json, "key", record->key.value);
    json_put_int(&json, "shards", record->shards);
    json_put_int(&json, "array_first", record->array.first);
    json_put_int(&json, "array_step", record->array.step);
    json_put_text(&json, "folder", record->command.folder);
    json_put_text(&json, "output", record->command.output);
    json_begin_array(&json, "arguments", JSON_ONE_LINE);
    for (int i = 0; i < record->command.argc; i++) json_put_text(&json, NULL, record->command.argv[i]);
    json_end(&json);
    json_begin_array(&json, "inputs", JSON_LINES);
    for (size_t i = 0; i < record->key.count; i++) {
        json_begin_object(&json, NULL, JSON_ONE_LINE);
        json_put_text(&json, "file", record->key.inputs[i].path);
        json_put_hash(&json, "hash", record->key.inputs[i].hash);
        json_end(&json);
    }
    json_end(&json);
    json_put_hash(&json, "hash", record_hash(record));
    json_end(&json);
}

/* file_create() fails if another process was first: that is as good. */
static bool study_record_create(const char *path, const char *text, size_t size, Error *error) {
    Error failure = {0};
    bool there;
    if (file_create(path, text, size, &failure)) return true;
    if (failure.kind == ERROR_INPUT && file_find(path, &there, error) && there) return true;
    if (error->kind == ERROR_NONE) *error = failure;
    return false;
}

bool study_record_meet(StudyRecord *record, const char *path, const StudyStart *start, Error *error) {
    char folder[PATH_MAX], version[] = TWINBOX_VERSION;
    bool there;
    *record = (StudyRecord){0};
    if (!file_find(path, &there, error)) return false;
    if (there) return study_record_read(record, path, error);
    if (getcwd(folder, sizeof folder) == NULL) return error_system(error, path, "the current folder has no name");
    const StudyRecord written = {.version = version,
                                 .key = *start->key,
                                 .shards = start->request->shard.count,
                                 .array = start->request->array,
                                 .command = {start->argc, start->argv, folder, (char *)start->output}};
    size_t size;
    char *text = file_print(study_record_print, &written, &size);
    if (text == NULL) return error_memory(error, path);
    const bool fits = size <= STUDY_RECORD_SIZE || error_input(error, path,
                                                               "the command line and its input files are too many for "
                                                               "shards: more than %d bytes",
                                                               STUDY_RECORD_SIZE);
    const bool done = fits && study_record_create(path, text, size, error) && study_record_read(record, path, error);
    free(text);
    return done;
}

static bool study_record_differs(const char *path, Error *error, const char *what, const char *here,
                                 const char *there) {
    return error_input(error, path,
                       "the folder has shards of another study: %s is %s there, %s here. Use another output folder, or "
                       "delete the shards",
                       what, there, here);
}

static bool hash_differs(const char *path, Error *error, const char *what, uint64_t here, uint64_t there) {
    char texts[2][24];
    snprintf(texts[0], sizeof texts[0], "%016llx", (unsigned long long)here);
    snprintf(texts[1], sizeof texts[1], "%016llx", (unsigned long long)there);
    return study_record_differs(path, error, what, texts[0], texts[1]);
}

static bool check_inputs(const StudyRecord *record, const char *path, const StudyKey *key, Error *error) {
    char what[PATH_MAX + 32];
    for (size_t i = 0; i < record->key.count && i < key->count; i++) { /* more or fewer: other arguments */
        const StudyInput *there = &record->key.inputs[i], *here = &key->inputs[i];
        if (there->hash == here->hash) continue;
        snprintf(what, sizeof what, "the hash of the input %s", here->path);
        return hash_differs(path, error, what, here->hash, there->hash);
    }
    return true;
}

static bool check_arguments(const StudyRecord *record, const char *path, int argc, char **argv, Error *error) {
    const StudyCommand *there = &record->command;
    for (int i = 0; argv != NULL && (i < argc || i < there->argc); i++) {
        const char *mine = i < argc ? argv[i] : "(no more)", *its = i < there->argc ? there->argv[i] : "(no more)";
        if (strcmp(mine, its) != 0) return study_record_differs(path, error, "an argument", mine, its);
    }
    return true;
}

bool study_record_check(const StudyRecord *record, const char *path, const StudyKey *key, int argc, char **argv,
                        Error *error) {
    if (strcmp(record->version, TWINBOX_VERSION) != 0)
        return study_record_differs(path, error, "the version of twinbox", TWINBOX_VERSION, record->version);
    if (key->program != record->key.program)
        return hash_differs(path, error, "the hash of the program", key->program, record->key.program);
    if (!check_inputs(record, path, key, error)) return false;
    if (key->value != record->key.value)
        return check_arguments(record, path, argc, argv, error) &&
               hash_differs(path, error, "the hash of options and inputs", key->value, record->key.value);
    return record->hash == record_hash(record) ||
           error_input(error, path,
                       "has been changed since the first shard wrote it: its hash is %016" PRIx64 ", not %016" PRIx64,
                       record_hash(record), record->hash);
}

bool study_record_shard(const StudyRecord *record, const char *path, const ShardRequest *request, Shard *shard,
                        Error *error) {
    *shard = (Shard){request->shard.number, record->shards};
    if (request->array.step == 0 || record->array.step == 0)
        return request->shard.count == record->shards ||
               error_input(error, path, "the study was begun in %d shards, and this is one of %d", record->shards,
                           request->shard.count);
    const int64_t beyond = (int64_t)request->array.id - record->array.first;
    shard->number = (int)(beyond / record->array.step) + 1;
    return (beyond >= 0 && beyond % record->array.step == 0 && beyond / record->array.step < record->shards) ||
           error_input(error, path, "the study was begun by the job array %d-%lld:%d, which has no task %d",
                       record->array.first,
                       (long long)record->array.first + (long long)(record->shards - 1) * record->array.step,
                       record->array.step, request->array.id);
}
