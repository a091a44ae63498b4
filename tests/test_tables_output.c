/* test_tables_output.c - files appear whole or not at all, and an older one survives every failure. */
#define _GNU_SOURCE
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "lacquer.h"
#include "system/output.h"
#include "tests/scratch.h"

static void assert_contains(const char *text, const char *part) {
    if (!strstr(text, part)) fail_msg("'%s' does not contain '%s'", text, part);
}

static void write_old(const char *path) {
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs("old", file);
    assert_int_equal(fclose(file), 0);
}

static void assert_holds(const char *path, const char *text) {
    char read[64] = "";
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    size_t size = fread(read, 1, sizeof read - 1, file);
    fclose(file);
    assert_int_equal(size, strlen(text));
    assert_string_equal(read, text);
}

static lq_output *open_output(const char *path) {
    lq_output *output;
    lq_error error;
    if (lq_output_open(&output, path, &error)) fail_msg("%s", error.text);
    return output;
}

/* ------------------------------------------------------------------ success */

static void test_commit_replaces(void **state) {
    (void)state;
    write_old(at("a"));
    lq_output *output = open_output(at("a"));
    assert_int_equal(lq_output_print(output, NULL, "%d ", 42), LQ_OK);
    assert_int_equal(lq_output_write(output, "bytes", 5, NULL), LQ_OK);
    assert_holds(at("a"), "old"); /* until the commit */
    assert_int_equal(lq_output_commit(output, NULL), LQ_OK);
    assert_holds(at("a"), "42 bytes");
    assert_int_equal(files_in_folder(), 1);
    unlink(at("a"));
}

static void test_new_file_has_umask_permissions(void **state) {
    (void)state;
    mode_t old = umask(027);
    lq_output *output = open_output(at("b"));
    umask(old);
    assert_int_equal(files_in_folder(), 0); /* unnamed so far */
    assert_int_equal(lq_output_write_at(output, "xyz", 3, 3, NULL), LQ_OK);
    assert_int_equal(lq_output_write_at(output, "abc", 3, 0, NULL), LQ_OK);
    assert_int_equal(lq_output_commit(output, NULL), LQ_OK);
    assert_holds(at("b"), "abcxyz");
    struct stat info;
    assert_int_equal(stat(at("b"), &info), 0);
    assert_int_equal(info.st_mode & 0777, 0640);
    unlink(at("b"));
}

static void test_more_than_the_buffer(void **state) {
    (void)state;
    enum { SIZE = 200000 };
    char *bytes = malloc(SIZE);
    for (int i = 0; i < SIZE; i++) bytes[i] = (char)(i * 7 + i / 251);
    lq_output *output = open_output(at("c"));
    size_t done = 0;
    for (size_t piece = 1; done < SIZE; piece = piece * 3 + 1) {
        size_t size = SIZE - done < piece ? SIZE - done : piece;
        assert_int_equal(lq_output_write(output, bytes + done, size, NULL), LQ_OK);
        done += size;
    }
    assert_int_equal(lq_output_commit(output, NULL), LQ_OK);
    char *back = malloc(SIZE + 1);
    FILE *file = fopen(at("c"), "rb");
    assert_int_equal(fread(back, 1, SIZE + 1, file), SIZE);
    fclose(file);
    assert_memory_equal(back, bytes, SIZE);
    free(back);
    free(bytes);
    unlink(at("c"));
}

static void test_link_is_followed(void **state) {
    (void)state;
    write_old(at("real"));
    assert_int_equal(symlink("real", at("link")), 0);
    lq_output *output = open_output(at("link"));
    lq_output_print(output, NULL, "new");
    assert_int_equal(lq_output_commit(output, NULL), LQ_OK);
    assert_holds(at("real"), "new");
    struct stat info;
    assert_int_equal(lstat(at("link"), &info), 0);
    assert_true(S_ISLNK(info.st_mode));
    unlink(at("link"));
    unlink(at("real"));
}

static void test_file_in_the_current_folder(void **state) {
    (void)state;
    char *before = getcwd(NULL, 0);
    assert_int_equal(chdir(folder), 0);
    lq_output *output = open_output("plain");
    lq_output_print(output, NULL, "here");
    assert_int_equal(lq_output_commit(output, NULL), LQ_OK);
    assert_int_equal(chdir(before), 0);
    free(before);
    assert_holds(at("plain"), "here");
    unlink(at("plain"));
}

static void test_pipe_takes_bytes_in_order(void **state) {
    (void)state;
    lq_error error;
    char read_back[8] = "";
    assert_int_equal(mkfifo(at("pipe"), 0600), 0);
    int reader = open(at("pipe"), O_RDONLY | O_NONBLOCK);
    lq_output *output = open_output(at("pipe"));
    assert_int_equal(lq_output_write_at(output, "ab", 2, 0, &error), LQ_OK);
    assert_int_equal(lq_output_write_at(output, "cd", 2, 2, &error), LQ_OK);
    assert_int_equal(lq_output_write_at(output, "x", 1, 0, &error), LQ_IO);
    assert_contains(error.text, "accepted is a regular file");
    lq_output_abandon(output);
    assert_int_equal(read(reader, read_back, 7), 4);
    assert_string_equal(read_back, "abcd");
    close(reader);
    unlink(at("pipe"));
}

/* ------------------------------------------------------------------ failure */

static void test_abandon(void **state) {
    (void)state;
    write_old(at("d"));
    lq_output *output = open_output(at("d"));
    lq_output_print(output, NULL, "new");
    lq_output_abandon(output);
    lq_output_abandon(NULL);
    assert_holds(at("d"), "old");
    assert_int_equal(files_in_folder(), 1);
    unlink(at("d"));
}

static void refuse_open(const char *path, const char *part) {
    lq_output *output = (lq_output *)1;
    lq_error error = {""};
    assert_int_equal(lq_output_open(&output, path, &error), LQ_IO);
    assert_null(output);
    assert_contains(error.text, path);
    assert_contains(error.text, part);
    assert_contains(error.text, "accepted");
}

static void test_refused_targets(void **state) {
    (void)state;
    char name[300] = "";
    memset(name, 'n', 299);
    write_old(at("file"));
    refuse_open("", "empty file name");
    refuse_open(folder, "is a folder");
    refuse_open(at("new/"), "is a folder");
    refuse_open(at("none/x"), "/none' does not exist");
    refuse_open(at("file/x"), "/file' is not a folder");
    refuse_open(at(name), "too long");
    unlink(at("file"));
    assert_int_equal(files_in_folder(), 0);
}

/* What root may not be refused, another user is: 77 stands for "could not become one". */
static int as_nobody(void) {
    lq_output *output;
    lq_error error;
    if (geteuid() == 0 && seteuid(65534) != 0) return 77;
    if (lq_output_open(&output, at("locked/x"), &error) != LQ_IO) return 1;
    if (!strstr(error.text, "Permission denied; accepted is a writable folder")) return 2;
    if (lq_output_open(&output, at("file"), &error) != LQ_IO) return 3;
    return strstr(error.text, "accepted is a file that may be replaced") ? 0 : 4;
}

static void test_unwritable(void **state) {
    (void)state;
    write_old(at("file"));
    assert_int_equal(chmod(at("file"), 0444), 0);
    assert_int_equal(chmod(folder, 0755), 0);
    assert_int_equal(mkdir(at("locked"), 0555), 0);
    pid_t child = fork();
    if (child == 0) _exit(as_nobody());
    int result;
    assert_int_equal(waitpid(child, &result, 0), child);
    rmdir(at("locked"));
    unlink(at("file"));
    assert_true(WIFEXITED(result));
    if (WEXITSTATUS(result) == 77) skip();
    assert_int_equal(WEXITSTATUS(result), 0);
}

static void limit_files(rlim_t size, struct rlimit *old) {
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, old), 0);
    struct rlimit low = *old;
    low.rlim_cur = size;
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &low), 0);
}

static lq_table *make_table(void) {
    lq_axis axes[2];
    const char *channels[] = {"a", "b"};
    lq_table *table;
    assert_int_equal(lq_axis_make(&axes[0], "x", 0, 1, 64, LQ_MAP_LINEAR, 0, NULL), LQ_OK);
    assert_int_equal(lq_axis_make(&axes[1], "y", 0, 1, 2048, LQ_MAP_LINEAR, 0, NULL), LQ_OK);
    assert_int_equal(lq_table_create(&table, axes, 2, channels, 2, NULL), LQ_OK);
    for (size_t k = 0; k < lq_table_entries(table); k++)
        table->channels[0][k] = 1 / (1 + (float)k), table->channels[1][k] = 1 / (2 + (float)k);
    lq_axis_free(&axes[0]);
    lq_axis_free(&axes[1]);
    return table;
}

/* The disk is full after 0, 100, ... bytes: in the header, in the data, at the end. */
static void test_full_disk(void **state) {
    (void)state;
    const rlim_t limits[] = {0, 100, 1000, 4096, 100000, 400000};
    lq_table *table = make_table();
    write_old(at("t"));
    for (size_t i = 0; i < sizeof limits / sizeof *limits; i++) {
        struct rlimit old;
        lq_error exr, npy;
        limit_files(limits[i], &old);
        lq_status exr_status = lq_table_write_exr(table, at("t"), &exr);
        lq_status npy_status = lq_table_write_npy(table, at("t"), &npy);
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &old), 0);
        assert_int_equal(exr_status, LQ_IO);
        assert_int_equal(npy_status, LQ_IO);
        assert_contains(exr.text, "/t: cannot write: File too large; accepted is a place with room");
        assert_contains(npy.text, "/t: cannot write: File too large; accepted is a place with room");
        assert_int_equal(files_in_folder(), 1);
        assert_holds(at("t"), "old");
    }
    unlink(at("t"));
    lq_table_free(table);
}

static void test_dev_full(void **state) {
    (void)state;
    lq_error error;
    lq_output *output = open_output("/dev/full");
    assert_int_equal(lq_output_print(output, &error, "text"), LQ_OK); /* in the buffer */
    assert_int_equal(lq_output_commit(output, &error), LQ_IO);
    assert_contains(error.text, "/dev/full: cannot write: No space left on device; accepted");
    output = open_output("/dev/full");
    assert_int_equal(lq_output_write_at(output, "x", 1, 0, &error), LQ_IO);
    lq_output_abandon(output);
    output = open_output("/dev/null");
    lq_output_print(output, NULL, "text");
    assert_int_equal(lq_output_commit(output, &error), LQ_OK);
    struct stat info;
    assert_int_equal(stat("/dev/null", &info), 0);
    assert_true(S_ISCHR(info.st_mode));
}

/* Even a killed writer leaves nothing. */
static void test_killed(void **state) {
    (void)state;
    write_old(at("k"));
    pid_t child = fork();
    if (child == 0) {
        lq_output *output;
        if (lq_output_open(&output, at("k"), NULL)) _exit(1);
        lq_output_write_at(output, "new", 3, 0, NULL);
        kill(getpid(), SIGKILL);
    }
    int result;
    assert_int_equal(waitpid(child, &result, 0), child);
    assert_true(WIFSIGNALED(result));
    assert_int_equal(files_in_folder(), 1);
    assert_holds(at("k"), "old");
    unlink(at("k"));
}

/* The folder goes away, or a folder takes the name, while the file is being written. */
static void test_target_changes(void **state) {
    (void)state;
    lq_error error;
    assert_int_equal(mkdir(at("sub"), 0755), 0);
    lq_output *output = open_output(at("sub/x"));
    assert_int_equal(rmdir(at("sub")), 0);
    assert_int_equal(lq_output_commit(output, &error), LQ_IO);
    assert_contains(error.text, "does not exist");
    output = open_output(at("x"));
    assert_int_equal(mkdir(at("x"), 0755), 0);
    assert_int_equal(lq_output_commit(output, &error), LQ_IO);
    assert_contains(error.text, "Is a directory");
    assert_int_equal(rmdir(at("x")), 0);
    assert_int_equal(files_in_folder(), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_commit_replaces),
        cmocka_unit_test(test_new_file_has_umask_permissions),
        cmocka_unit_test(test_more_than_the_buffer),
        cmocka_unit_test(test_link_is_followed),
        cmocka_unit_test(test_file_in_the_current_folder),
        cmocka_unit_test(test_pipe_takes_bytes_in_order),
        cmocka_unit_test(test_abandon),
        cmocka_unit_test(test_refused_targets),
        cmocka_unit_test(test_unwritable),
        cmocka_unit_test(test_full_disk),
        cmocka_unit_test(test_dev_full),
        cmocka_unit_test(test_killed),
        cmocka_unit_test(test_target_changes),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
