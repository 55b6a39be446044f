/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Builds a YamlTree from libfyaml's events. */
#include "yaml/yaml_tree.h"

#include "common/array.h"

#include <libfyaml.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

typedef struct Builder {
    YamlTree *tree;
    size_t node_capacity, text_size, text_capacity;
    int depth, documents;
    int open[YAML_MAX_DEPTH]; /* open lists and mappings, outermost first */
    Place place;              /* of the last event that had one */
    size_t fed, fed_before;   /* bytes that libfyaml has read, now and at the last event */
    bool gap_too_long;
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

static bool add_scalar(Builder *builder, struct fy_token *value, Error *error) {
    if (!add_node(builder, YAML_SCALAR, error)) return false;
    size_t length = 0;
    const char *text = value == NULL ? "" : fy_token_get_text(value, &length);
    if (text == NULL) return error_memory(error, builder->tree->source.path);
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
static bool refuse_extras(const Builder *builder, const struct fy_token *anchor, const struct fy_token *tag,
                          Error *error) {
    if (anchor != NULL) return fail(builder, error, "anchors (&) are not allowed");
    return tag == NULL || fail(builder, error, "tags (!) are not allowed");
}

/* `dt:` without a value; `dt: ""` has one. */
static bool is_missing_value(struct fy_event *event) {
    if (event->type != FYET_SCALAR) return false;
    struct fy_token *value = event->scalar.value;
    return value == NULL || (fy_token_scalar_style(value) == FYSS_PLAIN && fy_token_get_text_length(value) == 0);
}

static bool take_event(Builder *builder, struct fy_event *event, Error *error) {
    const struct fy_mark *mark = fy_event_start_mark(event);
    /* A missing value is shown at its key; not all versions of libfyaml give it a mark. */
    if (mark != NULL && !is_missing_value(event)) builder->place = (Place){mark->line, mark->column};
    builder->fed_before = builder->fed;
    switch (event->type) {
    case FYET_DOCUMENT_START:
        return ++builder->documents == 1 || fail(builder, error, "a file must hold one document only");
    case FYET_MAPPING_START:
        return refuse_extras(builder, event->mapping_start.anchor, event->mapping_start.tag, error) &&
               open_node(builder, YAML_MAPPING, error);
    case FYET_SEQUENCE_START:
        return refuse_extras(builder, event->sequence_start.anchor, event->sequence_start.tag, error) &&
               open_node(builder, YAML_SEQUENCE, error);
    case FYET_MAPPING_END:
    case FYET_SEQUENCE_END: close_node(builder); return true;
    case FYET_SCALAR:
        return refuse_extras(builder, event->scalar.anchor, event->scalar.tag, error) &&
               add_scalar(builder, event->scalar.value, error);
    case FYET_ALIAS: return fail(builder, error, "aliases (*) are not allowed");
    default: return true;
    }
}

/* Reports the first error that libfyaml collected. */
static bool syntax_error(const Builder *builder, struct fy_diag *diagnosis, Error *error) {
    const Source *source = &builder->tree->source;
    void *position = NULL;
    for (const struct fy_diag_error *found; (found = fy_diag_errors_iterate(diagnosis, &position)) != NULL;) {
        if (found->type != FYET_ERROR) continue;
        char words[200];
        source_printable(words, sizeof words, found->msg);
        return source_error(source, (Place){found->line - 1, found->column - 1}, error, "%s", words);
    }
    return fail(builder, error, "not valid YAML");
}

static bool gap_error(const Builder *builder, Error *error) {
    return source_error(&builder->tree->source, builder->place, error, "more than %d bytes from here to the next value",
                        YAML_MAX_GAP);
}

static bool take_events(Builder *builder, struct fy_parser *parser, struct fy_diag *diagnosis, Error *error) {
    for (bool more = true; more;) {
        struct fy_event *event = fy_parser_parse(parser);
        more = event != NULL && event->type != FYET_STREAM_END;
        bool taken = builder->gap_too_long ? gap_error(builder, error)
                     : event == NULL       ? syntax_error(builder, diagnosis, error)
                                           : take_event(builder, event, error);
        fy_parser_event_free(parser, event);
        if (!taken) return false;
    }
    return builder->tree->node_count > 0 ||
           source_error(&builder->tree->source, (Place){0, 0}, error, "the file is empty");
}

/* Feeds the text in pieces, which limits how far libfyaml reads ahead of its events: a million brackets would cost it a
   second and half a gigabyte before the first event. */
static ssize_t feed(void *user, void *buffer, size_t size) {
    Builder *builder = user;
    const Source *source = &builder->tree->source;
    builder->gap_too_long = builder->fed - builder->fed_before > YAML_MAX_GAP;
    if (builder->gap_too_long) return 0;
    size_t left = source->size - builder->fed;
    if (size > left) size = left;
    memcpy(buffer, source->text + builder->fed, size);
    builder->fed += size;
    return (ssize_t)size;
}

static bool build(YamlTree *tree, struct fy_diag *diagnosis, Error *error) {
    const struct fy_parse_cfg settings = {.flags = FYPCF_QUIET | FYPCF_DEFAULT_VERSION_1_2 | FYPCF_JSON_NONE,
                                          .diag = diagnosis};
    struct fy_parser *parser = fy_parser_create(&settings);
    if (parser == NULL) return error_memory(error, tree->source.path);
    Builder builder = {.tree = tree};
    bool done = fy_parser_set_input_callback(parser, &builder, feed) == 0
                    ? take_events(&builder, parser, diagnosis, error)
                    : error_memory(error, tree->source.path);
    fy_parser_destroy(parser);
    return done;
}

/* Collects libfyaml's messages; without this object it writes them to stderr, even if set to quiet.
 */
static bool build_silently(YamlTree *tree, Error *error) {
    struct fy_diag_cfg nowhere;
    fy_diag_cfg_default(&nowhere);
    nowhere.fp = NULL;
    struct fy_diag *diagnosis = fy_diag_create(&nowhere);
    if (diagnosis == NULL) return error_memory(error, tree->source.path);
    fy_diag_set_collect_errors(diagnosis, true);
    bool done = build(tree, diagnosis, error);
    fy_diag_destroy(diagnosis);
    return done;
}

bool yaml_read(YamlTree *tree, const char *path, Error *error) {
    *tree = (YamlTree){.node_count = 0};
    if (!source_read(&tree->source, path, error)) return false;
    if (build_silently(tree, error)) return true;
    yaml_free(tree);
    return false;
}

void yaml_free(YamlTree *tree) {
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
