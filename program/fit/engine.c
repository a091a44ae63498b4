/* Finds lacquer-fit next to the program, or in libexec where it was installed, and has it solve a problem. */
#include "program/beside.h"
#include "program/fit/fit.h"
#include "program/message.h"

#include <limits.h>
#include <spawn.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

static bool find(char *path, size_t size) {
    static const char *const places[] = {"/lacquer-fit", "/../libexec/lacquer/lacquer-fit",
                                         "/../libexec/lacquer-fit"};
    if (cli_beside(places, 3, X_OK, path, size)) return true;
    cli_message("lacquer-fit was not built: it needs Ceres and a C++ compiler (Debian: apt-get install "
                "libceres-dev g++), then configure and build again");
    return false;
}

static FILE *ask(const lq_fit_problem *problem) {
    FILE *question = tmpfile();
    if (!question) return NULL;
    fprintf(question, "%d %zu %.17g %d\n", problem->family, problem->count, problem->loss, problem->rounds);
    for (size_t i = 0; i < problem->count; i++) {
        for (size_t k = 0; k < LQ_FAMILY_COORDINATES; k++)
            fprintf(question, "%.17g ", problem->x[i * LQ_FAMILY_COORDINATES + k]);
        fprintf(question, "%.17g\n", problem->y[i]);
    }
    if (fflush(question) == 0 && lseek(fileno(question), 0, SEEK_SET) == 0) return question;
    fclose(question);
    return NULL;
}

static bool understand(FILE *reply, lq_fit_answer *answer) {
    char line[512] = "";
    if (fscanf(reply, "ok %d", &answer->iterations) != 1) {
        if (!fgets(line, sizeof line, reply)) snprintf(line, sizeof line, "lacquer-fit gave no answer");
        line[strcspn(line, "\n")] = '\0';
        cli_message("%s", strncmp(line, "error: ", 7) == 0 ? line + 7 : line);
        return false;
    }
    int read = 0;
    for (int k = 0; k < LQ_FAMILY_PARAMETERS; k++) read += fscanf(reply, "%lf", &answer->p[k]) == 1;
    for (int k = 0; k < LQ_FAMILY_PARAMETERS * LQ_FAMILY_PARAMETERS; k++)
        read += fscanf(reply, "%lf", &answer->covariance[k]) == 1;
    if (read == LQ_FAMILY_PARAMETERS * (LQ_FAMILY_PARAMETERS + 1)) return true;
    cli_message("lacquer-fit broke off its answer; is it of this version?");
    return false;
}

bool fit_run_engine(const lq_fit_problem *problem, lq_fit_answer *answer) {
    char path[PATH_MAX];
    if (!find(path, sizeof path)) return false;
    FILE *question = ask(problem), *reply = tmpfile();
    bool done = false;
    pid_t child;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    char *const argv[] = {path, NULL};
    if (question && reply) {
        posix_spawn_file_actions_adddup2(&actions, fileno(question), 0);
        posix_spawn_file_actions_adddup2(&actions, fileno(reply), 1);
        int status;
        if (posix_spawn(&child, path, &actions, NULL, argv, environ) != 0) cli_message("cannot run %s", path);
        else if (waitpid(child, &status, 0) != child) cli_message("lost %s", path);
        else {
            rewind(reply);
            done = understand(reply, answer);
        }
    } else cli_message("no temporary file for lacquer-fit");
    posix_spawn_file_actions_destroy(&actions);
    if (question) fclose(question);
    if (reply) fclose(reply);
    return done;
}
