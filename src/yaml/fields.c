/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads mappings by tables of keys, and values of types that need no other room. */
#include "yaml/fields.h"

#include "common/names.h"
#include "common/parse.h"
#include "common/nearest.h"

#include <string.h>

/* The known key that is nearest to a mistyped one, or NULL. */
static const char *nearest_key(const Field *fields, const char *key) {
    const char *keys[FIELDS_MAX];
    int count = 0;
    for (const Field *field = fields; field->key != NULL; field++) keys[count++] = field->key;
    return nearest_word(key, keys, count);
}

static bool unknown_key(const YamlTree *tree, int node, const char *what, const Field *fields, Error *error) {
    YamlShown shown = yaml_show(tree, node);
    const char *nearest = nearest_key(fields, yaml_text(tree, node));
    if (nearest != NULL)
        return yaml_error(tree, node, error, "'%s' is not a key of %s; did you mean '%s'?", shown.text, what, nearest);
    NameList known = {0};
    for (const Field *field = fields; field->key != NULL; field++) name_list_add(&known, field->key);
    return yaml_error(tree, node, error, "'%s' is not a key of %s; known: %s", shown.text, what, known.text);
}

static const Field *find_field(const Field *fields, const char *key) {
    while (fields->key != NULL && strcmp(fields->key, key) != 0) fields++;
    return fields->key == NULL ? NULL : fields;
}

int fields_node(const Field *fields, const int nodes[FIELDS_MAX], const char *key) {
    return nodes[find_field(fields, key) - fields];
}

static bool all_there(const YamlTree *tree, int node, const char *what, const Field *fields, const int *nodes,
                      Error *error) {
    for (int i = 0; fields[i].key != NULL; i++)
        if (fields[i].required && nodes[i] == 0)
            return yaml_error(tree, node, error, "%s needs the key '%s'", what, fields[i].key);
    return true;
}

bool fields_read(const YamlTree *tree, int node, const char *what, const Field *fields, void *target,
                 int nodes[FIELDS_MAX], Error *error) {
    memset(nodes, 0, FIELDS_MAX * sizeof *nodes);
    if (tree->nodes[node].kind != YAML_MAPPING)
        return yaml_error(tree, node, error, "%s must be a mapping of keys to values (got %s)", what,
                          yaml_show(tree, node).text);
    for (int key = node + 1; key < tree->nodes[node].end;) {
        if (tree->nodes[key].kind != YAML_SCALAR || yaml_text(tree, key)[0] == '\0')
            return yaml_error(tree, key, error, "a key must be a word");
        int value = key + 1;
        const Field *field = find_field(fields, yaml_text(tree, key));
        if (field == NULL) return unknown_key(tree, key, what, fields, error);
        if (nodes[field - fields] != 0) return yaml_error(tree, key, error, "key '%s' is given twice", field->key);
        nodes[field - fields] = value;
        if (!field->parse(tree, value, field, (char *)target + field->offset, error)) return false;
        key = tree->nodes[value].end;
    }
    return all_there(tree, node, what, fields, nodes, error);
}

bool field_switch(const YamlTree *tree, int node, const Field *field, void *member, Error *error) {
    static const char *const words[] = {"false", "true", "off", "on", "no", "yes"};
    for (size_t i = 0; tree->nodes[node].kind == YAML_SCALAR && i < sizeof words / sizeof *words; i++) {
        if (strcmp(yaml_text(tree, node), words[i]) != 0) continue;
        *(bool *)member = i % 2 == 1;
        return true;
    }
    return yaml_error(tree, node, error, "%s must be on or off (got %s)", field->key, yaml_show(tree, node).text);
}
