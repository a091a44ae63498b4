#!/usr/bin/env bash
# The disk is full at a call that changes a file, or the process is killed before it, each in turn (every
# LACQUER_FAULT_STEP-th; all of them in test_faults_long.sh). Full: one line and exit 1, or the same result; the older
# file or folder stands; nothing else is left. Killed: what is there is the old or the new one, whole, and the next run
# clears what was left over.
set -euo pipefail
: "${LACQUER:?path of the program}" "${LACQUER_SOURCE:?source folder}"
source "$LACQUER_SOURCE/tests/expect.sh"
work=$(mktemp -d)
trap 'chmod -R u+w "$work"; rm -rf "$work"' EXIT
cd "$work"
export XDG_CACHE_HOME=$work/xdg OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
step=${LACQUER_FAULT_STEP:-61}
rounds=$([ "$step" -gt 1 ] && echo 1 || echo "1 2 3 4")
if nm "$LACQUER" 2>/dev/null | grep -E '__(asan|tsan|gcov)_init' >/dev/null ||
    ! "${CC:-cc}" -O1 -shared -fPIC "$LACQUER_SOURCE/tests/preload/failing_calls.c" -o failing.so -ldl; then
    exit 77 # sanitizers are to be loaded first
fi

with() { # NAME=VALUE ARGUMENTS...: in the folder `place`, under the failing calls
    local setting=$1
    shift
    { (cd place && timeout 60 env "$setting" LD_PRELOAD="$work/failing.so" "$LACQUER" "$@" >../out 2>../err); } 2>/dev/null
}

whole() { # WHAT: every result that is there is the old one or the new one; `strict`: and nothing else is there
    local name
    for name in $(ls -A place); do
        case " $inputs " in *" $name "*) continue ;; esac
        if [ "$name" = cache ]; then # entries of it may be missing
            for name in $(cd place/cache && find . -name '*.exr' -maxdepth 1); do
                cmp -s "place/cache/$name" "new/cache/$name" || fail "$1: the entry $name of the cache is another"
            done
            continue
        fi
        case " $results " in
        *" $name "*)
            # Killed: a folder may be there, with nothing in it but what the next run clears.
            [ "${strict:-}" != no ] || [ ! -d "place/$name" ] || [ -n "$(find "place/$name" -type f ! -name '.lacquer-*')" ] || continue
            diff -rq -x '.lacquer-*' "place/$name" "old/$name" >/dev/null 2>&1 ||
                diff -rq -x '.lacquer-*' "place/$name" "new/$name" >/dev/null 2>&1 ||
                fail "$1: $name is neither the old nor the new one"
            ;;
        *) [ "${strict:-}" = no ] || fail "$1: left $name" ;;
        esac
    done
    for name in $results; do
        [ -e "place/$name" ] || [ ! -e "old/$name" ] || fail "$1: the old $name is lost"
    done
    [ "${strict:-}" = no ] || [ -z "$(find place -name 'new-*' -o -name '*.new-*' -o -name '.lacquer-*')" ] ||
        fail "$1: left $(find place -name 'new-*' -o -name '*.new-*' -o -name '.lacquer-*')"
}

fresh() {
    rm -rf place
    cp -r start place
    for result in $results; do [ ! -e "old/$result" ] || cp -r "old/$result" place/; done
}

# faults "INPUT..." "RESULT..." ARGUMENTS...: over results that are not there, and over others that are.
faults() {
    inputs=$1 results=$2
    shift 2
    local at code over
    rm -rf start new old && mkdir start new old
    for input in $inputs; do cp -r "$input" start/; done
    fresh
    with LACQUER_CALLS="$work/count" "$@" || { [ $? -eq 2 ] || fail "$*: $(cat err)"; }
    for result in $results; do cp -r "place/$result" new/; done
    [ "$(cat count)" -ge 3 ] || fail "$*: only $(cat count) calls were counted"
    echo "$(cat count) calls: lacquer $*"
    for over in $([ "$step" -gt 1 ] || echo no) yes; do
        if [ $over = yes ]; then
            for result in $results; do
                if [ -d "new/$result" ]; then cp -r new/"$result" old/; else echo old >old/"$result"; fi
            done
        fi
        fresh
        with LACQUER_CALLS="$work/count" "$@" || true
        for ((at = 1; at <= $(cat count); at += step)); do
            fresh
            code=0 && with LACQUER_DENY_AT=$at "$@" || code=$?
            [ "$code" -eq 0 ] || [ "$code" -eq 2 ] || { [ "$code" -eq 1 ] && [ "$(wc -l <err)" -eq 1 ]; } ||
                fail "full at call $at: $*: exit $code: $(cat err)"
            [ "$code" -ne 1 ] || [ "$results" = - ] || grep -qE 'No space left' err || fail "full at $at: $*: $(cat err)"
            whole "full at call $at: $*"
            fresh
            code=0 && with LACQUER_KILL_AT=$at "$@" || code=$?
            strict=no whole "killed at call $at: $*"
            with NOTHING= "$@" || { [ $? -eq 2 ] || fail "after a kill at call $at: $*: $(cat err)"; }
            whole "after a kill at call $at: $*"
            for result in $results; do
                diff -rq "place/$result" "new/$result" >/dev/null || fail "after a kill at $at: $*: another $result"
            done
        done
    done
}

"$LACQUER" precompute albedo --axis mu=0.1:1:6 --axis alpha=0.2:1:5 --tolerance 1e-3 -o small.exr >/dev/null
cat >small.json <<'END'
{"name": "small", "formats": ["ktx2", "c"], "points": 100,
 "tables": [{"table": "albedo", "axes": {"mu": "0:1:4", "alpha": "0.1:1:4"}, "tolerance": 1e-2}]}
END
echo 'mu,alpha' >points.csv
faults "" a.exr precompute albedo --axis mu=0.1:1:4 --axis alpha=0.2:1:3 -o a.exr
faults "" a.npy precompute albedo --axis mu=0.1:1:4 --axis alpha=0.2:1:3 --format npy -o a.npy
faults small.exr "f.exr f.csv f.svg" pca small.exr --nodes-only --separate alpha:2 -o f.exr --csv f.csv --svg f.svg
faults small.exr "c.xml c.html" validate small.exr --certificate --points 200 --junit c.xml --report c.html
faults small.exr v.png view small.exr -o v.png
faults small.exr v.html view small.exr -o v.html
faults small.json "p cache" pack small.json -o p --cache cache

# ------------------------------------------------------------------ a folder that cannot be written
if [ "$(id -u)" -eq 0 ] && setpriv --reuid 65534 --regid 65534 --clear-groups "$LACQUER" --version >/dev/null 2>&1; then
    as=(setpriv --reuid 65534 --regid 65534 --clear-groups)
else
    as=()
fi
if [ "$(id -u)" -ne 0 ] || [ ${#as[@]} -gt 0 ]; then
    chmod 755 . && mkdir locked && echo old >locked/a.exr && cp small.exr small.json locked/ && chmod -R a+rX,a-w locked
    ls -lAR locked >before
    for verb in "precompute albedo --axis mu=0.1:1:4 --axis alpha=0.2:1:3 -o" "pca small.exr --nodes-only --separate alpha:2 -o" \
        "view small.exr -o" "pack small.json --cache /proc/none -o" "validate small.exr --points 200 --junit"; do
        for target in a.exr new.exr; do
            code=0
            # shellcheck disable=SC2086 # a verb and its words
            (cd locked && "${as[@]}" "$LACQUER" $verb $target >../out 2>../err) || code=$?
            [ "$code" -eq 1 ] && [ "$(grep -vc 'going on without' err)" -eq 1 ] || fail "read-only: $verb: $code, $(cat err)"
        done
    done
    ls -lAR locked | diff before - || fail "a read-only folder changed"
fi

# ------------------------------------------------------------------ two runs, one target, one cache
for round in $rounds; do
    rm -rf twice cache2
    "$LACQUER" pack small.json -o twice --cache cache2 >/dev/null 2>err1 &
    first=$!
    "$LACQUER" pack small.json -o twice --cache cache2 >/dev/null 2>err2 &
    second=$!
    wait $first || grep -q 'cannot replace' err1 || fail "two packs: $(cat err1)"
    wait $second || grep -q 'cannot replace' err2 || fail "two packs: $(cat err2)"
    "$LACQUER" pack small.json -o alone --cache cache3 >/dev/null
    diff -r twice alone || fail "two packs at once make another one, round $round"
    [ -z "$(find . -maxdepth 2 -name '*new-*')" ] || fail "two packs leave $(find . -maxdepth 2 -name '*new-*')"
    "$LACQUER" precompute albedo --axis mu=0.1:1:4 --axis alpha=0.2:1:3 -o both.exr >/dev/null &
    first=$!
    "$LACQUER" precompute albedo --axis mu=0.1:1:4 --axis alpha=0.2:1:3 -o both.exr >/dev/null || fail "two tables"
    wait $first || fail "two tables"
    "$LACQUER" precompute albedo --axis mu=0.1:1:4 --axis alpha=0.2:1:3 -o one.exr >/dev/null
    [ "$("$LACQUER" info --format json both.exr | sed 's/both/one/')" = "$("$LACQUER" info --format json one.exr)" ] ||
        fail "two runs into one table"
done
[ -z "$(find . -maxdepth 1 -name '.lacquer-*')" ] || fail "two runs leave $(ls -A)"

[ "$failures" -eq 0 ]
