/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What every reader promises: an error with a place, never the system's, within the budgets. */
#include "fuzz.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

#if defined __SANITIZE_ADDRESS__
#define COUNTS_MEMORY
#elif defined __has_feature
#if __has_feature(address_sanitizer)
#define COUNTS_MEMORY
#endif
#endif

#ifdef COUNTS_MEMORY
#include <stdatomic.h>

/* sanitizer/allocator_interface.h, which gcc does not have. */
int __sanitizer_install_malloc_and_free_hooks(void (*allocated)(const volatile void *block, size_t size),
                                              void (*freed)(const volatile void *block));
int __sanitizer_get_ownership(const volatile void *block);
size_t __sanitizer_get_allocated_size(const volatile void *block);

/* Bytes allocated since fuzz_begin(), now and at most; of any thread. */
static atomic_int_fast64_t held, peak;

static void allocated(const volatile void *block, size_t size) {
    (void)block;
    const int_fast64_t now = atomic_fetch_add(&held, (int_fast64_t)size) + (int_fast64_t)size;
    int_fast64_t most = atomic_load(&peak);
    while (now > most && !atomic_compare_exchange_weak(&peak, &most, now)) continue;
}

static void freed(const volatile void *block) {
    if (block != NULL && __sanitizer_get_ownership(block))
        atomic_fetch_sub(&held, (int_fast64_t)__sanitizer_get_allocated_size(block));
}

static void count_memory(void) {
    static bool installed;
    if (!installed) __sanitizer_install_malloc_and_free_hooks(allocated, freed);
    installed = true;
    atomic_store(&held, 0);
    atomic_store(&peak, 0);
}

static void check_memory(void) {
    const long long most = atomic_load(&peak);
    if (most > (long long)FUZZ_MEBIBYTES << 20) fuzz_fail("%lld bytes of memory", most);
}
#else
static void count_memory(void) {}
static void check_memory(void) {}
#endif

static double processor_milliseconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

static double begun;

void fuzz_begin(void) {
    count_memory();
    begun = processor_milliseconds();
}

static void check_time(void) {
#ifdef TWINBOX_FUZZ
    const double taken = processor_milliseconds() - begun;
    if (taken > FUZZ_MILLISECONDS * FUZZ_SANITIZED) fuzz_fail("%.0f ms of processor time", taken);
#else
    (void)begun;
#endif
}

/* ":12" or ":12:8", from 1 on, may follow the place. */
static const char *skip_numbers(const char *text) {
    while (text[0] == ':' && text[1] >= '1' && text[1] <= '9') text += 1 + strspn(text + 1, "0123456789");
    return text;
}

/* A terminal must not obey a file. */
static void check_visible(const char *message) {
    for (const char *c = message; *c != '\0'; c++)
        if (((unsigned char)*c < ' ' && *c != '\n' && *c != '\t') || *c == '\x7f')
            fuzz_fail("a control character, %d, in: %s", *c, message);
}

static void check_refusal(const Error *error, const char *place) {
    static const char mark[] = ": error: ";
    check_visible(error->message);
    if (error->kind != ERROR_INPUT)
        fuzz_fail("an error of kind %d for a file's content: %s", error->kind, error->message);
    const size_t length = place != NULL ? strlen(place) : 0;
    const char *rest = place != NULL ? skip_numbers(error->message + length) : strstr(error->message, mark);
    if (strncmp(error->message, place != NULL ? place : "", length) != 0)
        fuzz_fail("'%s' is not the place of: %s", place, error->message);
    if (rest == NULL || strncmp(rest, mark, sizeof mark - 1) != 0 || rest[sizeof mark - 1] == '\0')
        fuzz_fail("no \"PLACE: error: why\": %s", error->message);
}

void fuzz_end(bool accepted, const Error *error, const char *place) {
    check_time();
    check_memory();
    if (!accepted) check_refusal(error, place);
    if (accepted && error->kind != ERROR_NONE) fuzz_fail("accepted with an error: %s", error->message);
}
