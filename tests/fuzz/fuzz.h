/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fuzzing of everything that reads what others wrote. A target makes a file or a text of any bytes, gives it to a
   reader and checks what comes back. test_replay.c runs all targets on the stored inputs (corpus/TARGET); with
   TWINBOX_FUZZ, libFuzzer runs each on inputs that it makes (fuzzer.c, run).

   A finding is an abort with a message; the sanitizers have more: memory errors, undefined behaviour, leaks. */
#pragma once
#include "base/base.h"

#include <stddef.h>
#include <stdint.h>

/* Each has a function fuzz_NAME in a file fuzz_*.c. */
#define FUZZ_TARGETS(TARGET) \
    TARGET(scene)            \
    TARGET(launches)         \
    TARGET(tables)           \
    TARGET(csv_run)          \
    TARGET(results)          \
    TARGET(view)             \
    TARGET(manifest)         \
    TARGET(rules)            \
    TARGET(set)              \
    TARGET(settings)         \
    TARGET(png)              \
    TARGET(pixels)           \
    TARGET(zip)              \
    TARGET(run)              \
    TARGET(network)          \
    TARGET(dataset)          \
    TARGET(problem)          \
    TARGET(piece)            \
    TARGET(scores)           \
    TARGET(times)

#define FUZZ_DECLARE(name) void fuzz_##name(const uint8_t *data, size_t size);
FUZZ_TARGETS(FUZZ_DECLARE)

/* Runs a target, which must leave no file open. False if there is no target of that name. */
bool fuzz_try(const char *target, const uint8_t *data, size_t size);

/* Stops the program with this finding. */
void fuzz_fail(const char *format, ...) PRINTF_LIKE(1, 2) __attribute__((noreturn));

/* The path of a file with these bytes in a folder of this process, which goes at exit. Valid until the same name is
   written next. */
const char *fuzz_file(const char *name, const void *data, size_t size);

/* Copies the bytes to text[room] as a string; what follows a NUL, or has no room, is left out. */
void fuzz_text(char *text, size_t room, const uint8_t *data, size_t size);

/* What a reader may take, accepted or refused: inputs are small. Processor time counts in fuzzers only, with the
   sanitizers' factor of ten; memory wherever the address sanitizer counts it, in libraries, too. */
enum { FUZZ_MILLISECONDS = 100, FUZZ_SANITIZED = 10, FUZZ_MEBIBYTES = 64 };

/* A call of a reader begins; it has ended. It accepts and sets no error, or it refuses with an input error "PLACE:
   error: why" or "PLACE:line:column: error: why", where `place` is the file or the option; NULL: any. */
void fuzz_begin(void);
void fuzz_end(bool accepted, const Error *error, const char *place);

/* What a reader that takes &error returns: Run *run = FUZZ_READ(run_read(path, &error), path). */
#define FUZZ_READ(call, place)                  \
    ({                                          \
        fuzz_begin();                           \
        __auto_type result = (call);            \
        fuzz_end(result != 0, &error, (place)); \
        result;                                 \
    })
