/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Temporary files, the removal of those that killed processes left, and reservations of files and folders. */
#include "base/base.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/machine.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <pthread.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/utsname.h>
#include <time.h>
#include <unistd.h>

/* Whose a temporary file is. Several machines may share a folder, and their process ids and clocks may be equal; locks
   may hold on one machine only, or nowhere. So the machine is in the name, and only there can a process be looked up.
   Two machines, two starts of one, and two containers of one have different names. */

/* "MACHINE-PID-", with which names of temporary files begin. */
enum { OWNER_SIZE = 48 };

static char machine[9];

/* Random, drawn when a kernel starts: copies of a machine have equal names. */
static void read_boot_id(char *text, size_t size) {
    const int file = open("/proc/sys/kernel/random/boot_id", O_RDONLY | O_CLOEXEC);
    if (file < 0) return;
    const ssize_t length = read(file, text, size - 1);
    text[length > 0 ? length : 0] = '\0';
    close(file);
}

/* Processes in containers cannot look each other up; each container is a machine. */
static void identify(void) {
    struct {
        char boot[64], processes[64];
        struct utsname names;
    } known = {0};
    read_boot_id(known.boot, sizeof known.boot);
    if (readlink("/proc/self/ns/pid", known.processes, sizeof known.processes - 1) < 0) known.processes[0] = '\0';
    if (uname(&known.names) != 0) memset(&known.names, 0, sizeof known.names);
    snprintf(machine, sizeof machine, "%08" PRIx32, (uint32_t)hash_xxh3(&known, sizeof known));
}

static void print_owner(char owner[OWNER_SIZE]) {
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, identify);
    snprintf(owner, OWNER_SIZE, "%s-%ld-", machine, (long)getpid());
}

/* Whether the name begins with an owner on this machine whose process has ended. */
static bool owner_has_ended(const char *name) {
    char own[OWNER_SIZE], *end;
    /* MACHINE- has as many characters as the array that holds MACHINE. */
    print_owner(own);
    if (strncmp(name, own, sizeof machine) != 0) return false;
    const long process = strtol(name + sizeof machine, &end, 10);
    return *end == '-' && process > 0 && process == (pid_t)process && kill((pid_t)process, 0) != 0 && errno == ESRCH;
}

enum { ATTEMPTS = 100 };

const char *temporary_files_folder(void) {
    const char *chosen = getenv("TMPDIR");
    return chosen != NULL && chosen[0] != '\0' ? chosen : "/tmp";
}

static bool print_name(TemporaryFile *temporary, const char *path, unsigned attempt) {
    struct timespec now;
    char owner[OWNER_SIZE];
    clock_gettime(CLOCK_REALTIME, &now);
    print_owner(owner);
    const int length = snprintf(temporary->name, sizeof temporary->name, "%.*s.twinbox-%s%lx-%u.tmp",
                                (int)file_folder_length(path), path, owner, (unsigned long)now.tv_nsec, attempt);
    if (length >= 0 && (size_t)length < sizeof temporary->name) return true;
    errno = ENAMETOOLONG;
    return false;
}

/* Takes the lock that files in use have, without waiting. False if another process has it, or if the file has lost its
   name to a process that found it unlocked. True where the file system has no locks. */
static bool lock_as_in_use(int file) {
    struct stat status;
    if (flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) return false;
    return fstat(file, &status) != 0 || status.st_nlink > 0;
}

/* Not mkstemp: its files are readable by their owner only, whatever the umask. */
static bool open_named(TemporaryFile *temporary, const char *path) {
    for (unsigned attempt = 0; attempt <= ATTEMPTS && print_name(temporary, path, attempt); attempt++) {
        temporary->file = openat(temporary->at, temporary->name, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (temporary->file >= 0 && lock_as_in_use(temporary->file)) return true;
        if (temporary->file < 0 && errno != EEXIST) break;
        if (temporary->file >= 0) temporary_close(temporary);
    }
    temporary->name[0] = '\0';
    return false;
}

/* A file without a name gets one through /proc. */
static int open_nameless(int at, const char *path) {
    char folder[PATH_MAX];
    const int length = (int)file_folder_length(path);
    if (access("/proc/self/fd", X_OK) != 0) {
        errno = EOPNOTSUPP;
        return -1;
    }
    if (snprintf(folder, sizeof folder, "%.*s", length > 0 ? length : 1, length > 0 ? path : ".") >= PATH_MAX) {
        errno = ENAMETOOLONG;
        return -1;
    }
    return openat(at, folder, O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
}

bool temporary_open(TemporaryFile *temporary, int at, const char *path) {
    temporary->at = at;
    temporary->name[0] = '\0';
    temporary->file = open_nameless(at, path);
    if (temporary->file >= 0) return true;
    return (errno == EOPNOTSUPP || errno == EISDIR || errno == EINVAL) && open_named(temporary, path);
}

int temporary_nameless(const char *path) {
    TemporaryFile temporary;
    temporary_sweep(AT_FDCWD, path);
    if (!temporary_open(&temporary, AT_FDCWD, path)) return -1;
    if (temporary_remove_name(&temporary)) return temporary.file;
    temporary_close(&temporary);
    return -1;
}

bool temporary_link(TemporaryFile *temporary, const char *path) {
    char descriptor[64];
    if (temporary->name[0] != '\0') return linkat(temporary->at, temporary->name, temporary->at, path, 0) == 0;
    snprintf(descriptor, sizeof descriptor, "/proc/self/fd/%d", temporary->file);
    return linkat(AT_FDCWD, descriptor, temporary->at, path, AT_SYMLINK_FOLLOW) == 0;
}

/* Locked before it has the name. */
static bool give_name(TemporaryFile *temporary, const char *path) {
    flock(temporary->file, LOCK_EX | LOCK_NB);
    TemporaryFile named = *temporary;
    for (unsigned attempt = 0; attempt <= ATTEMPTS && print_name(&named, path, attempt); attempt++) {
        if (temporary_link(temporary, named.name)) {
            *temporary = named;
            return true;
        }
        if (errno != EEXIST) return false;
    }
    return false;
}

bool temporary_rename(TemporaryFile *temporary, const char *path) {
    if (temporary->name[0] == '\0') {
        /* A link, unlike a rename, needs no other name before, but cannot replace a file. */
        if (temporary_link(temporary, path)) return true;
        if (errno != EEXIST || !give_name(temporary, path)) return false;
    }
    if (renameat(temporary->at, temporary->name, temporary->at, path) != 0) return false;
    temporary->name[0] = '\0';
    return true;
}

bool temporary_remove_name(TemporaryFile *temporary) {
    const bool done = temporary->name[0] == '\0' || unlinkat(temporary->at, temporary->name, 0) == 0;
    temporary->name[0] = '\0';
    return done;
}

void temporary_close(TemporaryFile *temporary) {
    const int cause = errno;
    temporary_remove_name(temporary);
    if (temporary->file >= 0) close(temporary->file);
    temporary->file = -1;
    errno = cause;
}

/* Temporary files of killed processes of this machine, and reservations that nobody has locked. */

enum { REMEMBERED = 16 };

/* The folders that this process has swept. */
static struct {
    pthread_mutex_t mutex;
    struct stat folders[REMEMBERED];
    int count;
} swept = {.mutex = PTHREAD_MUTEX_INITIALIZER};

static bool same_file(const struct stat *a, const struct stat *b) {
    return a->st_dev == b->st_dev && a->st_ino == b->st_ino;
}

/* Whether this folder is met for the first time. The oldest of many is forgotten. */
static bool temporary_remember(const struct stat *folder) {
    bool known = false;
    pthread_mutex_lock(&swept.mutex);
    for (int i = 0; i < swept.count && i < REMEMBERED; i++) known = known || same_file(&swept.folders[i], folder);
    if (!known) swept.folders[swept.count++ % REMEMBERED] = *folder;
    pthread_mutex_unlock(&swept.mutex);
    return !known;
}

/* The lock is held while the name is removed; else a process could take the file in between. Over NFS, only a file that
   is open for writing can be locked. */
static void remove_dead(int folder, const char *name, bool (*lock)(int)) {
    struct stat status, named;
    const int file = openat(folder, name, O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (file < 0) return;
    if (fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_uid == geteuid() && lock(file) &&
        fstatat(folder, name, &named, AT_SYMLINK_NOFOLLOW) == 0 && same_file(&status, &named))
        unlinkat(folder, name, 0);
    close(file);
}

static bool lock_now(int file) { return flock(file, LOCK_EX | LOCK_NB) == 0; }

/* Reservations have no owner in their names. A temporary file may be in use by children of a process that has ended. */
static void temporary_visit(int folder, const char *name) {
    static const char start[] = ".twinbox-";
    const char *owner = name + sizeof start - 1;
    if (strncmp(name, start, sizeof start - 1) != 0 || !file_name_ends_with(name, ".tmp")) return;
    if (strchr(owner, '-') == NULL)
        remove_dead(folder, name, lock_now);
    else if (owner_has_ended(owner))
        remove_dead(folder, name, lock_as_in_use);
}

void temporary_sweep(int at, const char *path) {
    char name[PATH_MAX];
    struct stat status;
    const int length = (int)file_folder_length(path);
    if (snprintf(name, sizeof name, "%.*s", length > 0 ? length : 1, length > 0 ? path : ".") >= PATH_MAX) return;
    const int folder = openat(at, name, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0) return;
    DIR *entries = fstat(folder, &status) == 0 && temporary_remember(&status) ? fdopendir(folder) : NULL;
    if (entries == NULL) {
        close(folder);
        return;
    }
    for (const struct dirent *entry; (entry = readdir(entries)) != NULL;) temporary_visit(folder, entry->d_name);
    closedir(entries);
}

/* Reservations: files and folders that only one process at a time writes. */

/* The process that has locked a file: flock() itself does not tell. 0: unknown, or it has ended. */
static long find_holder(const struct stat *file) {
    char line[256];
    long holder = 0;
    FILE *locks = fopen("/proc/locks", "re");
    if (locks == NULL) return 0;
    while (holder == 0 && fgets(line, sizeof line, locks) != NULL) {
        long process;
        unsigned major_number, minor_number;
        unsigned long long inode;
        if (sscanf(line, "%*d: FLOCK ADVISORY WRITE %ld %x:%x:%llu", &process, &major_number, &minor_number, &inode) ==
                4 &&
            inode == file->st_ino && major_number == major(file->st_dev) && minor_number == minor(file->st_dev))
            holder = process;
    }
    fclose(locks);
    return holder > 0 && (kill((pid_t)holder, 0) == 0 || errno == EPERM) ? holder : 0;
}

static bool temporary_refuse(const char *path, const char *what, long holder, Error *error) {
    char name[48] = "another process";
    if (holder > 0) snprintf(name, sizeof name, "another process (%ld)", holder);
    return error_system(error, path, "%s %s; wait until it ends, or choose another name", name, what);
}

/* Locks an open file or folder until all copies of it are closed. ERROR_SYSTEM names the process that has the lock:
   "another process (NUMBER) `what`". True where the file system has no locks. Waits shortly for the children of a
   process that has ended: the drawing processes of a render that was killed end after their frame, which must not
   replace one drawn later. */
static bool take_lock(int file, const char *path, const char *what, Error *error) {
    struct stat status;
    static const double patience = 0.2, patience_with_children = 30; /* s */
    const double begun = clock_seconds();
    while (flock(file, LOCK_EX | LOCK_NB) != 0) {
        if (errno == EINTR) continue;
        if (errno != EWOULDBLOCK) return true;
        if (fstat(file, &status) != 0) return error_system(error, path, "cannot be locked: %s", strerror(errno));
        const long holder = find_holder(&status);
        if (clock_seconds() - begun > (holder > 0 ? patience : patience_with_children))
            return temporary_refuse(path, what, holder, error);
        nanosleep(&(struct timespec){.tv_nsec = 20000000}, NULL);
    }
    return true;
}

/* OpenMP calls exit() when it gets no memory or no thread. */
static TemporaryFile *held;

static void remove_held(void) {
    if (held != NULL) temporary_remove_name(held);
}

/* False if the process that had the file removed its name while this one waited. */
static bool has_name(const TemporaryFile *lock) {
    struct stat opened, named;
    return fstat(lock->file, &opened) == 0 && stat(lock->name, &named) == 0 && same_file(&opened, &named);
}

static bool take_file(TemporaryFile *lock, const char *path, Error *error) {
    do {
        if (lock->file >= 0) close(lock->file);
        lock->file = open(lock->name, O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
        if (lock->file < 0) return error_system(error, path, "cannot be locked: %s", strerror(errno));
        if (!take_lock(lock->file, path, "is making this file", error)) return false;
    } while (!has_name(lock));
    return true;
}

bool file_reserve(FileReservation *reservation, const char *path, Error *error) {
    TemporaryFile *lock = &reservation->lock;
    const size_t folder = file_folder_length(path);
    struct stat status;
    *lock = (TemporaryFile){.at = AT_FDCWD, .file = -1};
    if (path_is_standard(path) || (stat(path, &status) == 0 && !S_ISREG(status.st_mode))) return true;
    if (!file_path(lock->name, sizeof lock->name, error, "%.*s.twinbox-%016" PRIx64 ".tmp", (int)folder, path,
                   hash_xxh3(path + folder, strlen(path + folder))))
        return false;
    if (!take_file(lock, path, error)) {
        if (lock->file >= 0) close(lock->file);
        return false;
    }
    if (held == NULL) atexit(remove_held);
    held = lock;
    return true;
}

bool file_release(FileReservation *reservation, Error *error) {
    char name[PATH_MAX];
    held = NULL;
    strcpy(name, reservation->lock.name);
    const bool done = temporary_remove_name(&reservation->lock) ||
                      error_system(error, name, "cannot be removed: %s", strerror(errno));
    temporary_close(&reservation->lock);
    return done;
}

/* A command writes into two folders at most. */
enum { FOLDERS = 8 };

/* The reserved folders. Their files stay open. */
static struct {
    struct stat status[FOLDERS];
    int files[FOLDERS], count;
} reserved;

static bool is_reserved(const struct stat *folder) {
    for (int i = 0; i < reserved.count && i < FOLDERS; i++)
        if (same_file(&reserved.status[i], folder)) return true;
    return false;
}

/* Of more, the oldest is given back. */
static void temporary_keep(int file, const struct stat *folder) {
    const int place = reserved.count++ % FOLDERS;
    if (reserved.count > FOLDERS) close(reserved.files[place]);
    reserved.files[place] = file;
    reserved.status[place] = *folder;
}

bool folder_reserve(const char *folder, Error *error) {
    struct stat status;
    if (!file_make_directory(folder, error)) return false;
    const int file = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    /* A folder that cannot be read may be one that can be written into. */
    if (file < 0 && errno == EACCES) return true;
    if (file < 0 || fstat(file, &status) != 0) {
        error_system(error, folder, "cannot be opened: %s", strerror(errno));
        if (file >= 0) close(file);
        return false;
    }
    const bool known = is_reserved(&status),
               done = known || take_lock(file, folder, "is writing into this folder", error);
    if (done && !known)
        temporary_keep(file, &status);
    else
        close(file);
    return done;
}
