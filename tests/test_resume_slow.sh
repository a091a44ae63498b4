#!/usr/bin/env bash
# Long work that is killed: what was finished is taken up, what is made of it is the same to the last bit, and nothing
# else is mixed in.
set -euo pipefail
: "${LACQUER:?path of the program}" "${LACQUER_SOURCE:?source folder}"
source "$LACQUER_SOURCE/tests/expect.sh"
own_folder
export OMP_NUM_THREADS=2 OPENBLAS_NUM_THREADS=1
args="fgd --axis mu=0:1:5 --axis alpha=0.02:1:70 --axis n=0.2:4:7 --axis kappa=0:4:6"

# Parts that are there when the run is killed; half of a second is short beside the whole.
# shellcheck disable=SC2086
"$LACQUER" precompute $args -o whole.exr >/dev/null
(exec "$LACQUER" precompute $args --resume --threads 1 -o t.exr >/dev/null) &
pid=$!
for _ in $(seq 400); do
    [ "$(find t.exr.parts -name '00*' 2>/dev/null | wc -l)" -lt 3 ] || break
    sleep 0.01
done
kill -9 $pid 2>/dev/null || true
wait $pid 2>/dev/null || true
[ ! -e t.exr ] || fail "the table was there before the kill"
kept=$(find t.exr.parts -name '00*' | wc -l)
[ "$kept" -ge 3 ] || fail "only $kept parts were kept"

# Other options are refused, and cost nothing of what is there.
# shellcheck disable=SC2086
! "$LACQUER" precompute $args --tolerance 1e-4 --resume -o t.exr 2>err || fail "parts of another tolerance were taken"
grep -q "t.exr.parts: has finished parts of other work ('tolerance 1e-05', not 'tolerance 0.0001')" err || fail "$(cat err)"
[ "$(wc -l <err)" = 1 ] || fail "more than a line: $(cat err)"
[ "$(find t.exr.parts -name '00*' | wc -l)" = "$kept" ] || fail "a refusal removed parts"

# One that is damaged is made anew; one cut short too.
printf x | dd of=t.exr.parts/0000001 bs=1 seek=100 conv=notrunc status=none
truncate -s 50 t.exr.parts/0000002
# shellcheck disable=SC2086
said=$("$LACQUER" precompute $args --resume -o t.exr)
case $said in *", $((kept - 2)) parts from before") ;; *) fail "of $kept parts, two damaged: $said" ;; esac
cmp t.exr whole.exr || fail "the table that was taken up is another"
[ ! -e t.exr.parts ] || fail "parts are left of a table that is whole"

# While one is at work there, another is refused.
mkdir t.exr.parts
exec 9>t.exr.parts/lock
flock 9
# shellcheck disable=SC2086
! "$LACQUER" precompute $args --resume -o t.exr 2>err || fail "two runs in one folder"
grep -q 'another run is at work there' err || fail "$(cat err)"
exec 9>&-

# A folder of somebody's own is none of parts.
echo mine >t.exr.parts/notes
# shellcheck disable=SC2086
! "$LACQUER" precompute $args --resume -o t.exr 2>err || fail "parts among other files"
grep -q 'not a folder of finished parts' err && [ -e t.exr.parts/notes ] || fail "$(cat err)"
! "$LACQUER" precompute albedo --resume --format exr -o /dev/null 2>err || fail "parts beside a device"
grep -q -- '--resume: /dev/null is no file that parts can lie beside' err || fail "$(cat err)"
[ "$failures" -eq 0 ]
