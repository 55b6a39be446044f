/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lets calls that read folders fail. These functions replace those of the C library in the program that includes this;
   include it first. */
#pragma once
#define _GNU_SOURCE /* RTLD_NEXT */
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <stdbool.h>
#include <stddef.h>
#include <sys/stat.h>

/* The N-th call fails (0: none). */
static int failing_opendir, failing_readdir, failing_stat;

static bool fails(int *countdown) {
    if (*countdown == 0 || --*countdown > 0) return false;
    errno = EIO;
    return true;
}

DIR *opendir(const char *path) {
    DIR *(*real)(const char *);
    *(void **)&real = dlsym(RTLD_NEXT, "opendir");
    return fails(&failing_opendir) ? NULL : real(path);
}

struct dirent *readdir(DIR *directory) {
    struct dirent *(*real)(DIR *);
    *(void **)&real = dlsym(RTLD_NEXT, "readdir");
    return fails(&failing_readdir) ? NULL : real(directory);
}

int fstatat(int at, const char *restrict path, struct stat *restrict status, int flags) {
    int (*real)(int, const char *restrict, struct stat *restrict, int);
    *(void **)&real = dlsym(RTLD_NEXT, "fstatat");
    return fails(&failing_stat) ? -1 : real(at, path, status, flags);
}

int stat(const char *restrict path, struct stat *restrict status) {
    int (*real)(const char *restrict, struct stat *restrict);
    *(void **)&real = dlsym(RTLD_NEXT, "stat");
    return fails(&failing_stat) ? -1 : real(path, status);
}
