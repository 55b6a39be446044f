/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads YAML files with libyaml: their text, which is checked first and shown in messages, then their tree, then mappings by
   tables of keys. */
#include "base/yaml.h"

#include "base/base.h"
#include "base/file.h"

#include <limits.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <yaml.h>

/* The text of a YAML file: checks before parsing, and excerpts with a caret. */

/* Characters of the line in an excerpt, and the most of them before the caret. */
enum { EXCERPT_WIDTH = 100, EXCERPT_BEFORE = 70 };

/* Control characters could control the terminal; direction marks could disguise the line. */
static bool prints(uint32_t c) {
    if (c < 0x20 || (c >= 0x7f && c < 0xa0)) return false;
    return !((c >= 0x200b && c <= 0x200f) || (c >= 0x2028 && c <= 0x202e) || (c >= 0x2060 && c <= 0x206f) ||
             c == 0xfeff);
}

/* Copies one character or '?' to out (room for 5 bytes); returns the bytes read and adds those written. */
static size_t copy_character(char *out, size_t *written, const char *text, size_t size) {
    uint32_t character;
    size_t length = utf8_decode(text, size, &character);
    if (length > 0 && (prints(character) || character == '\t')) {
        memcpy(out + *written, text, length);
        *written += length;
    } else {
        out[(*written)++] = '?';
    }
    out[*written] = '\0';
    return length > 0 ? length : 1;
}

void source_printable(char *out, size_t room, const char *text) {
    size_t size = strlen(text), written = 0, read = 0;
    out[0] = '\0';
    while (read < size) {
        if (written + 8 > room) { /* one character of 4 bytes, "..." and the NUL */
            strcpy(out + written, "...");
            return;
        }
        read += copy_character(out, &written, text + read, size - read);
        if (out[written - 1] == '\t') out[written - 1] = ' ';
    }
}

static bool ends_line(char c) { return c == '\n' || c == '\r'; }

/* The end of the line that contains `at`; "\r\n" is one end, as in YAML. */
static size_t next_line(const Source *source, size_t at) {
    while (at < source->size && !ends_line(source->text[at])) at++;
    if (at < source->size) at += source->text[at] == '\r' && source->text[at + 1] == '\n' ? 2 : 1;
    return at;
}

static bool in_line(const Source *source, size_t at) { return at < source->size && !ends_line(source->text[at]); }

/* Bytes of the character at `at`; 1 for a byte that is not UTF-8. */
static size_t character_length(const Source *source, size_t at) {
    uint32_t character;
    size_t length = utf8_decode(source->text + at, source->size - at, &character);
    return length > 0 ? length : 1;
}

/* Start of a place's line. The end of the file is shown after its last line, not on an empty line below. *place is
   moved into the line if it is beyond its end. */
static size_t find_place(const Source *source, Place *place) {
    size_t start = 0;
    for (int line = 0; line < place->line; line++) {
        size_t next = next_line(source, start);
        if (next >= source->size) *place = (Place){line, INT_MAX};
        start = next < source->size ? next : start;
    }
    int column = 0;
    for (size_t at = start; column < place->column && in_line(source, at); column++) at += character_length(source, at);
    place->column = column;
    return start;
}

/* The byte at a place; beyond the end of a line, its end. */
static size_t source_offset(const Source *source, Place place) {
    size_t at = find_place(source, &place);
    for (int column = 0; column < place.column; column++) at += character_length(source, at);
    return at;
}

/* Prints the excerpt of the line, and below it blanks up to the caret. */
typedef struct Excerpt {
    char line[4 * EXCERPT_WIDTH + 8], blanks[EXCERPT_WIDTH];
} Excerpt;

static Excerpt excerpt_line(const Source *source, size_t start, int column) {
    Excerpt excerpt;
    size_t written = 0, blanks = 0, at = start;
    int first = column > EXCERPT_BEFORE ? column - EXCERPT_BEFORE : 0;
    for (int i = 0; i < first; i++) at += character_length(source, at);
    if (first > 0) {
        written = blanks = strlen(strcpy(excerpt.line, "..."));
        memset(excerpt.blanks, ' ', blanks);
    }
    for (int i = first; in_line(source, at); i++) {
        if (i == first + EXCERPT_WIDTH) {
            memcpy(excerpt.line + written, "...", 3);
            written += 3;
            break;
        }
        if (i < column) excerpt.blanks[blanks++] = source->text[at] == '\t' ? '\t' : ' ';
        at += copy_character(excerpt.line, &written, source->text + at, source->size - at);
    }
    excerpt.line[written] = excerpt.blanks[blanks] = '\0';
    return excerpt;
}

bool source_error(const Source *source, Place place, Error *error, const char *format, ...) {
    char what[512], where[1280], number[16];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);

    size_t start = find_place(source, &place);
    Excerpt excerpt = excerpt_line(source, start, place.column);
    snprintf(where, sizeof where, "%.1200s:%d:%d", source->path, place.line + 1, place.column + 1);
    snprintf(number, sizeof number, "%5d", place.line + 1);
    return error_input(error, where, "%s\n%s | %s\n%*s | %s^", what, number, excerpt.line, (int)strlen(number), "",
                       excerpt.blanks);
}

/* What libyaml refuses without a place, and what it takes for the end of a line but editors do not. */
static bool is_allowed(uint32_t character) {
    return !(character >= 0x80 && character < 0xa0) && character != 0x2028 && character != 0x2029 &&
           character != 0xfeff && character != 0xfffe && character != 0xffff;
}

static bool check_character(const Source *source, size_t at, uint32_t character, Place *place, Error *error) {
    if (ends_line(source->text[at])) {
        bool inside_pair = source->text[at] == '\r' && source->text[at + 1] == '\n';
        *place = (Place){place->line + !inside_pair, 0};
        return true;
    }
    if ((character < 0x20 && character != '\t') || character == 0x7f)
        return source_error(source, *place, error, "control character 0x%02x", (unsigned)character);
    if (!is_allowed(character))
        return source_error(source, *place, error, "the character U+%04X is not allowed", (unsigned)character);
    if (place->column == 0 && character == '%')
        return source_error(source, *place, error, "YAML directives are not allowed");
    place->column++;
    return true;
}

static bool check_text(const Source *source, Error *error) {
    Place place = {0, 0};
    for (size_t at = 0, length; at < source->size; at += length) {
        uint32_t character;
        length = utf8_decode(source->text + at, source->size - at, &character);
        if (length == 0) return source_error(source, place, error, "not UTF-8 text");
        if (!check_character(source, at, character, &place, error)) return false;
    }
    return true;
}

static void source_free(Source *source) {
    free(source->text);
    source->text = NULL;
}

/* Reads a file of UTF-8 text: no control characters but tab and line end, no YAML directive (a line that begins with '%').
   A byte order mark is dropped. On failure there is nothing to free. */
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
    source_free(source);
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

/* A text without end, or a key without colon, is shown where it begins. check_text() has refused what libyaml's reader would. */
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

/* A scalar with escapes, or on several lines, is not in the file as its text is: then the place is its begin. */
bool yaml_error_at(const YamlTree *tree, int node, size_t byte, Error *error, const char *format, ...) {
    char what[512];
    const char *text = yaml_text(tree, node);
    Place place = tree->nodes[node].place;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    const size_t at = source_offset(&tree->source, place);
    if (byte <= tree->source.size - at && memcmp(tree->source.text + at, text, byte) == 0)
        for (size_t i = 0; i < byte; i += character_length(&tree->source, at + i)) place.column++;
    return source_error(&tree->source, place, error, "%s", what);
}

/* Reads mappings by tables of keys, and values of types that need no other room. */

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
