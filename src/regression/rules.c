/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "regression/rules.h"

#include "image/mask_cover.h"
#include "regression/rule.h"

#include <fnmatch.h>
#include <stdlib.h>

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
    for (int i = 0; i < rules->count; i++)
        if (matches(&rules->rules[i], name)) tolerance_override(tolerance, &rules->rules[i].tolerance);
}

bool rules_have_masks(const Rules *rules, const char *name) {
    for (int i = 0; i < rules->count; i++)
        if (rules->rules[i].mask.count > 0 && matches(&rules->rules[i], name)) return true;
    return false;
}

double rules_most_hidden(const Rules *rules, const char *name, int width, int height) {
    double hidden = 0;
    for (int i = 0; i < rules->count; i++)
        if (matches(&rules->rules[i], name)) hidden += mask_most_hidden(&rules->rules[i].mask, width, height);
    return hidden;
}

bool rules_draw_masks(const Rules *rules, const char *name, const Image *expected, const char *path, uint8_t *masked,
                      Error *error) {
    for (int i = 0; i < rules->count; i++) {
        const Rule *rule = &rules->rules[i];
        if (matches(rule, name) && !mask_draw(&rule->mask, expected, path, masked, error)) return false;
    }
    return true;
}
