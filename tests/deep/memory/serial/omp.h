/* SPDX-License-Identifier: GPL-3.0-or-later */
/* OpenMP with one thread, for the memory sanitizer: OpenMP's library is built without it, and what that library passes
   to a thread would count as uninitialised. */
#pragma once

static inline int omp_get_max_threads(void) { return 1; }
static inline int omp_get_thread_num(void) { return 0; }
static inline void omp_set_num_threads(int count) { (void)count; }
static inline int omp_get_num_threads(void) { return 1; }

typedef int omp_lock_t;

static inline void omp_init_lock(omp_lock_t *lock) { *lock = 0; }
static inline void omp_destroy_lock(omp_lock_t *lock) { (void)lock; }
static inline void omp_set_lock(omp_lock_t *lock) { *lock = 1; }
static inline void omp_unset_lock(omp_lock_t *lock) { *lock = 0; }
static inline int omp_test_lock(omp_lock_t *lock) { return *lock == 0 ? (*lock = 1) : 0; }
