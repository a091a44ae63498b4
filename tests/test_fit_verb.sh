#!/usr/bin/env bash
# `lacquer fit`: the figures of every mapping, its files, its messages. Skipped where Ceres was missing.
set -euo pipefail
[ -x "$(dirname "$LACQUER")/lacquer-fit" ] || exit 77
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

fail() {
    echo "test_fit_verb: $1" >&2
    exit 1
}

# largest LINE_START LIMIT: the "max" of that line of the last output is below the limit
largest() {
    awk -v start="$1" -v limit="$2" 'index($0, start) { for (i = 1; i < NF; i++) if ($i == "max") value = $(i + 1) }
        END { exit !(value != "" && value + 0 < limit) }' out || fail "$1 is not below $2: $(cat out)"
}

refused() { # PATTERN arguments
    local pattern=$1
    shift
    "$LACQUER" fit "$@" >out 2>err && fail "fit $* was accepted"
    [ "$(wc -l <err)" -eq 1 ] || fail "fit $*: not one line: $(cat err)"
    grep -qE -- "$pattern" err || fail "fit $*: $(cat err)"
}

"$LACQUER" fit variance -o v.json --snippet v.h --report v --texture f.exr >out
largest 'relative error' 0.02
grep -q 'rms 0.9[0-9]*, max 2.58 at 0.01' out || fail "B18's f on the same points: $(cat out)"
for key in coefficients covariance relative-error published max-at inverse; do
    grep -q "\"$key\"" v.json || fail "v.json has no $key"
done
[ "$(grep -c '</svg>' v/index.html)" -eq 2 ] || fail 'a chart is missing'
# The page's figures are those of the JSON; only the two largest residuals have markers.
python3 - <<'PYTHON' || fail 'the page of a fit'
import json, re
page, fit = open("v/index.html").read(), json.load(open("v.json"))
assert f'Off by at most <b>{fit["relative-error"]["max"]:.3g}</b>' in page
for name, value in fit["coefficients"].items():
    shown = float(re.search(rf"<td>{name}</td><td>([^<]*)<", page)[1])
    assert abs(shown / value - 1) < 1e-8, (name, shown, value)
assert page.count("translate(") == 2, page.count("translate(")
PYTHON
"$LACQUER" fit variance -o again.json >/dev/null
cmp v.json again.json || fail 'the same fit gives other bits'
"$LACQUER" fit variance --norm rms --loss 0.01 -o loss.json >out
largest 'relative error' 0.03
"$LACQUER" fit hg -o hg.json --snippet hg.glsl >out
largest 'relative error' 0.01
"$LACQUER" fit transmission -o t.json --snippet t.hlsl >out
largest 'relative error' 0.2
"$LACQUER" fit tail -o k.json >out
largest 'relative error' 0.025
"$LACQUER" fit variance --ndf beckmann -o b.json >out # its pole ends the default range
largest 'relative error' 0.2
"$LACQUER" fit variance --family b18 -o b18.json >/dev/null

# bounces (test_fit has the figures): every row, the same bits for any number of threads
"$LACQUER" fit bounces --samples 20000 -o n.json >out
OMP_NUM_THREADS=1 "$LACQUER" fit bounces --samples 20000 -o n1.json >/dev/null
cmp n.json n1.json || fail 'bounces depend on threads'
[ "$(grep -c '+-' out)" -eq 18 ] || fail "bounces: $(cat out)"
"$LACQUER" fit anisotropic --samples 20000 -o a.json >out
[ "$(grep -c '"turn"' a.json)" -eq 15 ] || fail "anisotropic: $(cat out)"
# alpha = 0.1, eta = 1.5, normal incidence: 0.0055 and by eq. 10 0.0067 (docs/fit.md); the disc scales by eta12^2
"$LACQUER" fit transmitted -o lobes.json >out
grep -qE '^1.5000  1.00  0.10  1.0000  5.4[0-9]*e-03 .* 6.67[0-9]*e-03' out || fail "transmitted: $(cat out)"
grep -qE '^2.0000  0.250000 .* 0.250000   2.000000' out || fail "the disc: $(cat out)"
[ "$(grep -c '"eta"' lobes.json)" -eq 123 ] || fail 'lobes.json has not 120 lobes and 3 discs'
refused '--samples has no effect for transmitted' transmitted --samples 5000
refused 'no NDF but ggx' anisotropic --ndf beckmann
refused '--samples has no effect for this mapping' tail --samples 5000 -o x.json

# the snippet computes the same function, and its inverse goes back
cat >use.c <<'C'
#include "v.h"
#include <stdio.h>
int main(void) {
    float worst = 0.0f;
    for (float a = 0.01f; a < 0.8f; a *= 1.1f) worst = fmaxf(worst, fabsf(lacquer_fitted_variance_inverse(lacquer_fitted_variance(a)) / a - 1.0f));
    printf("%g %g\n", (double)lacquer_fitted_variance(0.237f), (double)worst);
    return 0;
}
C
"${CC:-cc}" -o use use.c -lm
./use | awk '{ exit !($1 > 0.40 && $1 < 0.43 && $2 < 2e-5) }' || fail "the snippet: $(./use)"

# textures through both ways are checked in test_fit_families; here: they are tables
"$LACQUER" info f.exr | grep -q 'log2-f' || fail 'f.exr is not a table of log2-f'
"$LACQUER" info f-inverse.exr | grep -q 'alpha' || fail 'no inverse table'

refused 'MAPPING is missing' -o x.json
refused "'x' is not one of: variance, hg, transmission, tail" x -o x.json
refused '-o FILE.json is missing' variance
refused "'x' is not one of: b18, exponential" variance --family x -o x.json
refused '0.0001 <= A < B < 1' variance --range 0.5:0.2 -o x.json
refused '0.0001 <= A < B < 1' variance --range 0.5:nan -o x.json
refused 'curve of NDF beckmann is inf at' variance --ndf beckmann --range 0.01:0.9 -o x.json
refused 'has no limit at alpha = 0' variance --ndf gtr:gamma=1 -o x.json
refused 'cannot make the folder' variance --report missing/page -o x.json
refused '--texture has no effect for this mapping' hg --texture x.exr -o x.json
refused 'cannot write' variance -o missing/x.json
[ ! -e x.json ] || fail 'a refused fit left a file'
# the engine without a problem, and with one that is not finite
if "$(dirname "$LACQUER")/lacquer-fit" </dev/null >out; then fail 'the engine took nothing for a problem'; fi
if printf '1 6 0 0\n%s' "$(for i in 1 2 3 4 5 6; do echo "0.$i 0 0 0 nan"; done)" |
    "$(dirname "$LACQUER")/lacquer-fit" >out; then fail 'the engine took a NaN'; fi
grep -q 'residual of point 0 is not finite' out || fail "NaN: $(cat out)"
# where it was not built, the verb says what to install
cp "$LACQUER" alone
if ./alone fit tail -o x.json 2>err; then fail 'fitted without an engine'; fi
grep -q 'libceres-dev' err || fail "without the engine: $(cat err)"
