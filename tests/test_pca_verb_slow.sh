#!/usr/bin/env bash
# `lacquer pca` on small computed tables: both schemes, searches, exit codes, files, refusals.
set -euo pipefail
lacquer=${LACQUER:?}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
failed=0

fail() {
    echo "FAIL: $*" >&2
    failed=1
}

# run CODE ARGUMENT...: exit code as stated, output in `out`, messages in `err`
run() {
    local want=$1 code=0
    shift
    "$lacquer" "$@" >out 2>err || code=$?
    [ "$code" -eq "$want" ] || fail "lacquer $*: exit $code, not $want: $(cat err)"
}

refused() { # PATTERN ARGUMENT...
    local pattern=$1
    shift
    run 1 "$@"
    [ "$(wc -l <err)" -eq 1 ] || fail "lacquer $*: $(wc -l <err) lines on stderr"
    grep -qE -- "$pattern" err || fail "lacquer $*: '$(cat err)' does not match '$pattern'"
}

# below LIMIT: the largest error of the last line is below it
below() {
    tail -1 out | sed -E 's/.*max ([0-9.e+-]+) over.*/\1/' | awk -v limit="$1" '{exit !($1 < limit)}' ||
        fail "max is not below $1: $(tail -1 out)"
}

run 0 precompute diffuse-transmission --axis eta=1.1:2:10 --axis alpha=0.1:1:10 --axis tau=0.02:1:12 -o t10.exr
run 0 precompute transmission --axis mu=0.1:1:16:sqrt --axis alpha=0.1:1:8 --axis eta=1.2:2:6 \
    --axis tau=0.05:1:8 -o t01.exr

# ------------------------------------------------------------------------------ both schemes
run 0 pca t01.exr --separate tau:2,alpha:4 --scheme sequential --random 2 -o d22.exr
grep -q 'sequential tau:2|alpha:4' out || fail "the report does not name the scheme: $(cat out)"
below 0.06
run 0 pca t01.exr --separate tau,eta --value beer --bases 3,4 --sweeps 8 --random 2 -o joint.exr
grep -q 'against the solver at random points' out || fail "errors are not off the grid"
below 0.01
run 0 pca t01.exr --separate tau,eta --value beer --bases 3,4 --sweeps 8 --random 2 --threads 1 -o one.exr
cmp -s joint.exr one.exr || fail "one thread gives other bits than all cores"
"$lacquer" eval --from joint.exr mu=0.5 alpha=0.3 eta=1.5 tau=0.5 >out
"$lacquer" eval transmission mu=0.5 alpha=0.3 eta=1.5 tau=0.5 >>out
awk 'NR == 1 {got = $1} END {exit !(NR == 2 && got - $1 < 5e-3 && $1 - got < 5e-3)}' out ||
    fail "eval --from factors: $(cat out)"
run 0 info joint.exr
grep -q 'pca-max' out || fail "the file does not state its error"

# ------------------------------------------------------------------------------ searches
run 0 pca t10.exr --budget 5e-3 --random 3 --csv tries.csv --svg tries.svg -o t10-factors.exr
below 5e-3
grep -q '^<svg' tries.svg || fail "no chart"
head -1 tries.csv | grep -q '^piece,factors,bytes,points,rms,p99,max,worst_eta' || fail "CSV: $(head -1 tries.csv)"
awk -F, 'NR > 1 && NF != 11 {exit 1}' tries.csv || fail "CSV lines of another length"
bytes=$(awk -F, '$NF == 1 {print $3}' tries.csv | tail -1)
run 0 pca t10.exr --bytes 600 --random 3 -o small.exr
awk '/: [0-9]+ bytes/ {if ($2 > 600) exit 1}' out || fail "more than 600 bytes: $(tail -1 out)"
[ "$bytes" -lt 2400 ] || fail "the budget took $bytes bytes"
run 2 pca t10.exr --budget 1e-8 --random 3 -o best.exr
[ -s best.exr ] || fail "exit 2 without the best there was"

# ------------------------------------------------------------------------------ refusals
refused 'unknown axis .n.; the table has: mu, alpha, eta, tau' pca t01.exr --separate n:2 -o x.exr
refused 'separate more' pca t01.exr --separate tau:2 -o x.exr
refused 'must be separated' pca t01.exr --separate alpha,eta --value beer -o x.exr
refused 'below 1 in one plane' pca t01.exr --separate tau,alpha --critical -o x.exr
refused 'nodes inside' pca t01.exr --separate tau,eta --split eta=1.3 -o x.exr
refused 'no table' pca -o x.exr
refused 'no output file' pca t01.exr --separate tau,eta
refused '--separate has no effect with --budget and --bytes' pca t01.exr --budget 1e-2 --separate tau,eta -o x.exr
refused 'is not one of: sequential, joint' pca t01.exr --scheme tucker -o x.exr
refused 'nothere.exr' pca nothere.exr --separate tau,eta -o x.exr
refused 'is a folder' pca t01.exr --separate tau,eta -o .
[ ! -e x.exr ] || fail "a refused command left a file"

# A table that does not say how it was made gets the errors of its nodes, and a line that says so.
run 0 precompute albedo --axis mu=0:1:8 --axis alpha=0.1:1:8 -o albedo.exr
run 0 pca albedo.exr --nodes-only -o plain.exr
below 1e-3
exit "$failed"
