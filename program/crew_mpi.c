/* crew_mpi.c - lacquer-mpi: as many processes as mpirun started. They meet between rounds of parts and send
 * no more than a status or a number: parts are files. Whoever waits sleeps, for MPI's own waiting would take
 * a core from those that work.
 */
#define _GNU_SOURCE /* memfd_create */
#include "program/crew.h"

#include <mpi.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#include "program/verb.h"

/* The last meeting of all, apart from those of the work: who comes there early is not taken for one of these.
 */
static MPI_Comm last;
static lq_crew crew;
static bool agreed;    /* all know of a failure */
static int quiet = -1; /* what a process that is not the first prints on stderr */

/* Waits without a core of its own; false: not within so many seconds (0: however long). */
static bool wait_for(MPI_Request *request, double seconds) {
    struct timespec nap = {0, 100000};
    double waited = 0.0;
    for (int done = 0; MPI_Test(request, &done, MPI_STATUS_IGNORE), !done;) {
        nanosleep(&nap, NULL);
        waited += 1e-9 * (double)nap.tv_nsec;
        if (nap.tv_nsec < 10000000) nap.tv_nsec *= 2;
        if (seconds > 0.0 && waited > seconds) return false;
    }
    return true;
}

static void share(void *user, void *bytes, size_t size) {
    MPI_Request request;
    (void)user;
    MPI_Ibcast(bytes, (int)size, MPI_BYTE, 0, MPI_COMM_WORLD, &request);
    wait_for(&request, 0.0);
}

typedef struct outcome {
    lq_status status;
    lq_error error;
} outcome;

static lq_status meet(void *user, lq_status status, lq_error *error) {
    MPI_Request request;
    const int mine = status == LQ_OK ? crew.size : crew.rank;
    int lowest = crew.size;
    outcome of_lowest = {.status = status};
    (void)user;
    MPI_Iallreduce(&mine, &lowest, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD, &request);
    wait_for(&request, 0.0);
    if (lowest == crew.size) return LQ_OK;
    agreed = true;
    if (error) of_lowest.error = *error;
    MPI_Ibcast(&of_lowest, (int)sizeof of_lowest, MPI_BYTE, lowest, MPI_COMM_WORLD, &request);
    wait_for(&request, 0.0);
    if (error) *error = of_lowest.error;
    return of_lowest.status;
}

/* One line a run, not one a process: the others keep theirs. */
static void be_quiet(void) {
    fflush(stdout);
    if (!freopen("/dev/null", "w", stdout)) return;
    quiet = memfd_create("stderr", MFD_CLOEXEC);
    const int loud = dup(STDERR_FILENO);
    if (quiet < 0 || loud < 0 || dup2(quiet, STDERR_FILENO) < 0) return;
    quiet = loud;
}

static void speak_after_all(void) {
    char line[LQ_MESSAGE_SIZE + 64];
    if (quiet < 0) return;
    const ssize_t size = pread(STDERR_FILENO, line, sizeof line, 0);
    if (size > 0 && write(quiet, line, (size_t)size) < 0) return;
}

void cli_crew_begin(int *argc, char ***argv) {
    int level;
    MPI_Init_thread(argc, argv, MPI_THREAD_FUNNELED, &level);
    MPI_Comm_dup(MPI_COMM_WORLD, &last);
    MPI_Comm_rank(MPI_COMM_WORLD, &crew.rank);
    MPI_Comm_size(MPI_COMM_WORLD, &crew.size);
    crew.meet = meet;
    crew.share = share;
    if (crew.size > 1) cli_crew_set(&crew);
    if (crew.rank > 0) be_quiet();
}

/* A failure that the others do not know of keeps them waiting for this process: it ends them. One before the
 * first meeting is of the arguments, as a rule, and everybody's. */
int cli_crew_end(int code) {
    enum { PATIENCE = 10 };
    MPI_Request request;
    const bool alone = (code == CLI_FAILED || code == CLI_INTERRUPTED) && !agreed;
    MPI_Ibarrier(last, &request);
    if (!wait_for(&request, alone ? PATIENCE : 0.0)) {
        speak_after_all();
        MPI_Abort(MPI_COMM_WORLD, code);
    }
    /* All is said: the first process to leave with a failure makes mpirun end the others, which is no
     * interruption. */
    signal(SIGTERM, SIG_DFL);
    signal(SIGINT, SIG_DFL);
    MPI_Finalize();
    return code;
}
