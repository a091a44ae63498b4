/* output.c - finds out before the work whether its result can be written. */
#define _GNU_SOURCE /* O_TMPFILE */
#include "program/output.h"

#include "program/message.h"
#include "system/leftover.h"
#include "system/output.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

const char *cli_basename(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/* Whether a new file can be made in `folder`. Trying is the only test that also holds for root, read-only
 * mounts and folders of /proc; a file without a name leaves nothing, even after a kill. */
static bool takes_files(const char *folder) {
    char probe[PATH_MAX];
    int file = open(folder, O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600);
    if (file >= 0) return close(file) == 0;
    snprintf(probe, sizeof probe, "%s/" LQ_TEMPORARY "%ld-0", folder, (long)getpid());
    file = open(probe, O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0600);
    if (file < 0) return false;
    close(file);
    unlink(probe);
    return true;
}

static bool refuse(const char *path, const char *why) {
    cli_message("cannot write %s: %s", path, why);
    return false;
}

bool cli_output_check(const char *path) {
    char folder[PATH_MAX - 32] = ".";
    size_t length = (size_t)(cli_basename(path) - path);
    struct stat there;
    if (stat(path, &there) == 0 && S_ISDIR(there.st_mode)) return refuse(path, "it is a folder, not a file");
    if (path[length] == '\0') return refuse(path, "that is not the name of a file");
    if (stat(path, &there) == 0 && access(path, W_OK) != 0) return refuse(path, strerror(errno));
    if (lq_output_is_protected(path)) return refuse(path, "it is another user's, in a sticky folder");
    if (stat(path, &there) == 0 && !S_ISREG(there.st_mode))
        return true; /* a device or pipe is written as it is */
    if (strlen(path) >= sizeof folder) return refuse(path, strerror(ENAMETOOLONG));
    if (length > 0) snprintf(folder, sizeof folder, "%.*s", (int)length, path);
    if (takes_files(folder)) return true;
    cli_message("cannot write %s: folder %s: %s", path, folder, strerror(errno));
    return false;
}

bool cli_report_folder(const char *folder) {
    char page[PATH_MAX];
    lq_error error = {""};
    if (strlen(folder) > sizeof page - 256) {
        cli_message("--report: the name of the folder is too long");
        return false;
    }
    if (lq_output_folder(folder, &error) != LQ_OK) {
        cli_message("--report: %s", error.text);
        return false;
    }
    snprintf(page, sizeof page, "%s/index.html", folder);
    return cli_output_check(page);
}

bool cli_print_json(json_t *root, size_t flags) {
    char *text = lq_json_dump(root, flags);
    if (!text) cli_message("no memory to print JSON");
    else puts(text);
    const bool printed = text;
    free(text);
    return printed;
}
