/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows, stacks and pyramids. Every position is computed in float32 from the first one and not from its
   neighbour, so that rounding does not add up. */
#include "base/base.h"
#include "base/yaml.h"
#include "engine/engine.h"
#include "scenes/internal.h"
#include "scenes/scenes.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

static int64_t line_body_count(int count) { return count; }

static Vec2 line_position(Vec2 first, Vec2 spacing, int count, int64_t i) {
    (void)count;
    return vec2(first.x + spacing.x * (float)i, first.y + spacing.y * (float)i);
}

static int64_t pyramid_body_count(int rows) { return (int64_t)rows * (rows + 1) / 2; }

/* Row by row from below, each from left to right; a row has one body less than the row below it and begins half a
   spacing further right. */
static Vec2 pyramid_position(Vec2 first, Vec2 spacing, int rows, int64_t i) {
    int row = 0;
    for (; i >= rows - row; row++) i -= rows - row;
    return vec2(first.x + 0.5f * spacing.x * (float)row + spacing.x * (float)i, first.y + spacing.y * (float)row);
}

static const PatternKind row = {"row", line_body_count, line_position};
static const PatternKind stack = {"stack", line_body_count, line_position};
static const PatternKind pyramid = {"pyramid", pyramid_body_count, pyramid_position};
const PatternKind *const pattern_kinds[] = {&row, &stack, &pyramid, NULL};

int64_t pattern_body_count(const Pattern *pattern) {
    return pattern->kind == NULL ? 1 : pattern->kind->body_count(pattern->count);
}

BodyDef pattern_body(const Pattern *pattern, int64_t i) {
    BodyDef body = pattern->first;
    if (pattern->kind != NULL)
        body.position = pattern->kind->position(body.position, pattern->spacing, pattern->count, i);
    return body;
}

/* The number being read, for messages. */
typedef struct Chain {
    const YamlTree *tree;
    int node;
    const char *what;
} Chain;

bool chain_is(const YamlTree *tree, int node) {
    return tree->nodes[node].kind == YAML_SCALAR && strpbrk(yaml_text(tree, node), "*/$") != NULL;
}

/* The parameter whose name begins the text, or NULL. */
static const SceneParameter *find(const Parameters *parameters, const char *text, size_t length) {
    for (int i = 0; i < parameters->count; i++) {
        const SceneParameter *parameter = &parameters->items[i];
        if (strlen(parameter->name) == length && memcmp(parameter->name, text, length) == 0) return parameter;
    }
    return NULL;
}

/* " with ratio = 10, size = 2": the parameters in the text. */
static void add_values(const Parameters *parameters, const char *text, char *out, size_t room) {
    bool named[SCENE_MAX_PARAMETERS] = {false};
    for (const char *name = text; (name = strchr(name, '$')) != NULL;) {
        size_t length = strspn(++name, PARAMETER_LETTERS);
        const SceneParameter *parameter = find(parameters, name, length);
        if (parameter != NULL) named[parameter - parameters->items] = true;
    }
    const char *link = " with ";
    for (int i = 0; i < parameters->count; i++) {
        if (!named[i]) continue;
        size_t used = strlen(out);
        snprintf(out + used, room - used, "%s%s = %.9g", link, parameters->items[i].name, parameters->items[i].value);
        link = ", ";
    }
}

/* The text, and the values of its names. */
static ChainShown show_text(const YamlTree *tree, int node) {
    ChainShown shown;
    snprintf(shown.text, sizeof shown.text, "%s", yaml_show(tree, node).text);
    if (tree->nodes[node].kind == YAML_SCALAR && tree->context != NULL)
        add_values(tree->context, yaml_text(tree, node), shown.text, sizeof shown.text);
    return shown;
}

ChainShown chain_show(const YamlTree *tree, int node, double value) {
    ChainShown text = show_text(tree, node), shown = text;
    if (chain_is(tree, node)) snprintf(shown.text, sizeof shown.text, "%.9g, from %.290s", value, text.text);
    return shown;
}

static bool malformed(const Chain *chain, Error *error) {
    const YamlTree *tree = chain->tree;
    return yaml_error(tree, chain->node, error, "%s must be a number%s (got %s)", chain->what,
                      chain_is(tree, chain->node) ? " or a chain of numbers and parameters such as 2*$name/3" : "",
                      yaml_show(tree, chain->node).text);
}

/* The value of the name that begins the text, without its '$'. */
static bool take_name(const Chain *chain, const char *text, double *value, const char **rest, Error *error) {
    Parameters *parameters = chain->tree->context;
    size_t length = strspn(text, PARAMETER_LETTERS);
    if (length == 0)
        return yaml_error(chain->tree, chain->node, error, "%s: a parameter's name must follow the '$' (got %s)",
                          chain->what, yaml_show(chain->tree, chain->node).text);
    if (parameters == NULL)
        return yaml_error(chain->tree, chain->node, error, "%s must not contain parameters (got %s)", chain->what,
                          yaml_show(chain->tree, chain->node).text);
    const SceneParameter *parameter = find(parameters, text, length);
    if (parameter == NULL) {
        char name[SCENE_PARAMETER_SIZE];
        snprintf(name, sizeof name, "%.*s", (int)(length < sizeof name ? length : sizeof name), text);
        return yaml_error(chain->tree, chain->node, error, "%s: '$%s' is not a parameter; %s", chain->what, name,
                          parameters_hint(parameters, name).text);
    }
    parameters->used[parameter - parameters->items] = true;
    *value = parameter->value;
    *rest = text + length;
    return true;
}

static bool take_number(const Chain *chain, const char *text, double *value, const char **rest, Error *error) {
    if (*text == '$') return take_name(chain, text + 1, value, rest, error);
    return parse_leading_double(text, value, rest) || malformed(chain, error);
}

/* Multiplies or divides the value by a number. */
static bool apply(const Chain *chain, char operation, double number, double *value, Error *error) {
    if (operation == '/' && number == 0)
        return yaml_error(chain->tree, chain->node, error, "%s is divided by 0 (got %s)", chain->what,
                          show_text(chain->tree, chain->node).text);
    *value = operation == '/' ? *value / number : *value * number;
    return isfinite(*value) ||
           yaml_error(chain->tree, chain->node, error, "%s has an intermediate result that is infinite (got %s)",
                      chain->what, show_text(chain->tree, chain->node).text);
}

bool chain_read(const YamlTree *tree, int node, const char *what, double *value, Error *error) {
    const Chain chain = {tree, node, what};
    if (tree->nodes[node].kind != YAML_SCALAR) return malformed(&chain, error);
    const char *rest = yaml_text(tree, node);
    char operation = '*';
    *value = 1;
    for (int count = 1;; count++) {
        double number = 0;
        if (!take_number(&chain, rest, &number, &rest, error) || !apply(&chain, operation, number, value, error))
            return false;
        if (*rest == '\0') return true;
        operation = *rest++;
        if (operation != '*' && operation != '/') return malformed(&chain, error);
        if (count == CHAIN_MAX_NUMBERS)
            return yaml_error(tree, node, error, "%s: a chain must have at most %d numbers (got %s)", what,
                              CHAIN_MAX_NUMBERS, yaml_show(tree, node).text);
    }
}
