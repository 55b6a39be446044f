/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers of scenes: expressions with parameters, and their values from outside. */
#include "base/base.h"
#include "base/yaml.h"
#include "scenes/scenes_internal.h"
#include "scenes/scenes.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* What every scene has, and messages on names that are unknown. */

enum { ITERATIONS, DT, FRICTION, BOMB_X, BOMB_Y, BOMB_MASS, BOMB_SPEED, COMMON };

static const struct {
    const char *name, *unit;
    double least, most;
} common[COMMON] = {[ITERATIONS] = {"iterations", "", 1, SCENE_MAX_ITERATIONS},
                    [DT] = {"dt", "s", (double)SCENE_MIN_DT, (double)SCENE_MAX_DT},
                    [FRICTION] = {"friction", "", 0, 10},
                    [BOMB_X] = {"bomb_x", "m", -(double)SCENE_MAX_POSITION, (double)SCENE_MAX_POSITION},
                    [BOMB_Y] = {"bomb_y", "m", -(double)SCENE_MAX_POSITION, (double)SCENE_MAX_POSITION},
                    [BOMB_MASS] = {"bomb_mass", "kg", 1e-6, 1e9},
                    [BOMB_SPEED] = {"bomb_speed", "m/s", 0, 1e4}};

/* The end of a message on an unknown name: "did you mean 'height'?", "known: height, rate" or "known: none". */
typedef struct ParametersHint {
    char text[SCENE_MAX_PARAMETERS * (SCENE_PARAMETER_SIZE + 2) + 96]; /* and of what every scene has */
} ParametersHint;

/* settable: the name is of a setting, which may also be one that every scene has. */
static ParametersHint make_hint(const Parameters *parameters, const char *name, bool settable) {
    ParametersHint hint;
    NameList known = {0};
    const char *names[SCENE_MAX_PARAMETERS + COMMON];
    int count = 0;
    for (int i = 0; i < parameters->count; i++) names[count++] = parameters->items[i].name;
    for (int i = 0; settable && i < COMMON; i++) names[count++] = common[i].name;
    const char *nearest = nearest_word(name, names, count);
    if (nearest != NULL) {
        snprintf(hint.text, sizeof hint.text, "did you mean '%s'?", nearest);
        return hint;
    }
    for (int i = 0; i < count; i++) name_list_add(&known, names[i]);
    snprintf(hint.text, sizeof hint.text, "known: %.*s", (int)sizeof hint.text - 8,
             known.used > 0 ? known.text : "none");
    return hint;
}

/* Expressions: numbers made of numbers and parameters. */

/* What is read, and how far. */
typedef struct Expression {
    const YamlTree *tree;
    int node;
    const char *what, *text, *at;
    int parts; /* numbers, signs and parentheses so far */
    Error *error;
} Expression;

bool expression_is(const YamlTree *tree, int node) {
    const char *text = tree->nodes[node].kind == YAML_SCALAR ? yaml_text(tree, node) : "", *rest = "";
    double number;
    return strpbrk(text, "$+-*/()") != NULL && !(parse_leading_double(text, &number, &rest) && *rest == '\0');
}

/* The parameter with this name, or NULL. */
static SceneParameter *parameters_find(Parameters *parameters, const char *text, size_t length) {
    for (int i = 0; i < parameters->count; i++) {
        SceneParameter *parameter = &parameters->items[i];
        if (strlen(parameter->name) == length && memcmp(parameter->name, text, length) == 0) return parameter;
    }
    return NULL;
}

/* " with height = 10 boxes, size = 2": the parameters in the text. */
static void add_values(Parameters *parameters, const char *text, char *out, size_t room) {
    bool named[SCENE_MAX_PARAMETERS] = {false};
    for (const char *name = text; (name = strchr(name, '$')) != NULL;) {
        size_t length = strspn(++name, PARAMETER_LETTERS);
        const SceneParameter *parameter = parameters_find(parameters, name, length);
        if (parameter != NULL) named[parameter - parameters->items] = true;
    }
    const char *link = " with ";
    for (int i = 0; i < parameters->count; i++) {
        const SceneParameter *parameter = &parameters->items[i];
        if (!named[i]) continue;
        text_add(out, room, "%s%s = %.9g%s%s", link, parameter->name, parameter->value,
                 parameter->unit[0] != '\0' ? " " : "", parameter->unit);
        link = ", ";
    }
}

/* The text, and the values of its names. */
static ExpressionShown show_text(const YamlTree *tree, int node) {
    ExpressionShown shown;
    snprintf(shown.text, sizeof shown.text, "%s", yaml_show(tree, node).text);
    if (tree->nodes[node].kind == YAML_SCALAR && tree->context != NULL)
        add_values(tree->context, yaml_text(tree, node), shown.text, sizeof shown.text);
    return shown;
}

ExpressionShown expression_show(const YamlTree *tree, int node, double value, const char *unit) {
    ExpressionShown text = show_text(tree, node), shown = text;
    if (expression_is(tree, node))
        snprintf(shown.text, sizeof shown.text, "%.9g%s, from %.290s", value, unit, text.text);
    return shown;
}

/* Errors are where the reading is, or at a place that it has passed. */
static bool fail(const Expression *e, const char *at, const char *text) {
    return yaml_error_at(e->tree, e->node, (size_t)(at - e->text), e->error, "%s%s (got %s)", e->what, text,
                         show_text(e->tree, e->node).text);
}

/* The value of the name at the '$'. */
static bool take_name(Expression *e, double *value) {
    Parameters *parameters = e->tree->context;
    const size_t length = strspn(e->at + 1, PARAMETER_LETTERS);
    if (length == 0) return fail(e, e->at, ": a parameter's name must follow the '$'");
    if (parameters == NULL) return fail(e, e->at, " must not contain parameters");
    const SceneParameter *parameter = parameters_find(parameters, e->at + 1, length);
    if (parameter == NULL) {
        char name[SCENE_PARAMETER_SIZE];
        snprintf(name, sizeof name, "%.*s", (int)(length < sizeof name ? length : sizeof name), e->at + 1);
        return yaml_error_at(e->tree, e->node, (size_t)(e->at - e->text), e->error, "%s: '$%s' is not a parameter; %s",
                             e->what, name, make_hint(parameters, name, false).text);
    }
    parameters->used[parameter - parameters->items] = true;
    *value = parameter->value;
    e->at += length + 1;
    return true;
}

static bool take_sum(Expression *e, double *value);

/* A number, a name, a sum in parentheses, or one of these behind a sign. */
static bool take_operand(Expression *e, double *value) {
    e->at += strspn(e->at, " ");
    if (e->parts++ == EXPRESSION_MAX_PARTS)
        return fail(e, e->at, ": an expression has too many numbers, signs and parentheses");
    if (parse_leading_double(e->at, value, &e->at)) return true;
    if (*e->at == '$') return take_name(e, value);
    if (*e->at == '-') {
        e->at++;
        if (!take_operand(e, value)) return false;
        *value = -*value;
        return true;
    }
    if (*e->at != '(') return fail(e, e->at, ": a number, a $name or '(' is expected here");
    e->at++;
    if (!take_sum(e, value)) return false;
    return *e->at++ == ')' || fail(e, e->at - 1, ": an operator or ')' is expected here");
}

/* Operands with these operators between them, from left to right. Blanks behind them are taken, too. */
static bool take_chain(Expression *e, bool take(Expression *e, double *value), const char *operators, double *value) {
    if (!take(e, value)) return false;
    for (e->at += strspn(e->at, " "); *e->at != '\0' && strchr(operators, *e->at) != NULL;
         e->at += strspn(e->at, " ")) {
        const char *sign = e->at++;
        double number = 0;
        if (!take(e, &number)) return false;
        if (*sign == '/' && number == 0) return fail(e, sign, " is divided by 0");
        *value = *sign == '+'   ? *value + number
                 : *sign == '-' ? *value - number
                 : *sign == '*' ? *value * number
                                : *value / number;
        if (!isfinite(*value)) return fail(e, sign, " has an intermediate result that is infinite");
    }
    return true;
}

static bool take_product(Expression *e, double *value) { return take_chain(e, take_operand, "*/", value); }

static bool take_sum(Expression *e, double *value) { return take_chain(e, take_product, "+-", value); }

bool expression_read(const YamlTree *tree, int node, const char *what, double *value, Error *error) {
    const char *text = tree->nodes[node].kind == YAML_SCALAR ? yaml_text(tree, node) : "";
    Expression e = {tree, node, what, text, text, 0, error};
    if (!expression_is(tree, node) && !(parse_leading_double(text, value, &e.at) && *e.at == '\0'))
        return fail(&e, text, " must be a number");
    e.at = text;
    return take_sum(&e, value) && (*e.at == '\0' || fail(&e, e.at, ": an operator or the end is expected here"));
}

/* The key `parameters` of a scene. */

static bool field_bound(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    return expression_read(tree, node, field->key, member, error);
}

/* The longest text that source_printable() never cuts. */
enum { UNIT_LENGTH = SCENE_PARAMETER_SIZE - 8 };

static bool field_unit(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    const char *text = tree->nodes[node].kind == YAML_SCALAR ? yaml_text(tree, node) : "";
    if (text[0] == '\0' || strlen(text) > UNIT_LENGTH)
        return yaml_error(tree, node, error, "%s must be a text of at most %d bytes (got %s)", field->key, UNIT_LENGTH,
                          yaml_show(tree, node).text);
    source_printable(member, SCENE_PARAMETER_SIZE, text);
    return true;
}

enum { VALUE, FROM, TO };

static const Field fields[] = {[VALUE] = {"value", field_bound, offsetof(SceneParameter, value), NULL, true},
                               [FROM] = {"from", field_bound, offsetof(SceneParameter, from), NULL, true},
                               [TO] = {"to", field_bound, offsetof(SceneParameter, to), NULL, true},
                               {"unit", field_unit, offsetof(SceneParameter, unit), NULL, false},
                               {"whole", field_switch, offsetof(SceneParameter, whole), NULL, false},
                               {NULL, NULL, 0, NULL, false}};

static bool is_whole(double value) { return value == floor(value); }

static bool read_one(Parameters *parameters, const YamlTree *tree, int key, int value, Error *error) {
    const char *name = tree->nodes[key].kind == YAML_SCALAR ? yaml_text(tree, key) : "";
    const size_t length = strspn(name, PARAMETER_LETTERS);
    SceneParameter parameter = {.whole = false};
    int nodes[FIELDS_MAX];
    if (parameters->count == SCENE_MAX_PARAMETERS)
        return yaml_error(tree, key, error, "a scene must have at most %d parameters", SCENE_MAX_PARAMETERS);
    if (length == 0 || name[length] != '\0' || length >= SCENE_PARAMETER_SIZE)
        return yaml_error(tree, key, error,
                          "a parameter's name must have 1 to %d characters of a-z, 0-9 and _ (got %s)",
                          SCENE_PARAMETER_SIZE - 1, yaml_show(tree, key).text);
    memcpy(parameter.name, name, length + 1);
    if (parameters_find(parameters, name, length) != NULL)
        return yaml_error(tree, key, error, "key '%s' is given twice", name);
    if (!fields_read(tree, value, "a parameter", fields, &parameter, nodes, error)) return false;
    const double numbers[] = {parameter.value, parameter.from, parameter.to};
    for (int i = VALUE; i <= TO; i++)
        if (parameter.whole && !is_whole(numbers[i]))
            return yaml_error(tree, nodes[i], error, "%s must be a whole number, because whole is on (got %s)",
                              fields[i].key, expression_show(tree, nodes[i], numbers[i], "").text);
    if (!(parameter.value >= parameter.from && parameter.value <= parameter.to))
        return yaml_error(tree, nodes[VALUE], error, "value must be from %.9g to %.9g (got %s)", parameter.from,
                          parameter.to, expression_show(tree, nodes[VALUE], parameter.value, "").text);
    parameters->nodes[parameters->count] = key;
    parameters->items[parameters->count++] = parameter;
    return true;
}

bool parameters_read(Parameters *parameters, const YamlTree *tree, Error *error) {
    *parameters = (Parameters){.count = 0};
    int node = 0; /* of the value; the scene's table refuses a second key */
    for (int key = 1; node == 0 && tree->nodes[0].kind == YAML_MAPPING && key < tree->nodes[0].end;) {
        const int value = tree->nodes[key].end;
        if (tree->nodes[key].kind == YAML_SCALAR && strcmp(yaml_text(tree, key), "parameters") == 0) node = value;
        key = tree->nodes[value].end;
    }
    if (node == 0) return true;
    if (tree->nodes[node].kind != YAML_MAPPING)
        return yaml_error(tree, node, error, "parameters must be a mapping of names to values (got %s)",
                          yaml_show(tree, node).text);
    for (int key = node + 1; key < tree->nodes[node].end;) {
        int value = tree->nodes[key].end;
        if (!read_one(parameters, tree, key, value, error)) return false;
        key = tree->nodes[value].end;
    }
    return true;
}

/* COMMON: none. */
static int find_common(const char *name) {
    int which = 0;
    while (which < COMMON && strcmp(common[which].name, name) != 0) which++;
    return which;
}

static double bomb_speed(const Scene *scene) { return vec2_distance(scene_bomb_body(scene).velocity, vec2(0, 0)); }

/* The parameter of the file with this name, or NULL. */
static const SceneParameter *find_own(const Scene *scene, const char *name) {
    for (int i = 0; i < scene->parameter_count; i++)
        if (strcmp(scene->parameters[i].name, name) == 0) return &scene->parameters[i];
    return NULL;
}

const char *scene_parameter_unit(const Scene *scene, const char *name) {
    const SceneParameter *own = find_own(scene, name);
    const int which = find_common(name);
    return own != NULL ? own->unit : which < COMMON ? common[which].unit : "";
}

/* The steps, when a step takes `ratio` times as long. */
static int steps_of_time(int steps, double ratio) {
    const double count = round(steps / ratio);
    return count > SCENE_MAX_FRAMES ? SCENE_MAX_FRAMES : (int)count;
}

static void change(Scene *scene, int which, double value) {
    const double ratio = value / (double)scene->dt; /* of dt */
    const float faster = which == BOMB_SPEED ? (float)(value / bomb_speed(scene)) : 1;
    switch (which) {
    case ITERATIONS: scene->iterations = (int)value; break;
    case DT:
        scene->dt = (float)value;
        scene->frames = steps_of_time(scene->frames, ratio);
        if (scene->frames == 0) scene->frames = 1;
        scene->bomb.frame = steps_of_time(scene->bomb.frame, ratio);
        scene->last_body_until = steps_of_time(scene->last_body_until, ratio);
        break;
    case FRICTION:
        for (int i = 0; i < scene->body_count; i++) scene->bodies[i].friction = (float)value;
        scene->bomb.friction = (float)value;
        break;
    case BOMB_X: scene->bomb.x.value = (float)value; break;
    case BOMB_Y: scene->bomb.y = (float)value; break;
    case BOMB_MASS: scene->bomb.mass.value = (float)value; break;
    default: scene->bomb.velocity_factor *= faster; scene->bomb.velocity = vec2_scale(faster, scene->bomb.velocity);
    }
}

static bool set_common(Scene *scene, const char *path, int which, double value, Error *error) {
    const char *name = common[which].name, *unit = common[which].unit;
    if (which >= BOMB_X && !scene->bomb.present)
        return error_input(error, path, "%s cannot be set: the scene has no bomb", name);
    if (which == BOMB_SPEED && bomb_speed(scene) == 0)
        return error_input(error, path, "%s cannot be set: the bomb is at rest, so it has no direction", name);
    if (!(value >= common[which].least && value <= common[which].most) || (which == ITERATIONS && !is_whole(value)))
        return error_input(error, path, "%s must be a %s from %.9g to %.9g%s%s (set to %.9g)", name,
                           which == ITERATIONS ? "whole number" : "number", common[which].least, common[which].most,
                           unit[0] != '\0' ? " " : "", unit, value);
    change(scene, which, value);
    return !scene->bomb.present || bomb_speed(scene) <= common[BOMB_SPEED].most ||
           error_input(error, path, "with %s = %.9g the bomb starts at %.9g m/s; at most %.9g are allowed", name, value,
                       bomb_speed(scene), common[BOMB_SPEED].most);
}

bool common_set(Scene *scene, const char *path, const SceneSetting *settings, int count, Error *error) {
    for (int i = 0; i < count; i++) {
        const int which = find_own(scene, settings[i].name) == NULL ? find_common(settings[i].name) : COMMON;
        if (which < COMMON && !set_common(scene, path, which, settings[i].value, error)) return false;
    }
    return true;
}

SceneParameters scene_parameters(const Scene *scene) {
    const SceneSpan *x = &scene->bomb.x;
    SceneParameters all = {.count = scene->parameter_count};
    memcpy(all.items, scene->parameters, sizeof scene->parameters);
    for (int which = 0; which < (scene->bomb.present ? COMMON : BOMB_X); which++) {
        const double values[COMMON] = {[ITERATIONS] = scene->iterations,
                                       [DT] = (double)scene->dt,
                                       [FRICTION] = (double)scene->bodies[scene->body_count - 1].friction,
                                       [BOMB_X] = (double)scene->bomb.x.value,
                                       [BOMB_Y] = (double)scene->bomb.y,
                                       [BOMB_MASS] = (double)scene->bomb.mass.value,
                                       [BOMB_SPEED] = scene->bomb.present ? bomb_speed(scene) : 0};
        const double value = values[which];
        const double ranges[COMMON][2] = {[ITERATIONS] = {1, value < 20 ? 40 : 2 * value},
                                          [DT] = {value / 4, value * 4},
                                          [FRICTION] = {0, 1},
                                          [BOMB_X] = {value - 5, value + 5},
                                          [BOMB_Y] = {value - 5, value + 5},
                                          [BOMB_MASS] = {value / 10, value * 10},
                                          [BOMB_SPEED] = {0, 3 * value}};
        SceneParameter *parameter = &all.items[all.count++];
        *parameter = (SceneParameter){.value = value,
                                      .from = ranges[which][0],
                                      .to = ranges[which][1],
                                      .whole = which == ITERATIONS,
                                      .common = true};
        strcpy(parameter->name, common[which].name);
        strcpy(parameter->unit, common[which].unit);
        if (which == BOMB_X && scene_span_varies(x)) parameter->from = (double)x->from, parameter->to = (double)x->to;
    }
    return all;
}

const SceneParameter *scene_parameter(const SceneParameters *all, const char *name) {
    for (int i = 0; i < all->count; i++)
        if (strcmp(all->items[i].name, name) == 0) return &all->items[i];
    return NULL;
}

static bool set_parameters(Parameters *parameters, const char *path, const SceneSetting *setting, Error *error) {
    SceneParameter *parameter = parameters_find(parameters, setting->name, strlen(setting->name));
    if (parameter == NULL && find_common(setting->name) < COMMON) return true;
    if (parameter == NULL)
        return error_input(error, path, "'%s' is not a parameter; %s", setting->name,
                           make_hint(parameters, setting->name, true).text);
    if (!(setting->value >= parameter->from && setting->value <= parameter->to))
        return error_input(error, path, "%s must be from %.9g to %.9g%s%s (set to %.9g)", parameter->name,
                           parameter->from, parameter->to, parameter->unit[0] != '\0' ? " " : "", parameter->unit,
                           setting->value);
    if (parameter->whole && !is_whole(setting->value))
        return error_input(error, path, "%s must be a whole number (set to %.9g)", parameter->name, setting->value);
    parameter->value = setting->value;
    return true;
}

bool parameters_set(Parameters *parameters, const char *path, const SceneSetting *settings, int count, Error *error) {
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < i; k++)
            if (strcmp(settings[i].name, settings[k].name) == 0)
                return error_input(error, path, "the parameter '%s' is set twice", settings[i].name);
        if (!set_parameters(parameters, path, &settings[i], error)) return false;
    }
    return true;
}

bool scene_settings_add(SceneSettings *settings, const char *text) {
    if (settings->count == SCENE_SETTINGS_MAX) return true;
    SceneSetting *setting = &settings->items[settings->count];
    const char *number = strchr(text, '=');
    const size_t length = number == NULL ? 0 : (size_t)(number - text);
    if (length == 0 || length >= sizeof setting->name || !parse_double(number + 1, &setting->value)) return false;
    memcpy(setting->name, text, length);
    setting->name[length] = '\0';
    settings->count++;
    return true;
}

bool parameters_all_used(const Parameters *parameters, const YamlTree *tree, Error *error) {
    for (int i = 0; i < parameters->count; i++)
        if (!parameters->used[i])
            return yaml_error(tree, parameters->nodes[i], error, "no number of the scene uses the parameter '$%s'",
                              parameters->items[i].name);
    return true;
}
