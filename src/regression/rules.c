/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rules of a comparison: read from YAML, and found by name. */
#include "base/base.h"
#include "base/file.h"
#include "base/yaml.h"
#include "pixels/png.h"
#include "regression/limits.h"
#include "regression/mask.h"

#include <fnmatch.h>
#include <stdlib.h>
#include <string.h>

typedef struct Rule {
    const char *files; /* a text of the tree */
    int node;          /* of `files` */
    Tolerance tolerance;
    Mask mask;
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

static bool matches(const Rule *rule, const char *name) { return fnmatch(rule->files, name, 0) == 0; }

bool rules_check_names(const Rules *rules, const char *const *names, int count, Error *error) {
    for (int i = 0; i < rules->count; i++) {
        bool used = false;
        for (int k = 0; k < count && !used; k++) used = matches(&rules->rules[i], names[k]);
        if (!used)
            return yaml_error(&rules->tree, rules->rules[i].node, error, "no picture has a name that matches '%s'",
                              yaml_show(&rules->tree, rules->rules[i].node).text);
    }
    return true;
}

void rules_override(const Rules *rules, const char *name, Tolerance *tolerance) {
    for (int i = 0; rules != NULL && i < rules->count; i++)
        if (matches(&rules->rules[i], name)) tolerance_override(tolerance, &rules->rules[i].tolerance);
}

bool rules_have_masks(const Rules *rules, const char *name) {
    for (int i = 0; rules != NULL && i < rules->count; i++)
        if (rules->rules[i].mask.count > 0 && matches(&rules->rules[i], name)) return true;
    return false;
}

double rules_most_hidden(const Rules *rules, const char *name, int width, int height) {
    double hidden = 0;
    for (int i = 0; rules != NULL && i < rules->count; i++)
        if (matches(&rules->rules[i], name)) hidden += mask_most_hidden(&rules->rules[i].mask, width, height);
    return hidden;
}

bool rules_draw_masks(const Rules *rules, const char *name, const Image *expected, const char *path, uint8_t *masked,
                      Error *error) {
    for (int i = 0; rules != NULL && i < rules->count; i++) {
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

/* tolerance, beyond, antialias */
static bool read_limit(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    Tolerance *tolerance = member;
    const char *text = text_of(tree, node), *shown = yaml_show(tree, node).text;
    int64_t value;
    if (strcmp(field->key, "antialias") == 0) {
        tolerance->given |= LIMIT_ANTIALIAS;
        return field_switch(tree, node, field, &tolerance->antialias, error);
    }
    if (strcmp(field->key, "beyond") == 0) {
        tolerance->given |= LIMIT_BEYOND;
        return pixel_limit_parse(&tolerance->beyond, text) ||
               yaml_error(tree, node, error, "%s must be " PIXEL_LIMIT_FORM " (got %s)", field->key, shown);
    }
    tolerance->given |= LIMIT_TOLERANCE;
    if (!parse_int(text, 0, 255, &value))
        return yaml_error(tree, node, error, "%s must be a whole number from 0 to 255 (got %s)", field->key, shown);
    tolerance->tolerance = (int)value;
    return true;
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

static bool read_color(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    const char *text = text_of(tree, node);
    if (text[0] != '#' || strlen(text) != 7 || strspn(text + 1, "0123456789abcdefABCDEF") != 6)
        return yaml_error(tree, node, error, "%s must be \"#rrggbb\", in quotes (got %s)", field->key,
                          yaml_show(tree, node).text);
    const unsigned long value = strtoul(text + 1, NULL, 16);
    return mask_add_color(member, (uint8_t[]){(uint8_t)(value >> 16), (uint8_t)(value >> 8), (uint8_t)value}, error);
}

static bool read_masks(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    static const Field fields[] = {{"rectangle", read_rectangle, 0, NULL, false},
                                   {"picture", read_picture, 0, NULL, false},
                                   {"colour", read_color, 0, NULL, false},
                                   {NULL, NULL, 0, NULL, false}};
    Mask *mask = member;
    int nodes[FIELDS_MAX];
    if (tree->nodes[node].kind != YAML_SEQUENCE)
        return yaml_error(tree, node, error, "%s must be a list (got %s)", field->key, yaml_show(tree, node).text);
    for (int item = node + 1; item < tree->nodes[node].end; item = tree->nodes[item].end) {
        if (mask->count == MASK_PARTS)
            return yaml_error(tree, item, error, "a rule must have at most %d masks", MASK_PARTS);
        if (tree->nodes[item].kind == YAML_MAPPING && tree->nodes[item].count != 1)
            return yaml_error(tree, item, error, "a mask must have one key: rectangle, picture or colour");
        if (!fields_read(tree, item, "a mask", fields, mask, nodes, error)) return false;
    }
    return true;
}

static bool read_rule(const YamlTree *tree, int node, Rule *rule, Error *error) {
    enum { TOLERANCE = offsetof(Rule, tolerance) };
    static const Field fields[] = {{"files", read_files, 0, NULL, true},
                                   {"tolerance", read_limit, TOLERANCE, NULL, false},
                                   {"beyond", read_limit, TOLERANCE, NULL, false},
                                   {"antialias", read_limit, TOLERANCE, NULL, false},
                                   {"masks", read_masks, offsetof(Rule, mask), NULL, false},
                                   {NULL, NULL, 0, NULL, false}};
    int nodes[FIELDS_MAX];
    const Tolerance *limits = &rule->tolerance;
    if (!fields_read(tree, node, "a rule", fields, rule, nodes, error)) return false;
    /* What would pass any picture is a mistake. */
    if (limits->tolerance == 255 || (!limits->beyond.number && limits->beyond.most >= 1))
        return yaml_error(tree, node, error, "a limit of this rule ignores every difference");
    return limits->given != 0 || rule->mask.count > 0 ||
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

Rules *rules_read(const char *path, Error *error) {
    static const Field fields[] = {{"rules", read_list, 0, NULL, true}, {NULL, NULL, 0, NULL, false}};
    int nodes[FIELDS_MAX];
    Rules *rules = calloc(1, sizeof *rules);
    bool ok = (rules != NULL && (rules->path = strdup(path)) != NULL) || error_memory(error, path);
    ok = ok && yaml_read(&rules->tree, rules->path, error);
    if (ok) rules->tree.context = rules;
    if (ok && fields_read(&rules->tree, 0, "a file of rules", fields, rules, nodes, error)) return rules;
    rules_destroy(rules);
    return NULL;
}
