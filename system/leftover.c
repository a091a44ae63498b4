/* leftover.c - a lock dies with its process: it tells a file that was left over from one in the making. */
#define _GNU_SOURCE /* O_NOFOLLOW, F_DUPFD_CLOEXEC */
#include "system/leftover.h"

#include <dirent.h>
#include <fcntl.h>
#include <limits.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

int lq_leftover_lock(int file) {
    if (flock(file, LOCK_EX) != 0) return -1; /* waits for lq_leftovers_clear at most */
    return fcntl(file, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
}

/* LQ_TEMPORARY, digits, '-', digits. */
static bool is_temporary(const char *name) {
    static const char digits[] = "0123456789";
    const size_t prefix = sizeof LQ_TEMPORARY - 1;
    if (strncmp(name, LQ_TEMPORARY, prefix) != 0) return false;
    const size_t pid = strspn(name + prefix, digits);
    const char *rest = name + prefix + pid;
    return pid > 0 && *rest == '-' && rest[1] && rest[1 + strspn(rest + 1, digits)] == '\0';
}

static void clear(int folder, const char *name) {
    struct stat info;
    const int file = openat(folder, name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (file < 0) return;
    if (fstat(file, &info) == 0 && S_ISREG(info.st_mode) && info.st_uid == geteuid() &&
        flock(file, LOCK_EX | LOCK_NB) == 0)
        unlinkat(folder, name, 0);
    close(file);
}

void lq_leftovers_clear(const char *folder, size_t length) {
    char path[PATH_MAX];
    if (length >= sizeof path) return;
    memcpy(path, folder, length);
    memcpy(path + length, length ? "" : ".", length ? 1 : 2);
    DIR *list = opendir(path);
    for (struct dirent *entry; list && (entry = readdir(list));)
        if (is_temporary(entry->d_name)) clear(dirfd(list), entry->d_name);
    if (list) closedir(list);
}
