/* parallel.c - the one parallel loop. */
#include "system/parallel.h"

#include <omp.h>
#include <stdatomic.h>

#include "system/status.h"

typedef struct loop {
    size_t count;
    lq_turn *turn;
    void *user;
    const lq_progress *progress;
    atomic_size_t next;   /* the turn to hand out */
    atomic_size_t failed; /* the lowest turn that failed; count: none */
    size_t done;          /* from here on behind the critical section */
    bool missed, cancelled;
    lq_status status; /* of turn `failed` */
    lq_error message;
} loop;

int lq_parallel_threads(size_t count, int threads) {
    if (omp_in_parallel()) return 1;
    if (threads <= 0) threads = omp_get_max_threads();
    return count == 0 ? 1 : count < (size_t)threads ? (int)count : threads;
}

/* Turns are handed out in order, so every turn below one that failed has started and will be recorded too:
 * the lowest failure is found whatever the timing. */
static void record(loop *l, size_t index, lq_status status, const lq_error *message) {
    l->done++;
    if (status == LQ_NOT_CONVERGED) l->missed = true;
    else if (status != LQ_OK && index < atomic_load(&l->failed)) {
        l->status = status;
        l->message = *message;
        atomic_store(&l->failed, index);
    }
    if (l->progress && l->progress->report && !l->cancelled &&
        !l->progress->report(l->progress->user, (double)l->done / (double)l->count)) {
        l->cancelled = true;
        atomic_store(&l->next, l->count);
    }
}

static void work(loop *l, int thread) {
    for (;;) {
        const size_t index = atomic_fetch_add(&l->next, 1);
        if (index >= l->count || index > atomic_load(&l->failed)) return;
        lq_error message = {""};
        const lq_status status = l->turn(l->user, index, thread, &message);
#pragma omp critical(lq_parallel_record)
        record(l, index, status, &message);
    }
}

lq_status lq_parallel(size_t count, int threads, lq_turn *turn, void *user, const lq_progress *progress,
                      lq_error *error) {
    loop l = {.count = count, .turn = turn, .user = user, .progress = progress, .failed = count};
    threads = lq_parallel_threads(count, threads);
    if (threads == 1) work(&l, 0);
    else {
#pragma omp parallel num_threads(threads)
        work(&l, omp_get_thread_num());
    }
    if (l.failed < count) return lq_fail(error, l.status, "%s", l.message.text);
    if (l.cancelled) return lq_fail(error, LQ_CANCELLED, "stopped");
    return l.missed ? LQ_NOT_CONVERGED : LQ_OK;
}

int lq_threads_set(int threads) {
    const int before = omp_get_max_threads();
    if (threads > 0) omp_set_num_threads(threads);
    return before;
}
