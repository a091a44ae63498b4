#!/usr/bin/env bash
# Several processes make the same table, to the last bit, as one; where one is killed all end, and --resume goes on.
# Skipped where lacquer-mpi is not built.
set -euo pipefail
: "${LACQUER:?path of the program}" "${LACQUER_SOURCE:?source folder}"
source "$LACQUER_SOURCE/tests/expect.sh"
mpi=$(dirname "$LACQUER")/lacquer-mpi
[ -x "$mpi" ] && command -v mpirun >/dev/null || exit 77
own_folder
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
args="fgd --axis mu=0:1:5 --axis alpha=0.02:1:50 --axis n=0.2:4:7 --axis kappa=0:4:6"

ranks() { # N ARGUMENTS...
    local count=$1
    shift
    timeout 120 mpirun --oversubscribe --allow-run-as-root -n "$count" "$mpi" "$@"
}

# shellcheck disable=SC2086
"$LACQUER" precompute $args -o one.exr >/dev/null
for count in 1 2 4; do
    # shellcheck disable=SC2086
    ranks $count precompute $args --resume -o t.exr >out 2>err || fail "$count processes: $(cat err)"
    [ "$(wc -l <out)" = 1 ] || fail "$count processes print more than one: $(cat out)"
    cmp one.exr t.exr || fail "$count processes make another table"
    [ ! -e t.exr.parts ] || fail "$count processes left parts"
    rm t.exr
done

# One is killed in the middle: all end, what is finished stays, and one process alone takes it up.
# shellcheck disable=SC2086
ranks 2 precompute $args --resume -o t.exr >out 2>err &
run=$!
for _ in $(seq 1000); do
    [ "$(find t.exr.parts -name '00*' 2>/dev/null | wc -l)" -lt 3 ] || break
    sleep 0.01
done
kill -9 "$(pgrep -f "^$mpi precompute .*-o t.exr" | tail -1)"
! wait $run || fail "a process was killed, and the run says that it is done"
[ ! -e t.exr ] || fail "the table was there before the kill"
# shellcheck disable=SC2086
said=$("$LACQUER" precompute $args --resume -o t.exr)
case $said in *" parts from before") ;; *) fail "nothing was taken up: $said" ;; esac
cmp one.exr t.exr || fail "the table that was taken up is another"

# One line for all of them.
complains() { # TEXT ARGUMENTS...
    local text=$1
    shift
    ! ranks 2 "$@" >out 2>err || fail "$*: not refused"
    [ "$(grep -c '^lacquer' err)" = 1 ] && grep -q -- "$text" err || fail "$*: $(cat err)"
}
# shellcheck disable=SC2086
complains 'add --resume' precompute $args -o t.exr
complains 'work for one process' list
mkdir -p t.exr.parts && echo mine >t.exr.parts/notes
# shellcheck disable=SC2086
complains 'not a folder of finished parts' precompute $args --resume -o t.exr
[ "$failures" -eq 0 ]
