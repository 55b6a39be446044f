/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Streams: the functions that twinbox calls, in place of the reads and writes inside them. */
#define _GNU_SOURCE
#include "shim.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdio_ext.h>
#include <unistd.h>

/* Nothing that cannot be printed to standard error could be reported either; streams to memory (-1) only allocate. */
static bool is_a_file(FILE *stream) { return stream != NULL && fileno(stream) >= 0 && fileno(stream) != STDERR_FILENO; }

/* A failure also sets the stream's error flag, as in the C library. Other modes are for calls that move bytes
   themselves. */
static bool stream_fails(FILE *stream, Call call, const char *function, const void *caller) {
    if (!is_a_file(stream) || shim_strikes(call, function, caller) != MODE_FAIL) return false;
    stream->_flags |= 0x20; /* glibc: _IO_ERR_SEEN */
    return true;
}
#define STREAM_FAILS(stream, call) stream_fails(stream, call, __func__, __builtin_return_address(0))

FILE *fopen(const char *restrict path, const char *restrict how) {
    REAL(fopen);
    return FAILS(CALL_OPEN) ? NULL : real(path, how);
}

FILE *tmpfile(void) {
    REAL(tmpfile);
    return FAILS(CALL_OPEN) ? NULL : real();
}

size_t fread(void *restrict data, size_t size, size_t count, FILE *restrict stream) {
    REAL(fread);
    return STREAM_FAILS(stream, CALL_READ) ? 0 : real(data, size, count, stream);
}

char *fgets(char *restrict text, int size, FILE *restrict stream) {
    REAL(fgets);
    return STREAM_FAILS(stream, CALL_READ) ? NULL : real(text, size, stream);
}

size_t fwrite(const void *restrict data, size_t size, size_t count, FILE *restrict stream) {
    REAL(fwrite);
    return STREAM_FAILS(stream, CALL_WRITE) ? 0 : real(data, size, count, stream);
}

int fputs(const char *restrict text, FILE *restrict stream) {
    REAL(fputs);
    return STREAM_FAILS(stream, CALL_WRITE) ? EOF : real(text, stream);
}

int puts(const char *text) {
    REAL(puts);
    return STREAM_FAILS(stdout, CALL_WRITE) ? EOF : real(text);
}

int fputc(int character, FILE *stream) {
    REAL(fputc);
    return STREAM_FAILS(stream, CALL_WRITE) ? EOF : real(character, stream);
}

int putc(int character, FILE *stream) {
    REAL(putc);
    return STREAM_FAILS(stream, CALL_WRITE) ? EOF : real(character, stream);
}

int putchar(int character) {
    REAL(putchar);
    return STREAM_FAILS(stdout, CALL_WRITE) ? EOF : real(character);
}

int fprintf(FILE *restrict stream, const char *restrict format, ...) {
    if (STREAM_FAILS(stream, CALL_WRITE)) return -1;
    va_list arguments;
    va_start(arguments, format);
    const int length = vfprintf(stream, format, arguments);
    va_end(arguments);
    return length;
}

int printf(const char *restrict format, ...) {
    if (STREAM_FAILS(stdout, CALL_WRITE)) return -1;
    va_list arguments;
    va_start(arguments, format);
    const int length = vfprintf(stdout, format, arguments);
    va_end(arguments);
    return length;
}

/* A failed write loses what was to be written. */
int fflush(FILE *stream) {
    REAL(fflush);
    if (!STREAM_FAILS(stream, CALL_WRITE)) return real(stream);
    __fpurge(stream);
    return EOF;
}

int fclose(FILE *stream) {
    REAL(fclose);
    const bool fails = is_a_file(stream) && FAILS(CALL_CLOSE);
    const int cause = errno;
    if (fails && __fwriting(stream)) __fpurge(stream);
    const int status = real(stream);
    if (fails) errno = cause;
    return fails ? EOF : status;
}
