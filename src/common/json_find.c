/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finding values in what has been read. */
#include "common/json.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

const JsonValue *json_first(const JsonValue *container) { return container->count > 0 ? container + 1 : NULL; }

const JsonValue *json_next(const JsonValue *container, const JsonValue *value) {
    const JsonValue *next = value + value->span;
    return next < container + container->span ? next : NULL;
}

const JsonValue *json_member(const JsonValue *object, const char *key) {
    if (object->kind != JSON_OBJECT) return NULL;
    for (const JsonValue *member = json_first(object); member != NULL; member = json_next(object, member))
        if (strcmp(member->key, key) == 0) return member;
    return NULL;
}

const JsonValue *json_need(const Json *json, const JsonValue *object, const char *key, JsonKind kind, Error *error) {
    static const char *const names[] = {"null", "false", "true", "a number", "a text", "an array", "an object"};
    const JsonValue *member = json_member(object, key);
    if (member != NULL && member->kind == kind) return member;
    if (member == NULL)
        json_error(json, object, error, "\"%s\" is missing", key);
    else
        json_error(json, member, error, "\"%s\" is not %s", key, names[kind]);
    return NULL;
}

bool json_need_int(const Json *json, const JsonValue *object, const char *key, int64_t minimum, int64_t maximum,
                   int64_t *value, Error *error) {
    const JsonValue *member = json_need(json, object, key, JSON_NUMBER, error);
    if (member == NULL) return false;
    /* A double holds whole numbers up to 2^53 exactly. */
    double number = member->number;
    if (number != trunc(number) || fabs(number) > 0x1p53 || number < (double)minimum || number > (double)maximum)
        return json_error(json, member, error, "\"%s\" is not a whole number from %" PRId64 " to %" PRId64, key,
                          minimum, maximum);
    *value = (int64_t)number;
    return true;
}
