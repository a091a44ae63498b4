#!/usr/bin/env bash
# One allocation of a run fails, each of them in turn: the verb says so in one line and leaves nothing, or its result is
# the same. Never a crash, never another file.
set -euo pipefail
: "${LACQUER:?path of the program}" "${LACQUER_SOURCE:?source folder}"
source "$LACQUER_SOURCE/tests/expect.sh"
own_folder
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
if nm "$LACQUER" 2>/dev/null | grep -E '__(asan|tsan)_init' >/dev/null ||
    ! "${CC:-cc}" -O1 -shared -fPIC "$LACQUER_SOURCE/tests/preload/failing_malloc.c" -o failing.so -ldl; then
    exit 77 # sanitizers have an allocator of their own
fi

# with NAME=VALUE ARGUMENTS...: the program under the failing allocator.
with() {
    local setting=$1 code=0
    shift
    timeout 60 env "$setting" LD_PRELOAD="$work/failing.so" "$LACQUER" "$@" >out 2>err || code=$?
    return $code
}

# libgomp ends the process itself, with a line of its own after an empty one.
one_line() {
    [ "$(grep -vc '^$' err)" -eq 1 ]
}

judge() { # AT CODE RESULT ARGUMENTS...
    local at=$1 code=$2 result=$3
    shift 3
    if [ "$code" -eq 0 ]; then
        if [ "$result" = - ]; then cmp -s out reference || fail "$1, allocation $at: exit 0, prints something else"
        else diff -rq "$result" reference >/dev/null || fail "$1, allocation $at: exit 0, another result"; fi
    elif [ "$code" -ne 1 ]; then fail "$1, allocation $at: exit $code: $(cat err)"
    elif ! one_line; then fail "$1, allocation $at: not one line: $(cat err)"
    elif [ -e "$result" ]; then fail "$1, allocation $at: exit 1 leaves $result"; fi
}

# each STEP RESULT ARGUMENTS...: RESULT is the file or folder that is made; -: what is printed.
each() {
    local step=$1 result=$2 at code
    shift 2
    rm -rf cache reference "$result"
    with LACQUER_ALLOCATIONS="$work/count" "$@" || fail "$1: $(cat err)"
    if [ "$result" = - ]; then mv out reference; else mv "$result" reference; fi
    [ "$(cat count)" -gt 30 ] || fail "$1: only $(cat count) allocations were counted"
    for ((at = 1; at <= $(cat count); at += step)); do
        rm -rf cache
        code=0 && with LACQUER_FAIL_AT="$at" "$@" || code=$?
        judge "$at" "$code" "$result" "$@"
        rm -rf "$result"
    done
}

"$LACQUER" precompute albedo --axis mu=0.1:1:6 --axis alpha=0.2:1:5 --tolerance 1e-3 -o small.exr >/dev/null
cat >small.json <<'END'
{"name": "small", "formats": ["ktx2", "exr", "dds", "npy", "c"], "points": 100,
 "tables": [{"table": "dfg", "axes": {"mu": "0:1:4", "alpha": "0.1:1:4"}, "tolerance": 1e-2}]}
END
# Without the mends: `info --format json` printed incomplete objects, `precompute` wrote files without parts of their
# axes, `pack` empty decode functions, all with exit 0.
each 1 - eval fgd mu=0.3 alpha=0.5 n=0.2 kappa=3.9 --tolerance 1e-2 --format json
each 2 - info --format json small.exr
each 1 a.exr precompute albedo --axis mu=0.1:1:4 --axis alpha=0.2:1:3 -o a.exr --threads 1
each 4 - validate small.exr --points 4 --json --threads 1
each 3 p pack small.json -o p --threads 1 --cache cache
each 13 f.exr pca small.exr --nodes-only --separate alpha:2 -o f.exr --threads 1
cat >metal.json <<'END'
{"layers": [{"dielectric": {"n": 1.5, "alpha": 0.2}}, {"conductor": {"n": 0.2, "kappa": 3.9, "alpha": 0.3}}]}
END
each 23 - stack metal.json --mu 0.5 --format json --tolerance 1e-2
cat >scene.json <<'END'
{"name": "scene", "formats": ["npy"], "points": 100, "budget": {"p99": 0.2, "max": 0.9},
 "materials": [{"name": "gold", "layers": [{"dielectric": {"n": 1.5, "alpha": 0.2}},
   {"conductor": {"n": 0.2, "kappa": 3.9, "alpha": {"min": 0.2, "max": 0.4}}}]}]}
END
each 7 - stack metal.json --model b18-forward --mu 0.5 --format json
each 97 s.exr precompute stack --stack metal.json --axis mu=0.5:1:2 --tolerance 1e-1 -o s.exr --threads 1
each 11 - validate small.exr --certificate --points 200 --json --threads 1
each 5 v.html view small.exr -o v.html
# (Not v.png: fontconfig 2.14, which cairo asks for letters, crashes without memory.)
each 997 sc pack scene.json -o sc --threads 1 --cache cache

[ "$failures" -eq 0 ]
