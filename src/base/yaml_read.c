/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads YAML files with libyaml: their text, which is checked first, then their tree. */
#include "base/base.h"
#include "base/file.h"
#include "base/yaml.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <yaml.h>

/* Checks of the text before it is parsed. */

/* Refuses also what libyaml refuses without a place, and what it takes for the end of a line but editors do not. */
static bool check_text(const Source *source, Error *error) {
    Place place = {0, 0};
    for (size_t at = 0, length; at < source->size; at += length) {
        const char *text = source->text + at;
        uint32_t c;
        length = utf8_decode(text, source->size - at, &c);
        if (length == 0) return source_error(source, place, error, "not UTF-8 text");
        if (*text == '\n' || *text == '\r') {
            const bool inside_pair = *text == '\r' && text[1] == '\n';
            place = (Place){place.line + !inside_pair, 0};
            continue;
        }
        if ((c < 0x20 && c != '\t') || c == 0x7f)
            return source_error(source, place, error, "control character 0x%02x", (unsigned)c);
        if ((c >= 0x80 && c < 0xa0) || c == 0x2028 || c == 0x2029 || c == 0xfeff || c == 0xfffe || c == 0xffff)
            return source_error(source, place, error, "the character U+%04X is not allowed", (unsigned)c);
        if (place.column == 0 && c == '%') return source_error(source, place, error, "YAML directives are not allowed");
        place.column++;
    }
    return true;
}

/* Reads a file of UTF-8 text: no control characters but tab and line end, no YAML directive (a line that begins with
   '%'). A byte order mark is dropped. On failure there is nothing to free. */
static bool source_read(Source *source, const char *path, Error *error) {
    static const char byte_order_mark[] = "\xef\xbb\xbf";
    *source = (Source){.path = path};
    source->text = file_read(path, SOURCE_MAX_SIZE, &source->size, error);
    if (source->text == NULL) return false;
    if (source->size >= 3 && memcmp(source->text, byte_order_mark, 3) == 0) {
        source->size -= 3;
        memmove(source->text, source->text + 3, source->size + 1);
    }
    if (check_text(source, error)) return true;
    free(source->text);
    source->text = NULL;
    return false;
}

/* What is wrong with the syntax, for those who write scenes, not parsers. */
static const struct {
    const char *problem, *words;
} syntax_problems[] = {
    {"could not find expected ':'", "a key needs a ':' and a blank behind it"},
    {"did not find expected '-' indicator", "expected '- ' for the next item; check the indentation"},
    {"did not find expected ',' or ']'", "expected ',' or ']'"},
    {"did not find expected ',' or '}'", "expected ',' or '}'"},
    {"did not find expected key", "expected a key; check the indentation"},
    {"did not find expected node content", "expected a value"},
    {"found unexpected end of stream", "a text in quotes has no end"},
    {"found unknown escape character", "a text in double quotes has an unknown escape; write \\\\ for a backslash"},
    {"mapping values are not allowed in this context",
     "a key cannot be here; check the indentation, the ':' above, and quotes around texts with ':'"},
    {"block sequence entries are not allowed in this context", "an item '- ' cannot be here; check the indentation"},
};

/* Our words for a problem that libyaml reports; its own for rare ones. `at`: the first character that is wrong. */
static const char *syntax_words(const char *problem, char at) {
    if (strcmp(problem, "found character that cannot start any token") == 0)
        return at == '\t' ? "a tab must not indent; use blanks" : "a text cannot begin with this character; use quotes";
    for (size_t i = 0; i < sizeof syntax_problems / sizeof *syntax_problems; i++)
        if (strcmp(problem, syntax_problems[i].problem) == 0) return syntax_problems[i].words;
    return problem;
}

/* Builds a YamlTree from libyaml's events. */

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

static bool add_node(Builder *builder, YamlKind kind, Error *error) {
    YamlTree *tree = builder->tree;
    if (tree->node_count == YAML_MAX_NODES)
        return source_error(&tree->source, builder->place, error, "more than %d values in one file", YAML_MAX_NODES);
    YamlNode *parent = builder->depth > 0 ? &tree->nodes[builder->open[builder->depth - 1]] : NULL;
    if (parent != NULL) parent->count++; /* of a mapping: keys and values, until it is closed */
    if (parent != NULL && parent->kind == YAML_MAPPING && parent->count > 2 * YAML_MAX_KEYS)
        return source_error(&tree->source, builder->place, error, "a mapping must have at most %d keys", YAML_MAX_KEYS);
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

/* Aliases need an anchor before them, so without anchors there are no valid aliases. */
static bool refuse_extras(const Builder *builder, const void *anchor, const void *tag, Error *error) {
    if (anchor != NULL) return fail(builder, error, "anchors (&) are not allowed");
    return tag == NULL || fail(builder, error, "tags (!) are not allowed");
}

static Place place_of(yaml_mark_t mark) { return (Place){(int)mark.line, (int)mark.column}; }

static bool take_event(Builder *builder, const yaml_event_t *event, Error *error) {
    const bool scalar = event->type == YAML_SCALAR_EVENT;
    const yaml_scalar_style_t style = scalar ? event->data.scalar.style : YAML_ANY_SCALAR_STYLE;
    YamlNode *closed;
    /* A missing value, `dt:` (`dt: ""` has one), is shown at its key; a text begins behind its quote. */
    if (style != YAML_PLAIN_SCALAR_STYLE || event->data.scalar.length > 0) {
        builder->place = place_of(event->start_mark);
        if (scalar && event->data.scalar.anchor == NULL && event->data.scalar.tag == NULL)
            builder->place.column +=
                style == YAML_SINGLE_QUOTED_SCALAR_STYLE || style == YAML_DOUBLE_QUOTED_SCALAR_STYLE;
    }
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
    case YAML_SEQUENCE_END_EVENT:
        closed = &builder->tree->nodes[builder->open[--builder->depth]];
        closed->end = builder->tree->node_count;
        if (closed->kind == YAML_MAPPING) closed->count /= 2;
        return true;
    case YAML_SCALAR_EVENT:
        return refuse_extras(builder, event->data.scalar.anchor, event->data.scalar.tag, error) &&
               add_scalar(builder, event->data.scalar.value, event->data.scalar.length, error);
    case YAML_ALIAS_EVENT: return fail(builder, error, "aliases (*) are not allowed");
    default: return true;
    }
}

bool yaml_read(YamlTree *tree, const char *path, Error *error) {
    yaml_parser_t parser;
    *tree = (YamlTree){.node_count = 0};
    if (!source_read(&tree->source, path, error)) return false;
    const Source *source = &tree->source;
    if (!yaml_parser_initialize(&parser)) {
        yaml_tree_free(tree);
        return error_memory(error, path);
    }
    Builder builder = {.tree = tree};
    bool ok = true;
    yaml_parser_set_encoding(&parser, YAML_UTF8_ENCODING);
    yaml_parser_set_input_string(&parser, (const unsigned char *)source->text, source->size);
    for (bool more = true; ok && more;) {
        yaml_event_t event;
        if (yaml_parser_parse(&parser, &event)) {
            more = event.type != YAML_STREAM_END_EVENT;
            ok = take_event(&builder, &event, error);
            yaml_event_delete(&event);
        } else if (parser.error == YAML_MEMORY_ERROR) {
            ok = error_memory(error, path);
        } else {
            /* A text without end, or a key without colon, is shown where it begins. check_text() has refused what
               libyaml's reader would. */
            const bool begun = parser.error == YAML_SCANNER_ERROR && parser.context != NULL;
            const Place place = place_of(begun ? parser.context_mark : parser.problem_mark);
            ok = source_error(source, place, error, "%s",
                              syntax_words(parser.problem, source->text[source_offset(source, place)]));
        }
    }
    yaml_parser_delete(&parser);
    if (ok && tree->node_count > 0) return true;
    if (ok) source_error(source, (Place){0, 0}, error, "the file is empty");
    yaml_tree_free(tree);
    return false;
}
