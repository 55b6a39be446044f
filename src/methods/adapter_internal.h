/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the two files of adapters share: the struct, and the JSON of a line. */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "methods/adapter.h"
#include "methods/methods.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { ADAPTER_KEY_SIZE = 2 * METHOD_TEXT_SIZE };

struct Adapter {
    Adapter *next; /* in the pool */
    Talk talk;
    char key[ADAPTER_KEY_SIZE];
    bool binary;
    uint32_t scene;          /* number of the scene, or of the contact problem: an answer to a former one is noticed */
    int bodies, frame, left; /* of the scene; the last frame read; frames that are still to be read */
    float *numbers;          /* of the last answer: [bodies, ADAPTER_NUMBERS], or [contacts, 2] */
    char *request;           /* text of a request */
    size_t number_capacity, request_size, request_capacity;
    char why[TALK_WHY_SIZE];
};

/* Sets `why`; returns false. */
bool adapter_failed(Adapter *adapter, const char *format, ...) PRINTF_LIKE(2, 3);

/* With the start of an answer that is not understood. */
bool adapter_not_understood(Adapter *adapter, const char *what, const char *line);

/* JSON of one line, as far as answers have it. line_take_key begins with the "{" or the "," before a
   key, and ends behind its ":"; it is false at the end of the object, and if there is no key. */
bool line_take_text(const char **at, char *text, size_t size);
bool line_take_number(const char **at, double *number);
bool line_take_key(const char **at, bool first, char *key, size_t size);
bool line_take_end(const char **at);
