#!/usr/bin/env bash
# lacquer pack: same bytes for any thread count and from the cache, complete or untouched, one line on bad recipes,
# the shipped C source against the exact integral, EXR read by OpenEXR's own tools.
. "$(dirname "$0")/scratch.sh"

cat >small.json <<'END'
{
  "name": "small",
  "formats": ["ktx2", "ktx2-zstd", "dds", "exr", "npy", "c"],
  "points": 200,
  "budget": {"p99": 5e-3, "max": 2e-2},
  "tables": [
    {"table": "dfg", "axes": {"mu": "0:1:24:sqrt", "alpha": "0:1:24"}, "tolerance": 1e-4},
    {"table": "albedo-average", "tolerance": 1e-4},
    {"table": "fgd", "name": "silver", "axes": {"mu": "0:1:24:sqrt", "alpha": "0:1:16", "n": "0.2", "kappa": "3.9"},
     "tolerance": 1e-4}
  ]
}
END

# --------------------------------------------------- the same bytes; the cache, shared by two runs
"$lacquer" pack small.json -o one --threads 1 >first.txt
cp -r one two_before
"$lacquer" pack small.json -o two --threads 2 --cache other >/dev/null &
first=$!
"$lacquer" pack small.json -o three --cache other >/dev/null || fail "two runs with one cache"
wait "$first" || fail "two runs with one cache, the other"
diff -r one two && diff -r one three || fail "files depend on the threads or the cache"
stat -c '%n %y' "$XDG_CACHE_HOME"/lacquer/* >before.txt
[ "$(wc -l <before.txt)" = 6 ] || fail "6 tables in the cache: $(cat before.txt)"
"$lacquer" pack small.json -o one >again.txt # replaces a pack
stat -c '%n %y' "$XDG_CACHE_HOME"/lacquer/* >after.txt
diff before.txt after.txt && diff first.txt again.txt && diff -r one two_before || fail "second run"
: >"$(find "$XDG_CACHE_HOME" -name '*.exr' | head -1)" # a damaged entry is no table
"$lacquer" pack small.json -o one >/dev/null && diff -r one two_before || fail "damaged cache"
[ -z "$(find . -maxdepth 1 -name '*.new-*')" ] || fail "staging left behind"

# --------------------------------------------------- bad recipes: one line, the line number, the target untouched
refuse() { # CODE PATTERN SED-EXPRESSION
    sed -E "$3" small.json >bad.json
    local code=0
    "$lacquer" pack bad.json -o one >/dev/null 2>message.txt || code=$?
    [ "$code" = "$1" ] || fail "exit $code instead of $1 for $3: $(cat message.txt)"
    [ "$(wc -l <message.txt)" = 1 ] || fail "not one line: $(cat message.txt)"
    grep -qE "$2" message.txt || fail "'$(cat message.txt)' does not match $2"
    diff -r one two_before || fail "target touched by $3"
}
refuse 1 "bad.json:4: unknown key 'pionts'; accepted: .*points" 's/points/pionts/'
refuse 1 "bad.json:3: unknown format 'ktx3'; accepted: ktx2, ktx2-zstd, dds" 's/"ktx2",/"ktx3",/'
refuse 1 "bad.json:8: .*albedo-mean.*albedo-average" 's/albedo-average/albedo-mean/'
refuse 1 "bad.json:9: unknown axis 'nu'; accepted: mu, alpha, n, kappa" 's/"n":/"nu":/'
refuse 1 "bad.json:5: 'max' is not understood; accepted: a number from" 's/"max": 2e-2/"max": 1e-9/'
refuse 1 "bad.json:3: .*beckman.*ggx" 's/"formats"/"ndf": "beckman", "formats"/'
refuse 1 "bad.json:[0-9]+: .*beckman.*ggx" 's/"table": "dfg",/"table": "dfg", "ndf": "beckman",/'
refuse 1 "bad.json:9: silver: 4 axes have several nodes" 's/"n": "0.2", "kappa": "3.9"/"n": "0:1:4"/'
refuse 1 "bad.json:[0-9]+: not JSON" 's/"points": 200,/"points" 200,/'
refuse 1 "bad.json:7: second|bad.json:8: unknown second table 'dfg'" 's/albedo-average/dfg/'
refuse 2 "bad.json:[0-9]+: .* misses its budget: best reached p99" 's/"p99": 5e-3/"p99": 2.5e-4/'
refuse 2 "textures take [0-9]+ bytes; asked are at most 1000" 's/"points"/"max-bytes": 1000, "points"/'
# A phase function of g < 0 scatters backwards: two modes, and no sigma_g.
refuse 1 'bad.json:8: g from -0.5 to 0.9; accepted: 0.02 to 0.999' \
    's/"table": "albedo-average"/"mapping": "sigma-g", "axes": {"g": "-0.5:0.9:64"}/'
refuse 1 'bad.json:8: unknown mapping .h.; accepted: f, f-inverse, sigma-g' 's/"table": "albedo-average"/"mapping": "h"/'
mkdir mine && touch mine/thesis.tex
"$lacquer" pack small.json -o mine 2>message.txt && fail "replaced a folder that is no pack"
grep -q "cannot replace mine" message.txt && [ "$(ls mine)" = thesis.tex ] || fail "$(cat message.txt)"

# --------------------------------------------------- the shipped C against the exact integral
cat >use.c <<'END'
#include <stdio.h>
#include <stdlib.h>
#include "one/decode.h"
#include "one/silver.h"
int main(int argc, char **argv) {
    float value[1];
    lacquer_silver(lacquer_silver_texels, argc > 1 ? strtof(argv[1], 0) : 0, argc > 2 ? strtof(argv[2], 0) : 0, value);
    printf("%.6f\n", (double)value[0]);
    return 0;
}
END
"${CC:-cc}" -std=c17 -Wall -Wextra -Werror -I. use.c -o use -lm
for point in "0.3 0.5" "0.05 0.1" "1 1" "0.71 0.02"; do
    read -r mu alpha <<<"$point"
    decoded=$(./use "$mu" "$alpha")
    exact=$("$lacquer" eval fgd mu="$mu" alpha="$alpha" n=0.2 kappa=3.9 | grep -oE '[0-9]\.[0-9]+' | head -1)
    awk -v a="$decoded" -v b="$exact" 'BEGIN { exit !(a - b < 5e-3 && b - a < 5e-3 && b > 0.5) }' ||
        fail "at $point: $decoded decoded, $exact exact"
done

# --------------------------------------------------- readers
if command -v exrinfo >/dev/null && command -v exrcheck >/dev/null; then
    for file in one/*.exr; do
        exrinfo -s "$file" >info.txt && grep -qi "half" info.txt || fail "exrinfo $file: $(cat info.txt)"
        exrcheck "$file" >/dev/null || fail "exrcheck $file"
    done
fi
if command -v oiiotool >/dev/null; then
    # alpha = 1, mu = 1 of dfg: the last texel, from the .npy and through OpenImageIO
    oiiotool one/dfg.exr --cut 1x1+23+23 --printstats >stats.txt 2>&1
    value=$(sed -nE 's/.*Stats Max: ([0-9.]+) .*/\1/p' stats.txt)
    stored=$(sed -n '$!p' one/dfg.h | grep -oE '[0-9.e-]+f?' | tail -2 | head -1)
    awk -v a="$value" -v b="$stored" 'BEGIN { exit !(a - b < 1e-6 && b - a < 1e-6 && b > 0.1) }' ||
        fail "OpenImageIO reads $value where $stored is stored"
fi
