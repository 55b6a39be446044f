/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The words of a figure, explained in its caption: names of methods and keys of their settings. */
#include "base/base.h"
#include "methods/methods.h"
#include "studies/figure_words.h"

#include <math.h>
#include <string.h>

/* Of the meaning, without what is for those who run the method: choices before it, "on|off: ", and what follows "
   (". */
void words_add(WordList *words, const char *word, const char *meaning) {
    char text[WORD_SIZE];
    const char *end = strstr(meaning, " ("), *choices = strstr(meaning, ": ");
    if (choices != NULL && memchr(meaning, '|', (size_t)(choices - meaning)) != NULL) meaning = choices + 2;
    snprintf(text, sizeof text, "%s: %.*s", word, (int)(end != NULL ? end - meaning : WORD_SIZE), meaning);
    for (int i = 0; i < words->count; i++)
        if (strncmp(words->items[i], text, strlen(word) + 2) == 0) return;
    if (words->count < WORDS_MAX) strcpy(words->items[words->count++], text);
}

void words_add_method(WordList *words, const char *name) {
    const MethodDescription *method = method_describe(name);
    if (method != NULL) words_add(words, method->name, method->caption != NULL ? method->caption : method->summary);
}

void words_add_settings(WordList *words, const char *name, const char *setting) {
    const MethodDescription *method = method_describe(name);
    const char *twin = method != NULL && method->twin != NULL ? method->twin + strcspn(method->twin, ":") : "";
    for (const char *part = setting; method != NULL && *part != '\0';) {
        const size_t length = strcspn(part, ","), key = strcspn(part, "=,");
        if (twin[0] == ':' && strncmp(part, twin + 1, length) == 0 && twin[1 + length] == '\0')
            words_add(words, twin + 1, "without its learned part");
        else
            for (const SettingSpec *known = method->settings; known != NULL && known->key != NULL; known++)
                if (key == strlen(known->key) && strncmp(part, known->key, key) == 0)
                    words_add(words, known->key, known->summary);
        part += length + (part[length] == ',');
    }
}

void words_join(const WordList *words, char *caption, size_t size) {
    for (int i = 0; i < words->count; i++) text_add(caption, size, "%s%s", i == 0 ? " " : "; ", words->items[i]);
    text_add(caption, size, words->count > 0 ? ".\n" : "\n");
}

void factor_text(char text[FACTOR_SIZE], double factor) {
    const double unit = pow(10, floor(log10(factor)) - 1);
    snprintf(text, FACTOR_SIZE, factor < 9.95 ? "%.1f" : "%.0f", unit * round(factor / unit));
}
