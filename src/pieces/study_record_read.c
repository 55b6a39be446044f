/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pieces/study_record.h"

#include "json/json_read.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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
           take_arguments(json, object, &record->command, error) && take_inputs(json, object, &record->key, error);
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
