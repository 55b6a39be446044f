/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rules of a comparison in memory. */
#include "base/base.h"
#include "base/file.h"
#include "base/yaml.h"
#include "pixels/png.h"
#include "regression/compare.h"
#include "regression/regression_internal.h"
#include "regression/regression.h"

#include <fnmatch.h>
#include <stdlib.h>
#include <string.h>

typedef struct Rule {
    const char *files; /* a text of the tree */
    int node;          /* of `files` */
    Tolerance tolerance;
    Mask mask;
    Mask region; /* a rectangle; or none: the limits are those of the whole picture */
} Rule;

struct Rules {
    char *path;
    YamlTree tree; /* its context are these rules */
    int pictures;  /* of all masks */
    int count;
    Rule *rules; /* [count] */
};

void rules_destroy(Rules *rules) {
    if (rules == NULL) return;
    for (int i = 0; i < rules->count; i++) mask_free(&rules->rules[i].mask);
    free(rules->rules);
    yaml_tree_free(&rules->tree);
    free(rules->path);
    free(rules);
}

const char *rules_path(const Rules *rules) { return rules->path; }

static int count_of(const Rules *rules) { return rules == NULL ? 0 : rules->count; }

static bool matches(const Rule *rule, const char *name) { return fnmatch(rule->files, name, 0) == 0; }

static bool matches_any(const Rule *rule, const char *const *names, int count) {
    for (int i = 0; i < count; i++)
        if (matches(rule, names[i])) return true;
    return false;
}

bool rules_check_names(const Rules *rules, const char *const *names, int count, Error *error) {
    for (int i = 0; i < rules->count; i++)
        if (!matches_any(&rules->rules[i], names, count))
            return yaml_error(&rules->tree, rules->rules[i].node, error, "no picture has a name that matches '%s'",
                              yaml_show(&rules->tree, rules->rules[i].node).text);
    return true;
}

void rules_override(const Rules *rules, const char *name, Tolerance *tolerance) {
    for (int i = 0; i < count_of(rules); i++)
        if (matches(&rules->rules[i], name) && rules->rules[i].region.count == 0)
            tolerance_override(tolerance, &rules->rules[i].tolerance);
}

bool rules_have_regions(const Rules *rules, const char *name) {
    for (int i = 0; i < count_of(rules); i++)
        if (rules->rules[i].region.count > 0 && matches(&rules->rules[i], name)) return true;
    return false;
}

/* inside[height, width] is scratch. The region is judged alone: what is outside counts as masked. */
static bool mark_region(const Rule *rule, const Image *expected, const Image *actual, uint8_t *inside, uint8_t *masked,
                        Error *error) {
    const size_t count = (size_t)expected->width * (size_t)expected->height;
    memset(inside, IGNORED_NOT, count);
    if (!mask_draw(&rule->region, expected, "", inside, error)) return false;
    for (size_t i = 0; i < count; i++) inside[i] = inside[i] == IGNORED_MASK ? masked[i] : IGNORED_MASK;
    if (!tolerance_mark(&rule->tolerance, expected, actual, inside, error)) return false;
    level_mark(expected, actual, rule->tolerance.tolerance, inside);
    for (size_t i = 0; i < count; i++)
        if (inside[i] != IGNORED_MASK) masked[i] = inside[i];
    return true;
}

bool rules_mark_regions(const Rules *rules, const char *name, const Image *expected, const Image *actual,
                        uint8_t *masked, Error *error) {
    if (!rules_have_regions(rules, name)) return true;
    uint8_t *inside = malloc((size_t)expected->width * (size_t)expected->height);
    bool ok = inside != NULL || error_memory(error, name);
    for (int i = 0; ok && i < rules->count; i++)
        if (rules->rules[i].region.count > 0 && matches(&rules->rules[i], name))
            ok = mark_region(&rules->rules[i], expected, actual, inside, masked, error);
    free(inside);
    return ok;
}

bool rules_have_masks(const Rules *rules, const char *name) {
    for (int i = 0; i < count_of(rules); i++)
        if (rules->rules[i].mask.count > 0 && matches(&rules->rules[i], name)) return true;
    return false;
}

double rules_most_hidden(const Rules *rules, const char *name, int width, int height) {
    double hidden = 0;
    for (int i = 0; i < count_of(rules); i++)
        if (matches(&rules->rules[i], name)) hidden += mask_most_hidden(&rules->rules[i].mask, width, height);
    return hidden;
}

bool rules_draw_masks(const Rules *rules, const char *name, const Image *expected, const char *path, uint8_t *masked,
                      Error *error) {
    for (int i = 0; i < count_of(rules); i++) {
        const Rule *rule = &rules->rules[i];
        if (matches(rule, name) && !mask_draw(&rule->mask, expected, path, masked, error)) return false;
    }
    return true;
}

/* Reads a file of rules: a parser for each key. */

static const char *text_of(const YamlTree *tree, int node) {
    return tree->nodes[node].kind == YAML_SCALAR ? yaml_text(tree, node) : "";
}

static bool read_files(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    Rule *rule = member;
    rule->files = text_of(tree, node);
    rule->node = node;
    return rule->files[0] != '\0' ||
           yaml_error(tree, node, error, "%s must be a glob of names, such as \"stack_*\" (got %s)", field->key,
                      yaml_show(tree, node).text);
}

static bool read_whole(const YamlTree *tree, int node, const char *what, const char *unit, int most, int *number,
                       Error *error) {
    int64_t value;
    if (!parse_int(text_of(tree, node), 0, most, &value))
        return yaml_error(tree, node, error, "%s must be a whole number%s from 0 to %d (got %s)", what, unit, most,
                          yaml_show(tree, node).text);
    *number = (int)value;
    return true;
}

static bool read_pixel_limit(const YamlTree *tree, int node, const char *what, PixelLimit *limit, Error *error) {
    return pixel_limit_parse(limit, text_of(tree, node)) ||
           yaml_error(tree, node, error, "%s must be " PIXEL_LIMIT_FORM " (got %s)", what, yaml_show(tree, node).text);
}

static bool read_tolerance(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    Tolerance *tolerance = member;
    tolerance->given |= LIMIT_TOLERANCE;
    return read_whole(tree, node, field->key, "", 255, &tolerance->tolerance, error);
}

static bool read_fuzzy(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    Tolerance *tolerance = member;
    const YamlNode *list = &tree->nodes[node];
    if (list->kind != YAML_SEQUENCE || list->count != 2)
        return yaml_error(tree, node, error, "%s must be a list of two numbers, such as [2, 0.01] (got %s)", field->key,
                          list->kind == YAML_SEQUENCE ? "another number of them" : yaml_show(tree, node).text);
    tolerance->given |= LIMIT_FUZZY;
    return read_whole(tree, node + 1, field->key, "", 255, &tolerance->fuzzy, error) &&
           read_pixel_limit(tree, tree->nodes[node + 1].end, field->key, &tolerance->share, error);
}

static bool read_beyond(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    Tolerance *tolerance = member;
    tolerance->given |= LIMIT_BEYOND;
    return read_pixel_limit(tree, node, field->key, &tolerance->beyond, error);
}

static bool read_flip_limit(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    Tolerance *tolerance = member;
    const bool p99 = strcmp(field->key, "p99") == 0;
    double *limit = p99 ? &tolerance->flip_p99 : &tolerance->flip_mean;
    tolerance->given |= p99 ? LIMIT_FLIP_P99 : LIMIT_FLIP_MEAN;
    return (parse_double(text_of(tree, node), limit) && *limit >= 0 && *limit <= 1) ||
           yaml_error(tree, node, error, "%s must be from 0 to 1 (got %s)", field->key, yaml_show(tree, node).text);
}

static bool read_flip(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    static const Field fields[] = {{"mean", read_flip_limit, 0, NULL, false},
                                   {"p99", read_flip_limit, 0, NULL, false},
                                   {NULL, NULL, 0, NULL, false}};
    int nodes[FIELDS_MAX];
    if (tree->nodes[node].kind == YAML_MAPPING)
        return fields_read(tree, node, "a limit of FLIP", fields, member, nodes, error);
    return read_flip_limit(tree, node, field, member, error);
}

static bool read_antialias(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    Tolerance *tolerance = member;
    tolerance->given |= LIMIT_ANTIALIAS;
    return field_switch(tree, node, field, &tolerance->antialias, error);
}

/* shift, size */
static bool read_few(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    Tolerance *tolerance = member;
    const bool shift = strcmp(field->key, "shift") == 0;
    tolerance->given |= shift ? LIMIT_SHIFT : LIMIT_SIZE;
    return read_whole(tree, node, field->key, " of pixels", FEW_PIXELS_MAX,
                      shift ? &tolerance->shift : &tolerance->size, error);
}

static bool read_rectangle(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    const YamlNode *list = &tree->nodes[node];
    int numbers[4], item = node + 1;
    bool ok = list->kind == YAML_SEQUENCE && list->count == 4;
    for (int i = 0; ok && i < 4; i++) {
        int64_t value;
        ok = parse_int(text_of(tree, item), i < 2 ? -1000000 : 1, 1000000, &value);
        numbers[i] = (int)value;
        item = tree->nodes[item].end;
    }
    if (!ok)
        return yaml_error(tree, node, error,
                          "%s must be a list [X, Y, W, H] of whole numbers with W and H from 1 (got %s)", field->key,
                          list->kind == YAML_SEQUENCE ? "another list" : yaml_show(tree, node).text);
    return mask_add_rectangle(member, numbers[0], numbers[1], numbers[2], numbers[3], error);
}

/* A relative path begins at the folder of the rules. */
static bool read_picture(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    const char *name = text_of(tree, node), *rules = tree->source.path;
    char path[PATH_MAX];
    Error reason = {0};
    if (name[0] == '\0')
        return yaml_error(tree, node, error, "%s must be the path of a PNG file (got %s)", field->key,
                          yaml_show(tree, node).text);
    Rules *all = tree->context;
    if (all->pictures++ == RULES_MAX_PICTURES)
        return yaml_error(tree, node, error, "a file of rules must have at most %d pictures", RULES_MAX_PICTURES);
    int folder = name[0] == '/' ? 0 : (int)file_folder_length(rules);
    if (!file_path(path, sizeof path, error, "%.*s%s", folder, rules, name)) return false;
    if (mask_add_picture(member, path, &reason)) return true;
    if (reason.kind == ERROR_SYSTEM) return *error = reason, false;
    return yaml_error(tree, node, error, "%s", reason.message);
}

static bool parse_color(const char *text, uint8_t color[3]) {
    unsigned long value;
    char *end;
    if (text[0] != '#' || strlen(text) != 7 || strspn(text + 1, "0123456789abcdefABCDEF") != 6) return false;
    value = strtoul(text + 1, &end, 16);
    for (int i = 0; i < 3; i++) color[i] = (uint8_t)(value >> (16 - 8 * i));
    return true;
}

static bool read_color(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    uint8_t color[3];
    if (!parse_color(text_of(tree, node), color))
        return yaml_error(tree, node, error, "%s must be \"#rrggbb\", in quotes (got %s)", field->key,
                          yaml_show(tree, node).text);
    return mask_add_color(member, color, error);
}

static bool read_mask(const YamlTree *tree, int node, Mask *mask, Error *error) {
    static const Field fields[] = {{"rectangle", read_rectangle, 0, NULL, false},
                                   {"picture", read_picture, 0, NULL, false},
                                   {"colour", read_color, 0, NULL, false},
                                   {NULL, NULL, 0, NULL, false}};
    int nodes[FIELDS_MAX];
    if (mask->count == MASK_PARTS)
        return yaml_error(tree, node, error, "a rule must have at most %d masks", MASK_PARTS);
    if (tree->nodes[node].kind == YAML_MAPPING && tree->nodes[node].count != 1)
        return yaml_error(tree, node, error, "a mask must have one key: rectangle, picture or colour");
    return fields_read(tree, node, "a mask", fields, mask, nodes, error);
}

static bool read_masks(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    if (tree->nodes[node].kind != YAML_SEQUENCE)
        return yaml_error(tree, node, error, "%s must be a list (got %s)", field->key, yaml_show(tree, node).text);
    for (int item = node + 1; item < tree->nodes[node].end; item = tree->nodes[item].end)
        if (!read_mask(tree, item, member, error)) return false;
    return true;
}

static bool is_all(const PixelLimit *limit) { return !limit->number && limit->most >= 1; }

/* What would pass any picture is a mistake. */
static bool check_limits(const YamlTree *tree, int node, const Rule *rule, Error *error) {
    const Tolerance *limits = &rule->tolerance;
    const unsigned local = LIMIT_TOLERANCE | LIMIT_ANTIALIAS | LIMIT_SHIFT;
    if (limits->tolerance == 255 || is_all(&limits->beyond) || (limits->fuzzy == 255 && is_all(&limits->share)) ||
        limits->flip_mean >= 1 || limits->flip_p99 >= 1)
        return yaml_error(tree, node, error, "a limit of this rule ignores every difference");
    if (rule->region.count > 0 && (limits->given & ~local) != 0)
        return yaml_error(tree, node, error,
                          "a rule with a region must have no limits but tolerance, antialias and shift");
    if (rule->region.count > 0 && (limits->given == 0 || rule->mask.count > 0))
        return yaml_error(tree, node, error, "a rule with a region needs tolerance, antialias or shift, and no masks");
    return true;
}

static bool read_rule(const YamlTree *tree, int node, Rule *rule, Error *error) {
    enum { TOLERANCE = offsetof(Rule, tolerance) };
    static const Field fields[] = {{"files", read_files, 0, NULL, true},
                                   {"tolerance", read_tolerance, TOLERANCE, NULL, false},
                                   {"beyond", read_beyond, TOLERANCE, NULL, false},
                                   {"fuzzy", read_fuzzy, TOLERANCE, NULL, false},
                                   {"flip", read_flip, TOLERANCE, NULL, false},
                                   {"antialias", read_antialias, TOLERANCE, NULL, false},
                                   {"shift", read_few, TOLERANCE, NULL, false},
                                   {"size", read_few, TOLERANCE, NULL, false},
                                   {"region", read_rectangle, offsetof(Rule, region), NULL, false},
                                   {"masks", read_masks, offsetof(Rule, mask), NULL, false},
                                   {NULL, NULL, 0, NULL, false}};
    int nodes[FIELDS_MAX];
    if (!fields_read(tree, node, "a rule", fields, rule, nodes, error) || !check_limits(tree, node, rule, error))
        return false;
    return rule->tolerance.given != 0 || rule->mask.count > 0 ||
           yaml_error(tree, node, error, "a rule needs a limit or a mask");
}

static bool read_list(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    Rules *rules = member;
    const YamlNode *list = &tree->nodes[node];
    if (list->kind != YAML_SEQUENCE || list->count == 0)
        return yaml_error(tree, node, error, "%s must be a list of at least one rule (got %s)", field->key,
                          list->kind == YAML_SEQUENCE ? "none" : yaml_show(tree, node).text);
    if (list->count > RULES_MAX)
        return yaml_error(tree, node, error, "at most %d rules (got %d)", RULES_MAX, list->count);
    rules->rules = calloc((size_t)list->count, sizeof *rules->rules);
    if (rules->rules == NULL) return error_memory(error, tree->source.path);
    for (int item = node + 1; item < list->end; item = tree->nodes[item].end)
        if (!read_rule(tree, item, &rules->rules[rules->count++], error)) return false;
    return true;
}

static bool read_file(Rules *rules, const char *path, Error *error) {
    static const Field fields[] = {{"rules", read_list, 0, NULL, true}, {NULL, NULL, 0, NULL, false}};
    int nodes[FIELDS_MAX];
    rules->path = strdup(path);
    if (rules->path == NULL) return error_memory(error, path);
    if (!yaml_read(&rules->tree, rules->path, error)) return false;
    rules->tree.context = rules;
    return fields_read(&rules->tree, 0, "a file of rules", fields, rules, nodes, error);
}

Rules *rules_read(const char *path, Error *error) {
    Rules *rules = calloc(1, sizeof *rules);
    if (rules == NULL)
        error_memory(error, path);
    else if (read_file(rules, path, error))
        return rules;
    rules_destroy(rules);
    return NULL;
}
