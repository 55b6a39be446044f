/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What reads a YAML tree: messages that show a place in the text, nodes, mappings by tables of keys. The tree itself is
   made by yaml_read.c, of a file, or by live/bundle.c. */
#include "base/yaml.h"

#include "base/base.h"

#include <limits.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Excerpts of the text, with a caret. */

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
        size_t next = start; /* behind the end of this line; "\r\n" is one end, as in YAML */
        while (in_line(source, next)) next++;
        if (next < source->size) next += source->text[next] == '\r' && source->text[next + 1] == '\n' ? 2 : 1;
        if (next >= source->size) *place = (Place){line, INT_MAX};
        start = next < source->size ? next : start;
    }
    int column = 0;
    for (size_t at = start; column < place->column && in_line(source, at); column++) at += character_length(source, at);
    place->column = column;
    return start;
}

size_t source_offset(const Source *source, Place place) {
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
    PRINT_ARGUMENTS(what, sizeof what, format);

    size_t start = find_place(source, &place);
    Excerpt excerpt = excerpt_line(source, start, place.column);
    snprintf(where, sizeof where, "%.1200s:%d:%d", source->path, place.line + 1, place.column + 1);
    snprintf(number, sizeof number, "%5d", place.line + 1);
    return error_input(error, where, "%s\n%s | %s\n%*s | %s^", what, number, excerpt.line, (int)strlen(number), "",
                       excerpt.blanks);
}

void yaml_tree_free(YamlTree *tree) {
    free(tree->source.text);
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
    PRINT_ARGUMENTS(what, sizeof what, format);
    return source_error(&tree->source, tree->nodes[node].place, error, "%s", what);
}

/* A scalar with escapes, or on several lines, is not in the file as its text is: then the place is its begin. */
bool yaml_error_at(const YamlTree *tree, int node, size_t byte, Error *error, const char *format, ...) {
    char what[512];
    const char *text = yaml_text(tree, node);
    Place place = tree->nodes[node].place;
    PRINT_ARGUMENTS(what, sizeof what, format);
    const size_t at = source_offset(&tree->source, place);
    if (byte <= tree->source.size - at && memcmp(tree->source.text + at, text, byte) == 0)
        for (size_t i = 0; i < byte; i += character_length(&tree->source, at + i)) place.column++;
    return source_error(&tree->source, place, error, "%s", what);
}

/* Reads mappings by tables of keys, and values of types that need no other room. */

static bool unknown_key(const YamlTree *tree, int node, const char *what, const Field *fields, Error *error) {
    const YamlShown shown = yaml_show(tree, node);
    const char *keys[FIELDS_MAX];
    NameList known = {0};
    int count = 0;
    for (const Field *field = fields; field->key != NULL; field++) {
        keys[count++] = field->key;
        name_list_add(&known, field->key);
    }
    const char *nearest = nearest_word(yaml_text(tree, node), keys, count);
    if (nearest != NULL)
        return yaml_error(tree, node, error, "'%s' is not a key of %s; did you mean '%s'?", shown.text, what, nearest);
    return yaml_error(tree, node, error, "'%s' is not a key of %s; known: %s", shown.text, what, known.text);
}

static const Field *find_field(const Field *fields, const char *key) {
    while (fields->key != NULL && strcmp(fields->key, key) != 0) fields++;
    return fields->key == NULL ? NULL : fields;
}

int fields_node(const Field *fields, const int nodes[FIELDS_MAX], const char *key) {
    return nodes[find_field(fields, key) - fields];
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
    for (int i = 0; fields[i].key != NULL; i++)
        if (fields[i].required && nodes[i] == 0)
            return yaml_error(tree, node, error, "%s needs the key '%s'", what, fields[i].key);
    return true;
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
