/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whose a temporary file is. Several machines may share a folder, and their process ids and clocks may be equal; locks may
   hold on one machine only, or nowhere. So the machine is in the name, and only there can a process be looked up. */
#include "common/temporary.h"

#include "common/hash.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/utsname.h>
#include <unistd.h>

static char machine[9];

/* Names of machines may be equal, as those of copies of one are; this is drawn when a kernel starts. */
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

void temporary_owner(char owner[TEMPORARY_OWNER]) {
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, identify);
    snprintf(owner, TEMPORARY_OWNER, "%s-%ld-", machine, (long)getpid());
}

bool temporary_owner_ended(const char *name) {
    char own[TEMPORARY_OWNER], *end;
    /* MACHINE- has as many characters as the array that holds MACHINE. */
    temporary_owner(own);
    if (strncmp(name, own, sizeof machine) != 0) return false;
    const long process = strtol(name + sizeof machine, &end, 10);
    return *end == '-' && process > 0 && process == (pid_t)process && kill((pid_t)process, 0) != 0 && errno == ESRCH;
}
