/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the parts of the fault shim share (shim.c tells what it is). */
#pragma once
#include <dlfcn.h>
#include <stdbool.h>
#include <stddef.h>

/* In the order of the numbers in the file of counts. */
typedef enum Call {
    CALL_MALLOC,
    CALL_LIBMALLOC,
    CALL_OPEN,
    CALL_READ,
    CALL_WRITE,
    CALL_FSYNC,
    CALL_RENAME,
    CALL_UNLINK,
    CALL_READDIR,
    CALL_CLOSE,
    CALL_STAT,
    CALL_MKDIR,
    CALL_PROCESS,
    CALL_WAIT,
    CALL_COUNT
} Call;

typedef enum Mode { MODE_NONE, MODE_FAIL, MODE_REST, MODE_EINTR, MODE_SHORT, MODE_KILL, MODE_TERM, MODE_COUNT } Mode;

/* Counts a call and tells what is to happen to it: MODE_NONE; MODE_FAIL or MODE_EINTR, with errno set; MODE_SHORT. */
Mode shim_strikes(Call call, const char *function, const void *caller);

/* The same for calls that move no bytes: true if the call is to fail. */
bool shim_fails(Call call, const char *function, const void *caller);

/* Adds the calling process to those that mode kill reaches. */
void shim_register_process(void);

/* Calls between these are neither counted nor struck. Returns what shim_leave needs. */
bool shim_enter(void);
void shim_leave(bool before);

/* In a function of the C library's name: its own, as `real`, and what happens to this call. */
#define REAL(function)                 \
    static __typeof__(function) *real; \
    if (real == NULL) *(void **)&real = dlsym(RTLD_NEXT, #function)
#define STRIKES(call) shim_strikes(call, __func__, __builtin_return_address(0))
#define FAILS(call) shim_fails(call, __func__, __builtin_return_address(0))
