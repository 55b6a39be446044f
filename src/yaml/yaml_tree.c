/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Builds a YamlTree from libyaml's events. */
#include "yaml/yaml_tree.h"

#include "common/array.h"
#include "yaml/syntax_words.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <yaml.h>

typedef struct Builder {
    YamlTree *tree;
    size_t node_capacity, text_size, text_capacity;
    int depth, documents;
    int open[YAML_MAX_DEPTH]; /* open lists and mappings, outermost first */
    Place place;              /* of the last event that had one */
} Builder;

static bool fail(const Builder *builder, Error *error, const char *what) {
    return source_error(&builder->tree->source, builder->place, error, "%s", what);
}

/* Here a mapping counts keys and values; yaml_read() halves the count. */
static bool count_in_parent(Builder *builder, Error *error) {
    if (builder->depth == 0) return true;
    YamlNode *parent = &builder->tree->nodes[builder->open[builder->depth - 1]];
    parent->count++;
    if (parent->kind == YAML_MAPPING && parent->count > 2 * YAML_MAX_KEYS)
        return source_error(&builder->tree->source, builder->place, error, "a mapping must have at most %d keys",
                            YAML_MAX_KEYS);
    return true;
}

static bool add_node(Builder *builder, YamlKind kind, Error *error) {
    YamlTree *tree = builder->tree;
    if (tree->node_count == YAML_MAX_NODES)
        return source_error(&tree->source, builder->place, error, "more than %d values in one file", YAML_MAX_NODES);
    if (!count_in_parent(builder, error)) return false;
    void *nodes = tree->nodes;
    bool room = array_reserve(&nodes, &builder->node_capacity, (size_t)tree->node_count + 1, sizeof *tree->nodes);
    tree->nodes = nodes;
    if (!room) return error_memory(error, tree->source.path);
    YamlNode node = {kind, tree->node_count + 1, 0, (int)builder->text_size, builder->place};
    tree->nodes[tree->node_count++] = node;
    return true;
}

static bool add_scalar(Builder *builder, const void *text, size_t length, Error *error) {
    if (!add_node(builder, YAML_SCALAR, error)) return false;
    if (memchr(text, '\0', length) != NULL) return fail(builder, error, "a text must not contain the character \\0");
    void *texts = builder->tree->texts;
    bool room = array_reserve(&texts, &builder->text_capacity, builder->text_size + length + 1, 1);
    builder->tree->texts = texts;
    if (!room) return error_memory(error, builder->tree->source.path);
    memcpy(builder->tree->texts + builder->text_size, text, length);
    builder->text_size += length;
    builder->tree->texts[builder->text_size++] = '\0';
    return true;
}

static bool open_node(Builder *builder, YamlKind kind, Error *error) {
    if (builder->depth == YAML_MAX_DEPTH)
        return source_error(&builder->tree->source, builder->place, error,
                            "lists and mappings must be nested at most %d deep", YAML_MAX_DEPTH);
    if (!add_node(builder, kind, error)) return false;
    builder->open[builder->depth++] = builder->tree->node_count - 1;
    return true;
}

static void close_node(Builder *builder) {
    YamlNode *node = &builder->tree->nodes[builder->open[--builder->depth]];
    node->end = builder->tree->node_count;
    if (node->kind == YAML_MAPPING) node->count /= 2;
}

/* Aliases need an anchor before them, so without anchors there are no valid aliases. */
static bool refuse_extras(const Builder *builder, const void *anchor, const void *tag, Error *error) {
    if (anchor != NULL) return fail(builder, error, "anchors (&) are not allowed");
    return tag == NULL || fail(builder, error, "tags (!) are not allowed");
}

/* `dt:` without a value; `dt: ""` has one. */
static bool is_missing_value(const yaml_event_t *event) {
    return event->type == YAML_SCALAR_EVENT && event->data.scalar.style == YAML_PLAIN_SCALAR_STYLE &&
           event->data.scalar.length == 0;
}

static Place place_of(yaml_mark_t mark) { return (Place){(int)mark.line, (int)mark.column}; }

/* A text begins behind its quote. */
static Place place_of_event(const yaml_event_t *event) {
    Place place = place_of(event->start_mark);
    if (event->type != YAML_SCALAR_EVENT || event->data.scalar.anchor != NULL || event->data.scalar.tag != NULL)
        return place;
    const yaml_scalar_style_t style = event->data.scalar.style;
    place.column += style == YAML_SINGLE_QUOTED_SCALAR_STYLE || style == YAML_DOUBLE_QUOTED_SCALAR_STYLE;
    return place;
}

static bool take_event(Builder *builder, const yaml_event_t *event, Error *error) {
    /* A missing value is shown at its key. */
    if (!is_missing_value(event)) builder->place = place_of_event(event);
    switch (event->type) {
    case YAML_DOCUMENT_START_EVENT:
        return ++builder->documents == 1 || fail(builder, error, "a file must hold one document only");
    case YAML_MAPPING_START_EVENT:
        return refuse_extras(builder, event->data.mapping_start.anchor, event->data.mapping_start.tag, error) &&
               open_node(builder, YAML_MAPPING, error);
    case YAML_SEQUENCE_START_EVENT:
        return refuse_extras(builder, event->data.sequence_start.anchor, event->data.sequence_start.tag, error) &&
               open_node(builder, YAML_SEQUENCE, error);
    case YAML_MAPPING_END_EVENT:
    case YAML_SEQUENCE_END_EVENT: close_node(builder); return true;
    case YAML_SCALAR_EVENT:
        return refuse_extras(builder, event->data.scalar.anchor, event->data.scalar.tag, error) &&
               add_scalar(builder, event->data.scalar.value, event->data.scalar.length, error);
    case YAML_ALIAS_EVENT: return fail(builder, error, "aliases (*) are not allowed");
    default: return true;
    }
}

/* A text without end, or a key without colon, is shown where it begins. source.c has refused what libyaml's reader would. */
static bool syntax_error(const Builder *builder, const yaml_parser_t *parser, Error *error) {
    const Source *source = &builder->tree->source;
    if (parser->error == YAML_MEMORY_ERROR) return error_memory(error, source->path);
    const bool begun = parser->error == YAML_SCANNER_ERROR && parser->context != NULL;
    const yaml_mark_t mark = begun ? parser->context_mark : parser->problem_mark;
    const size_t at = source_offset(source, place_of(mark));
    return source_error(source, place_of(mark), error, "%s", syntax_words(parser->problem, source->text[at]));
}

static bool take_events(Builder *builder, yaml_parser_t *parser, Error *error) {
    for (bool more = true; more;) {
        yaml_event_t event;
        if (!yaml_parser_parse(parser, &event)) return syntax_error(builder, parser, error);
        more = event.type != YAML_STREAM_END_EVENT;
        const bool taken = take_event(builder, &event, error);
        yaml_event_delete(&event);
        if (!taken) return false;
    }
    return builder->tree->node_count > 0 ||
           source_error(&builder->tree->source, (Place){0, 0}, error, "the file is empty");
}

static bool build(YamlTree *tree, Error *error) {
    yaml_parser_t parser;
    if (!yaml_parser_initialize(&parser)) return error_memory(error, tree->source.path);
    Builder builder = {.tree = tree};
    yaml_parser_set_encoding(&parser, YAML_UTF8_ENCODING);
    yaml_parser_set_input_string(&parser, (const unsigned char *)tree->source.text, tree->source.size);
    const bool done = take_events(&builder, &parser, error);
    yaml_parser_delete(&parser);
    return done;
}

bool yaml_read(YamlTree *tree, const char *path, Error *error) {
    *tree = (YamlTree){.node_count = 0};
    if (!source_read(&tree->source, path, error)) return false;
    if (build(tree, error)) return true;
    yaml_tree_free(tree);
    return false;
}

void yaml_tree_free(YamlTree *tree) {
    source_free(&tree->source);
    free(tree->nodes);
    free(tree->texts);
    *tree = (YamlTree){.node_count = 0}; /* yaml_read() frees a tree that its owner may free again */
}

const char *yaml_text(const YamlTree *tree, int node) { return tree->texts + tree->nodes[node].text; }

YamlShown yaml_show(const YamlTree *tree, int node) {
    YamlShown shown;
    switch (tree->nodes[node].kind) {
    case YAML_SEQUENCE: strcpy(shown.text, "a list"); break;
    case YAML_MAPPING: strcpy(shown.text, "a mapping"); break;
    case YAML_SCALAR:
        source_printable(shown.text, sizeof shown.text, yaml_text(tree, node));
        if (shown.text[0] == '\0') strcpy(shown.text, "nothing");
        break;
    }
    return shown;
}

bool yaml_error(const YamlTree *tree, int node, Error *error, const char *format, ...) {
    char what[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    return source_error(&tree->source, tree->nodes[node].place, error, "%s", what);
}
