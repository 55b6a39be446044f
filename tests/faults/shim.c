/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A library for LD_PRELOAD that lets one chosen call of twinbox fail.

   TWINBOX_FAULT=CALL:N:MODE   strikes the N-th call (from 1; 0: none) of a kind, counted over all processes of a run:
     malloc    allocations by our own code (malloc, calloc, realloc, aligned_alloc, strdup, strndup)
     libmalloc allocations by libraries that the program is linked with; not those of the OpenGL driver and the loader
     open      open, openat, opendir, fdopendir, fopen, mkstemp, tmpfile
     read      read, pread, fread, fgets
     write     write, pwrite, send, fflush, and what prints to a stream (but stderr)
     fsync     fsync, fdatasync, syncfs
     rename    rename, renameat, link, linkat
     unlink    unlink, unlinkat, remove, rmdir
     readdir   readdir
     close     close, closedir, fclose
     stat      stat, lstat, fstat, fstatat, access, readlink, realpath
     mkdir     mkdir, mkdirat, mkdtemp
     process   fork, posix_spawnp, pipe, socketpair, pthread_create, dup, dup2
     wait      poll, waitpid (always EINTR)
   MODE fail: the call fails with the usual errno. rest: so do all later ones. eintr: it fails with EINTR. short: it
   moves half of the bytes (read, write and their like; not streams). kill: SIGKILL for all processes of the run, before
   the call. term: SIGTERM for the first process of the run, before the call, which is not changed.

   TWINBOX_FAULT_COUNTS=FILE   maps FILE, where all processes of a run count: see Counts.
   TWINBOX_FAULT_SITES=FILE    appends "CALL N FUNCTION" for the first call from each place, which is its stack.

   Other programs that inherit the library (ffmpeg) are left alone. The C library's calls inside stdio cannot be
   seen; the functions that twinbox calls are. */
#define _GNU_SOURCE
#include "shim.h"

#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <link.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

static const char *const call_names[CALL_COUNT] = {"malloc", "libmalloc", "open",  "read", "write", "fsync",   "rename",
                                                   "unlink", "readdir",   "close", "stat", "mkdir", "process", "wait"};
static const int call_errors[CALL_COUNT] = {ENOMEM, ENOMEM, EMFILE, EIO, ENOSPC, EIO,    EIO,
                                            EIO,    EIO,    EIO,    EIO, ENOSPC, EAGAIN, EINTR};
static const char *const mode_names[MODE_COUNT] = {"none", "fail", "rest", "eintr", "short", "kill", "term"};

enum { PROCESSES = 256, LIBRARIES = 64, SITES = 1 << 14, FRAMES = 12 };

typedef _Atomic unsigned long long Number;

/* The file of counts. */
typedef struct Counts {
    Number calls[CALL_COUNT];
    Number struck;    /* calls that were struck */
    Number struck_at; /* where the first was called: an address in the program's file, 0 in a library */
    Number processes[PROCESSES];
} Counts;

typedef struct Range {
    const char *begin, *end;
} Range;

static struct {
    bool active;
    Call call;
    unsigned long long n;
    Mode mode;
    Counts *counts;
    const char *base;
    Range program, libraries[LIBRARIES];
    int library_count;
    int sites_file;
    Number *sites; /* [SITES], hashes of stacks; NULL without a file */
} shim;

/* Not the default model: that one can allocate. */
static _Thread_local bool inside __attribute__((tls_model("initial-exec")));

bool shim_enter(void) {
    const bool before = inside;
    inside = true;
    return before;
}

void shim_leave(bool before) { inside = before; }

static bool within(const Range *range, const char *address) { return address >= range->begin && address < range->end; }

/* The program is the first, then what it is linked with; libraries that are loaded later are not in the list. Neither
   is the loader, which ends the program (status 127) when it gets no memory. */
static int add_range(struct dl_phdr_info *info, size_t size, void *unused) {
    (void)size;
    (void)unused;
    const char *base = (const char *)info->dlpi_addr;
    if (strstr(info->dlpi_name, "/ld-linux") != NULL) return 0;
    for (int i = 0; i < info->dlpi_phnum; i++) {
        const ElfW(Phdr) *part = &info->dlpi_phdr[i];
        if (part->p_type != PT_LOAD || (part->p_flags & PF_X) == 0) continue;
        const Range range = {base + part->p_vaddr, base + part->p_vaddr + part->p_memsz};
        if (shim.program.begin == NULL) {
            shim.program = range;
            shim.base = base;
        } else if (shim.library_count < LIBRARIES) {
            shim.libraries[shim.library_count++] = range;
        }
    }
    return 0;
}

static bool is_twinbox(const char *link) {
    char path[4096];
    const ssize_t length = readlink(link, path, sizeof path - 1);
    if (length < 0) return false;
    path[length] = '\0';
    const char *slash = strrchr(path, '/');
    return slash != NULL && strcmp(slash + 1, "twinbox") == 0;
}

void shim_register_process(void) {
    if (!shim.active) return;
    for (int i = 0; i < PROCESSES; i++) {
        unsigned long long none = 0;
        if (atomic_compare_exchange_strong(&shim.counts->processes[i], &none, (unsigned long long)getpid())) return;
    }
}

/* A driver's mistake must not look like a run without faults. */
static void give_up(const char *what) {
    fprintf(stderr, "fault_shim: %s\n", what);
    _exit(99);
}

static int find(const char *const *names, int count, const char *name, size_t length) {
    for (int i = 0; i < count; i++)
        if (strlen(names[i]) == length && strncmp(names[i], name, length) == 0) return i;
    give_up("TWINBOX_FAULT is not CALL:N:MODE");
    return 0;
}

static void parse(const char *text) {
    const size_t length = strcspn(text, ":");
    char *end = "";
    shim.call = (Call)find(call_names, CALL_COUNT, text, length);
    if (text[length] == ':') shim.n = strtoull(text + length + 1, &end, 10);
    if (*end == ':') end++;
    shim.mode = (Mode)find(mode_names, MODE_COUNT, end, strlen(end));
}

static void *map(const char *path, size_t size) {
    int file = -1;
    if (path != NULL) {
        file = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (file < 0 || ftruncate(file, (off_t)size) != 0) give_up("cannot create TWINBOX_FAULT_COUNTS");
    }
    const int how = file < 0 ? MAP_SHARED | MAP_ANONYMOUS : MAP_SHARED;
    void *at = mmap(NULL, size, PROT_READ | PROT_WRITE, how, file, 0);
    if (at == MAP_FAILED) give_up("mmap");
    if (file >= 0) close(file);
    return at;
}

static void begin_sites(const char *path) {
    void *frame;
    shim.sites_file = open(path, O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666);
    if (shim.sites_file < 0) give_up("cannot create TWINBOX_FAULT_SITES");
    backtrace(&frame, 1); /* the first one loads a library */
    shim.sites = map(NULL, SITES * sizeof *shim.sites);
}

__attribute__((constructor)) static void begin(void) {
    const bool before = shim_enter();
    const char *fault = getenv("TWINBOX_FAULT"), *sites = getenv("TWINBOX_FAULT_SITES");
    if (fault != NULL && is_twinbox("/proc/self/exe")) {
        parse(fault);
        dl_iterate_phdr(add_range, NULL);
        shim.counts = map(getenv("TWINBOX_FAULT_COUNTS"), sizeof *shim.counts);
        if (sites != NULL) begin_sites(sites);
        shim.active = true;
        shim_register_process();
    }
    shim_leave(before);
}

static void kill_all(void) {
    for (int i = 0; i < PROCESSES; i++) {
        const pid_t process = (pid_t)shim.counts->processes[i];
        char link[64];
        snprintf(link, sizeof link, "/proc/%d/exe", (int)process);
        if (process != 0 && process != getpid() && is_twinbox(link)) kill(process, SIGKILL);
    }
    kill(getpid(), SIGKILL);
}

static unsigned long long hash_stack(void) {
    void *frames[FRAMES];
    const int count = backtrace(frames, FRAMES);
    unsigned long long hash = 14695981039346656037u; /* FNV-1a, by words */
    for (int i = 0; i < count; i++) hash = (hash ^ (unsigned long long)(size_t)frames[i]) * 1099511628211u;
    return hash;
}

/* Hash 0 marks an empty slot. A full table notes a place again. */
static void note_site(Call call, unsigned long long n, const char *function, const char *caller) {
    /* Of what prints, the caller is enough: each number of a table has a stack of its own. */
    const unsigned long long place = call == CALL_WRITE ? (unsigned long long)(size_t)caller : hash_stack();
    const unsigned long long hash = place * CALL_COUNT + call + 1;
    for (unsigned probe = 0; probe < 64; probe++) {
        unsigned long long old = 0;
        if (atomic_compare_exchange_strong(&shim.sites[(hash + probe) % SITES], &old, hash)) break;
        if (old == hash) return;
    }
    char line[128];
    const int length = snprintf(line, sizeof line, "%s %llu %s\n", call_names[call], n, function);
    if (write(shim.sites_file, line, (size_t)length) != length) give_up("cannot write TWINBOX_FAULT_SITES");
}

static Mode strike(Call call, const char *function, const char *caller) {
    const unsigned long long n = 1 + atomic_fetch_add(&shim.counts->calls[call], 1);
    if (shim.sites != NULL) note_site(call, n, function, caller);
    if (call != shim.call || shim.n == 0 || (shim.mode == MODE_REST ? n < shim.n : n != shim.n)) return MODE_NONE;
    if (shim.mode == MODE_KILL) kill_all();
    if (shim.mode == MODE_TERM) {
        kill((pid_t)shim.counts->processes[0], SIGTERM);
        return MODE_NONE;
    }
    if (atomic_fetch_add(&shim.counts->struck, 1) == 0 && within(&shim.program, caller))
        shim.counts->struck_at = (unsigned long long)(caller - shim.base);
    return shim.mode == MODE_REST ? MODE_FAIL : shim.mode;
}

Mode shim_strikes(Call call, const char *function, const void *caller) {
    if (!shim.active || inside) return MODE_NONE;
    if (!within(&shim.program, caller)) {
        int i = 0;
        while (i < shim.library_count && !within(&shim.libraries[i], caller)) i++;
        if (i == shim.library_count) return MODE_NONE;
        if (call == CALL_MALLOC) call = CALL_LIBMALLOC;
    }
    const int cause = errno;
    const bool before = shim_enter();
    const Mode mode = strike(call, function, caller);
    shim_leave(before);
    errno = mode == MODE_FAIL ? call_errors[call] : mode == MODE_EINTR ? EINTR : cause;
    return mode;
}

bool shim_fails(Call call, const char *function, const void *caller) {
    const Mode mode = shim_strikes(call, function, caller);
    return mode == MODE_FAIL || mode == MODE_EINTR;
}
