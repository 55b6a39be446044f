/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A library for LD_PRELOAD that lets one chosen call of twinbox fail.

   TWINBOX_FAULT=CALL:N:MODE   strikes the N-th call (from 1; 0: none) of a kind, counted over all processes of a run:
     malloc    allocations by our own code (malloc, calloc, realloc, aligned_alloc, strdup, strndup)
     libmalloc allocations by libraries that the program is linked with; not those of the OpenGL driver and the loader
     open      open, openat, opendir, fdopendir, fopen, mkstemp
     read      read, pread, fread, fgets
     write     write, pwrite, send, fflush, and what prints to a stream (but stderr)
     fsync     fsync
     rename    rename, renameat, linkat
     unlink    unlink, unlinkat, remove, rmdir
     readdir   readdir
     close     close, closedir, fclose
     stat      stat, lstat, fstat, fstatat, access, readlink, realpath
     mkdir     mkdir, mkdirat
     process   fork, posix_spawnp, pipe, socketpair, pthread_create, dup, dup2
     wait      poll, waitpid (always EINTR)
   MODE fail: the call fails with the usual errno. rest: so do all later ones. eintr: it fails with EINTR. short: it
   moves half of the bytes (read, write and their like; not streams). kill: SIGKILL for all processes of the run, before
   the call. term: SIGTERM for the first process of the run, before the call, which is not changed.

   TWINBOX_FAULT_COUNTS=FILE   maps FILE, where all processes of a run count: see Counts.
   TWINBOX_FAULT_SITES=FILE    appends "CALL N" for the first call from each place, which is its stack.

   Other programs that inherit the library (ffmpeg) are left alone. The C library's calls inside stdio cannot be
   seen; the functions that twinbox calls are. */
#define _GNU_SOURCE
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <link.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <spawn.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdio_ext.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

/* In the order of the numbers in the file of counts; beside them the errno of a failure. */
typedef enum Call {
    CALL_malloc,
    CALL_libmalloc,
    CALL_open,
    CALL_read,
    CALL_write,
    CALL_fsync,
    CALL_rename,
    CALL_unlink,
    CALL_readdir,
    CALL_close,
    CALL_stat,
    CALL_mkdir,
    CALL_process,
    CALL_wait,
    CALL_COUNT
} Call;
static const struct {
    const char *name;
    int error;
} calls[CALL_COUNT] = {{"malloc", ENOMEM},  {"libmalloc", ENOMEM}, {"open", EMFILE}, {"read", EIO},
                       {"write", ENOSPC},   {"fsync", EIO},        {"rename", EIO},  {"unlink", EIO},
                       {"readdir", EIO},    {"close", EIO},        {"stat", EIO},    {"mkdir", ENOSPC},
                       {"process", EAGAIN}, {"wait", EINTR}};

typedef enum Mode { MODE_NONE, MODE_FAIL, MODE_REST, MODE_EINTR, MODE_SHORT, MODE_KILL, MODE_TERM, MODE_COUNT } Mode;
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

static bool enter(void) {
    const bool before = inside;
    inside = true;
    return before;
}

static void leave(bool before) { inside = before; }

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

static void register_process(void) {
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

static void parse(const char *text) {
    char call[16], mode[16];
    int i = 0, j = 0;
    if (sscanf(text, "%15[a-z]:%llu:%15[a-z]", call, &shim.n, mode) != 3) give_up("TWINBOX_FAULT is not CALL:N:MODE");
    while (i < CALL_COUNT && strcmp(calls[i].name, call) != 0) i++;
    while (j < MODE_COUNT && strcmp(mode_names[j], mode) != 0) j++;
    if (i == CALL_COUNT || j == MODE_COUNT) give_up("TWINBOX_FAULT has an unknown call or mode");
    shim.call = (Call)i;
    shim.mode = (Mode)j;
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
    const bool before = enter();
    const char *fault = getenv("TWINBOX_FAULT"), *sites = getenv("TWINBOX_FAULT_SITES");
    if (fault != NULL && is_twinbox("/proc/self/exe")) {
        parse(fault);
        dl_iterate_phdr(add_range, NULL);
        shim.counts = map(getenv("TWINBOX_FAULT_COUNTS"), sizeof *shim.counts);
        if (sites != NULL) begin_sites(sites);
        shim.active = true;
        register_process();
    }
    leave(before);
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
static void note_site(Call call, unsigned long long n, const char *caller) {
    /* Of what prints, the caller is enough: each number of a table has a stack of its own. */
    const unsigned long long place = call == CALL_write ? (unsigned long long)(size_t)caller : hash_stack();
    const unsigned long long hash = place * CALL_COUNT + call + 1;
    for (unsigned probe = 0; probe < 64; probe++) {
        unsigned long long old = 0;
        if (atomic_compare_exchange_strong(&shim.sites[(hash + probe) % SITES], &old, hash)) break;
        if (old == hash) return;
    }
    char line[128];
    const int length = snprintf(line, sizeof line, "%s %llu\n", calls[call].name, n);
    if (write(shim.sites_file, line, (size_t)length) != length) give_up("cannot write TWINBOX_FAULT_SITES");
}

static Mode strike(Call call, const char *caller) {
    const unsigned long long n = 1 + atomic_fetch_add(&shim.counts->calls[call], 1);
    if (shim.sites != NULL) note_site(call, n, caller);
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

/* Counts a call and tells what is to happen to it: MODE_NONE; MODE_FAIL or MODE_EINTR, with errno set; MODE_SHORT. */
static Mode strikes(Call call, const void *caller) {
    if (!shim.active || inside) return MODE_NONE;
    if (!within(&shim.program, caller)) {
        int i = 0;
        while (i < shim.library_count && !within(&shim.libraries[i], caller)) i++;
        if (i == shim.library_count) return MODE_NONE;
        if (call == CALL_malloc) call = CALL_libmalloc;
    }
    const int cause = errno;
    const bool before = enter();
    const Mode mode = strike(call, caller);
    leave(before);
    errno = mode == MODE_FAIL ? calls[call].error : mode == MODE_EINTR ? EINTR : cause;
    return mode;
}

/* The same for calls that move no bytes: true if the call is to fail. */
static bool fails(Call call, const void *caller) {
    const Mode mode = strikes(call, caller);
    return mode == MODE_FAIL || mode == MODE_EINTR;
}

/* In a function of the C library's name: its own, as `real`, and what happens to this call. */
#define CALLER __builtin_return_address(0)
#define REAL(function)                 \
    static __typeof__(function) *real; \
    if (real == NULL) *(void **)&real = dlsym(RTLD_NEXT, #function)
#define CALL(TYPE, NAME, KIND, FAILURE, PARAMETERS, ARGUMENTS)        \
    TYPE NAME PARAMETERS {                                            \
        REAL(NAME);                                                   \
        return fails(CALL_##KIND, CALLER) ? FAILURE : real ARGUMENTS; \
    }

/* Allocations. dlsym may allocate while it looks for the function that allocates. What it gets then is never freed. */
static void *early(size_t size) {
    static _Alignas(16) char arena[4096];
    static size_t used;
    used = (used + 15) & ~(size_t)15;
    if (size > sizeof arena - used) return NULL;
    used += size;
    return arena + used - size;
}

#define ALLOCATION(NAME, SIZE, PARAMETERS, ARGUMENTS)              \
    void *NAME PARAMETERS {                                        \
        static __typeof__(NAME) *real;                             \
        static bool looking;                                       \
        if (real == NULL) {                                        \
            if (looking) return early(SIZE);                       \
            looking = true;                                        \
            *(void **)&real = dlsym(RTLD_NEXT, #NAME);             \
        }                                                          \
        return fails(CALL_malloc, CALLER) ? NULL : real ARGUMENTS; \
    }
ALLOCATION(malloc, size, (size_t size), (size))
ALLOCATION(calloc, count *size, (size_t count, size_t size), (count, size))
CALL(void *, realloc, malloc, NULL, (void *old, size_t size), (old, size))
CALL(void *, aligned_alloc, malloc, NULL, (size_t alignment, size_t size), (alignment, size))

/* The C library's own copies allocate, which must not count again. */
#define COPY(NAME, PARAMETERS, ARGUMENTS)            \
    char *NAME PARAMETERS {                          \
        REAL(NAME);                                  \
        if (fails(CALL_malloc, CALLER)) return NULL; \
        const bool before = enter();                 \
        char *copy = real ARGUMENTS;                 \
        leave(before);                               \
        return copy;                                 \
    }
COPY(strdup, (const char *text), (text))
COPY(strndup, (const char *text, size_t size), (text, size))

/* System calls. */
#define OPENING(NAME, PARAMETERS, ...)                                                                         \
    int NAME PARAMETERS {                                                                                      \
        REAL(NAME);                                                                                            \
        va_list more;                                                                                          \
        va_start(more, how);                                                                                   \
        const mode_t mode = (how & O_CREAT) != 0 || (how & O_TMPFILE) == O_TMPFILE ? va_arg(more, mode_t) : 0; \
        va_end(more);                                                                                          \
        return fails(CALL_open, CALLER) ? -1 : real(__VA_ARGS__, mode);                                        \
    }
OPENING(open, (const char *path, int how, ...), path, how)
OPENING(openat, (int at, const char *path, int how, ...), at, path, how)
CALL(DIR *, opendir, open, NULL, (const char *path), (path))
CALL(DIR *, fdopendir, open, NULL, (int file), (file))
CALL(int, mkstemp, open, -1, (char *path), (path))
CALL(FILE *, fopen, open, NULL, (const char *restrict path, const char *restrict how), (path, how))

/* Half of the bytes in mode short. */
#define MOVING(NAME, KIND, PARAMETERS, ARGUMENTS)               \
    ssize_t NAME PARAMETERS {                                   \
        REAL(NAME);                                             \
        const Mode mode = strikes(CALL_##KIND, CALLER);         \
        if (mode == MODE_FAIL || mode == MODE_EINTR) return -1; \
        if (mode == MODE_SHORT && size > 1) size /= 2;          \
        return real ARGUMENTS;                                  \
    }
MOVING(read, read, (int file, void *data, size_t size), (file, data, size))
MOVING(pread, read, (int file, void *data, size_t size, off_t at), (file, data, size, at))
MOVING(write, write, (int file, const void *data, size_t size), (file, data, size))
MOVING(pwrite, write, (int file, const void *data, size_t size, off_t at), (file, data, size, at))
MOVING(send, write, (int file, const void *data, size_t size, int how), (file, data, size, how))

CALL(int, fsync, fsync, -1, (int file), (file))

CALL(int, rename, rename, -1, (const char *from, const char *to), (from, to))
CALL(int, renameat, rename, -1, (int from_at, const char *from, int to_at, const char *to), (from_at, from, to_at, to))
CALL(int, linkat, rename, -1, (int from_at, const char *from, int to_at, const char *to, int how),
     (from_at, from, to_at, to, how))

CALL(int, unlink, unlink, -1, (const char *path), (path))
CALL(int, unlinkat, unlink, -1, (int at, const char *path, int how), (at, path, how))
CALL(int, remove, unlink, -1, (const char *path), (path))
CALL(int, rmdir, unlink, -1, (const char *path), (path))

CALL(struct dirent *, readdir, readdir, NULL, (DIR * directory), (directory))

/* Also a close that fails has closed. */
#define CLOSING(TYPE, NAME)                            \
    int NAME(TYPE what) {                              \
        REAL(NAME);                                    \
        const bool failed = fails(CALL_close, CALLER); \
        const int cause = errno, status = real(what);  \
        if (failed) errno = cause;                     \
        return failed ? -1 : status;                   \
    }
CLOSING(int, close)
CLOSING(DIR *, closedir)

CALL(int, stat, stat, -1, (const char *restrict path, struct stat *restrict status), (path, status))
CALL(int, lstat, stat, -1, (const char *restrict path, struct stat *restrict status), (path, status))
CALL(int, fstat, stat, -1, (int file, struct stat *status), (file, status))
CALL(int, fstatat, stat, -1, (int at, const char *restrict path, struct stat *restrict status, int how),
     (at, path, status, how))
CALL(int, access, stat, -1, (const char *path, int how), (path, how))
CALL(ssize_t, readlink, stat, -1, (const char *restrict path, char *restrict target, size_t size), (path, target, size))
CALL(char *, realpath, stat, NULL, (const char *restrict path, char *restrict target), (path, target))

CALL(int, mkdir, mkdir, -1, (const char *path, mode_t mode), (path, mode))
CALL(int, mkdirat, mkdir, -1, (int at, const char *path, mode_t mode), (at, path, mode))

CALL(int, pipe, process, -1, (int ends[2]), (ends))
CALL(int, socketpair, process, -1, (int domain, int type, int protocol, int ends[2]), (domain, type, protocol, ends))
CALL(int, dup, process, -1, (int file), (file))
CALL(int, dup2, process, -1, (int file, int as), (file, as))
CALL(int, posix_spawnp, process, EAGAIN,
     (pid_t *restrict process, const char *restrict program, const posix_spawn_file_actions_t *restrict actions,
      const posix_spawnattr_t *restrict attributes, char *const arguments[restrict], char *const environment[restrict]),
     (process, program, actions, attributes, arguments, environment))
CALL(int, pthread_create, process, EAGAIN,
     (pthread_t *restrict thread, const pthread_attr_t *restrict attributes, void *(*work)(void *),
      void *restrict argument),
     (thread, attributes, work, argument))

CALL(int, poll, wait, -1, (struct pollfd * files, nfds_t count, int timeout), (files, count, timeout))
CALL(pid_t, waitpid, wait, -1, (pid_t process, int *status, int how), (process, status, how))

pid_t fork(void) {
    REAL(fork);
    if (fails(CALL_process, CALLER)) return -1;
    const pid_t child = real();
    if (child == 0) register_process();
    return child;
}

/* Streams: the functions that twinbox calls, in place of the reads and writes inside them. Nothing that cannot be
   printed to standard error could be reported either; streams to memory (-1) only allocate. */
static bool is_a_file(FILE *stream) { return stream != NULL && fileno(stream) >= 0 && fileno(stream) != STDERR_FILENO; }

/* A failure also sets the stream's error flag, as in the C library. Other modes are for calls that move bytes
   themselves. */
static bool stream_fails(FILE *stream, Call call, const void *caller) {
    if (!is_a_file(stream) || strikes(call, caller) != MODE_FAIL) return false;
    stream->_flags |= 0x20; /* glibc: _IO_ERR_SEEN */
    return true;
}

#define STREAMING(TYPE, NAME, KIND, STREAM, FAILURE, PARAMETERS, ARGUMENTS)          \
    TYPE NAME PARAMETERS {                                                           \
        REAL(NAME);                                                                  \
        return stream_fails(STREAM, CALL_##KIND, CALLER) ? FAILURE : real ARGUMENTS; \
    }
STREAMING(size_t, fread, read, stream, 0, (void *restrict data, size_t size, size_t count, FILE *restrict stream),
          (data, size, count, stream))
STREAMING(char *, fgets, read, stream, NULL, (char *restrict text, int size, FILE *restrict stream),
          (text, size, stream))
STREAMING(size_t, fwrite, write, stream, 0,
          (const void *restrict data, size_t size, size_t count, FILE *restrict stream), (data, size, count, stream))
STREAMING(int, fputs, write, stream, EOF, (const char *restrict text, FILE *restrict stream), (text, stream))
STREAMING(int, puts, write, stdout, EOF, (const char *text), (text))
STREAMING(int, fputc, write, stream, EOF, (int character, FILE *stream), (character, stream))
STREAMING(int, putc, write, stream, EOF, (int character, FILE *stream), (character, stream))
STREAMING(int, putchar, write, stdout, EOF, (int character), (character))

#define PRINTING(NAME, STREAM, PARAMETERS)                       \
    int NAME PARAMETERS {                                        \
        if (stream_fails(STREAM, CALL_write, CALLER)) return -1; \
        va_list arguments;                                       \
        va_start(arguments, format);                             \
        const int length = vfprintf(STREAM, format, arguments);  \
        va_end(arguments);                                       \
        return length;                                           \
    }
PRINTING(fprintf, stream, (FILE *restrict stream, const char *restrict format, ...))
PRINTING(printf, stdout, (const char *restrict format, ...))

/* A failed write loses what was to be written. */
int fflush(FILE *stream) {
    REAL(fflush);
    if (!stream_fails(stream, CALL_write, CALLER)) return real(stream);
    __fpurge(stream);
    return EOF;
}

int fclose(FILE *stream) {
    REAL(fclose);
    const bool failed = is_a_file(stream) && fails(CALL_close, CALLER);
    const int cause = errno;
    if (failed && __fwriting(stream)) __fpurge(stream);
    const int status = real(stream);
    if (failed) errno = cause;
    return failed ? EOF : status;
}
