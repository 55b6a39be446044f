/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether a sanitizer watches. It makes a program up to ten times slower, and what it finds in a series of cases that
   differ only in their numbers it finds in a few of them. So the sanitizers' builds run one case in `sampled(n)`, as
   does tests/run without --all; with it the release build runs all. */
#pragma once
#include <stdlib.h>

#if defined __SANITIZE_ADDRESS__ || defined __SANITIZE_THREAD__
#define SANITIZED
#elif defined __has_feature
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define SANITIZED
#endif
#endif

static inline int sampled(int n) {
#ifdef SANITIZED
    return n;
#else
    return getenv("TWINBOX_BRIEF") != NULL ? n : 1;
#endif
}
