#!/usr/bin/env bash
# Factored tables from a recipe to a pack: the same bytes for one and two threads, the shipped C and the published
# binaries against the exact solver, what the manifest says, refusals.
. "$(dirname "$0")/scratch.sh"
cat >small.json <<'END_OF_RECIPE'
{
  "name": "factored",
  "formats": ["ktx2", "npy", "c"], "points": 125, "budget": {"p99": 2e-2, "max": 5e-2},
  "tables": [
    {"table": "transmission", "name": "t-01", "tolerance": 1e-3,
     "axes": {"mu": "0.02:1:16:sqrt", "alpha": "0.02:1:8:sqrt", "eta": "1.2:2:6", "tau": "0.02:1:8"},
     "pca": {"separate": "tau,eta", "value": "beer", "bases": "2,3", "pairs": 2, "sweeps": 6}},
    {"table": "tir-pass", "axes": {"mu": "0:1:96", "alpha": "0.02:1:12", "eta": "0.4:0.98:16"}, "tolerance": 1e-3,
     "layouts": ["belcour"], "budget": {"p99": 5e-2, "max": 8e-2},
     "pca": {"separate": "alpha:5", "critical": true, "norm": "p99", "texels": "mu=48"}},
    {"table": "tir-loss", "axes": {"mu": "0:1:24", "alpha": "0.1:1:8", "eta": "0.2:0.8:8"}, "tolerance": 1e-3,
     "layouts": ["tm"], "budget": {"p99": 5e-2, "max": 5e-2}, "pca": {"budget": 5e-2}}
  ]
}
END_OF_RECIPE

# --------------------------------------------------- the same bytes; factors come from the cache
OMP_NUM_THREADS=1 "$lacquer" pack small.json -o one --cache c1 >first.txt
OMP_NUM_THREADS=2 "$lacquer" pack small.json -o two --cache c2 >second.txt
diff -r one two && diff first.txt second.txt || fail "files depend on the threads"
stat -c '%n %y' c1/* >before.txt
"$lacquer" pack small.json -o again --cache c1 >third.txt
stat -c '%n %y' c1/* | diff before.txt - || fail "the second run computed something"
diff -r one again && diff first.txt third.txt || fail "the second run"
for file in t-01.0_{0,1,2} tir-pass.0_{0,1}; do
    [ -s "one/$file.ktx2" ] || fail "no $file.ktx2"
    grep -q "\"$file.ktx2\"" one/manifest.json || fail "manifest does not name $file.ktx2"
done
grep -q '"pca": "{.*beer' one/manifest.json || fail "manifest does not say how factors were made"

# --------------------------------------------------- the shipped C, the manifest and the exact integral
cat >use.c <<'END_OF_C'
#include <stdio.h>
#include <stdlib.h>
#include "one/decode.h"
#include "one/t-01.0_0.h"
#include "one/t-01.0_1.h"
#include "one/t-01.0_2.h"
#include "one/tir-pass.0_0.h"
#include "one/tir-pass.0_1.h"
int main(int argc, char **argv) {
    float x[4] = {0};
    for (int a = 1; a < argc; a++) x[a - 1] = strtof(argv[a], 0);
    printf("%.6f\n", (double)(argc > 4 ? lacquer_t_01(lacquer_t_01_0_0_texels, lacquer_t_01_0_1_texels,
                                                      lacquer_t_01_0_2_texels, x[0], x[1], x[2], x[3])
                                       : lacquer_tir_pass(lacquer_tir_pass_0_0_texels,
                                                          lacquer_tir_pass_0_1_texels, x[0], x[1], x[2])));
    return 0;
}
END_OF_C
"${CC:-cc}" -std=c17 -Wall -Wextra -Werror -I. use.c -o use -lm
near() { # DECODED TABLE AXIS=VALUE...
    exact=$("$lacquer" eval "${@:2}" --tolerance 1e-3 | grep -oE '[0-9]\.[0-9]+' | head -1)
    awk -v a="$1" -v b="$exact" 'BEGIN { d = a - b; exit !(d < 3e-2 && d > -3e-2 && b > 0.05) }' ||
        fail "${*:2}: $1 decoded, $exact exact"
}
near "$(./use 0.5 0.3 1.5 0.7)" transmission mu=0.5 alpha=0.3 eta=1.5 tau=0.7
near "$(./use 0.1 0.05 1.3 0.95)" transmission mu=0.1 alpha=0.05 eta=1.3 tau=0.95
near "$(./use 0.95 0.9 1.9 0.3)" transmission mu=0.95 alpha=0.9 eta=1.9 tau=0.3
near "$(./use 0.9 0.1 0.66)" tir-pass mu=0.9 alpha=0.1 eta=0.66
near "$(./use 0.3 0.7 0.8)" tir-pass mu=0.3 alpha=0.7 eta=0.8

# --------------------------------------------------- published binaries of the same tables
"$lacquer" validate one/tir-pass.belcour.bin --layout belcour --kind tir-pass --points 200 >belcour.txt ||
    fail "belcour: $(cat belcour.txt)"
"$lacquer" validate one/tir-loss.tm.bin --layout tm --kind tir-loss --points 200 >tm.txt || fail "tm: $(cat tm.txt)"

# --------------------------------------------------- refusals: one line, and the target untouched
refuse() { # CODE PATTERN SED-EXPRESSION
    sed -E "$3" small.json >bad.json
    local code=0
    "$lacquer" pack bad.json -o one --cache c1 >/dev/null 2>message.txt || code=$?
    [ "$code" = "$1" ] || fail "exit $code instead of $1 for $3: $(cat message.txt)"
    [ "$(wc -l <message.txt)" = 1 ] || fail "not one line: $(cat message.txt)"
    grep -qE "$2" message.txt || fail "'$(cat message.txt)' does not match $2"
    diff -r one two || fail "target touched by $3"
}
refuse 1 "bad.json:7: unknown key 'base'; accepted: separate, value, bases" 's/"bases"/"base"/'
refuse 1 "bad.json:7: unknown value 'bear'; accepted: plain, square, beer" 's/"beer"/"bear"/'
refuse 1 "bad.json:7: separate: unknown axis 'eat'; the table has: mu, alpha, eta, tau" 's/"tau,eta"/"tau,eat"/'
refuse 1 "bad.json:7: 'pairs' is not understood; accepted: a whole number from 1 to 8" 's/"pairs": 2/"pairs": 9/'
refuse 1 "bad.json:7: bases: '0' is not a whole number from 1 to 64" 's/"2,3"/"0,3"/'
refuse 1 "bad.json:[67]: pca: 3 axes of the table stay together; accepted are 1 or 2" 's/"tau,eta"/"tau"/'
refuse 1 "bad.json:10: texels: 'nu=48' names no size|bad.json:10: texels: unknown axis 'nu'" 's/mu=48/nu=48/'
refuse 1 "bad.json:10: unknown norm 'p90'; accepted: max, rms, p99" 's/"norm": "p99"/"norm": "p90"/'
refuse 1 "bad.json:12: .*leave those out" 's/\{"budget": 5e-2\}/{"budget": 5e-2, "bases": "4"}/'
refuse 2 "bad.json:5: t-01 misses its budget: best reached p99 .*; asked p99 0.001, max 0.05" 's/"p99": 2e-2/"p99": 1e-3/'
refuse 2 "bad.json:11: tir-loss misses its budget: best reached .*; asked p99 0.05, max 0.001" \
    's/"pca": \{"budget": 5e-2\}/"pca": {"budget": 1e-3}/'
