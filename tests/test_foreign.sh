#!/usr/bin/env bash
# Tables of anybody's: .npy, EXR and C arrays that a JSON text describes are compared with the solver, and what was
# planted in them is named.
set -euo pipefail
: "${LACQUER:?path of the program}"
. "$(dirname "$0")/expect.sh"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# ---------------------------------------------------------------------------------- .npy
cat >albedo.json <<'J'
{"table": "albedo", "masking": "separable", "tolerance": 1e-5,
 "axes": [{"name": "alpha", "nodes": "0:1:12"}, {"name": "mu", "nodes": "0:1:20"}]}
J
run 0 precompute albedo --masking separable --axis mu=0:1:20 --axis alpha=0:1:12 -o albedo.npy
run 0 validate albedo.npy --axes albedo.json
says 'the two agree within their tolerances'
says '^passed$'

# one texel off by 2 %, by hand: a float32 of 0.5 for what is something else
size=$(stat -c %s albedo.npy)
cp albedo.npy texel.npy
printf '\x00\x00\x00\x3f' | dd of=texel.npy bs=1 seek=$((size - 4 * 100)) conv=notrunc status=none
run 2 validate texel.npy --axes albedo.json
says 'spots +1 entries are wrong'
says 'max .* at mu=0 alpha=0.636'

printf '\x00\x00\x00\x00' | dd of=texel.npy bs=1 seek=$((size - 4 * 100)) conv=notrunc status=none
run 2 validate texel.npy --axes albedo.json --format json
says '"zeros": 1'

sed 's/"masking": "separable", //' albedo.json >correlated.json
run 2 validate albedo.npy --axes correlated.json
says 'looks like another definition: separable masking'

# nodes in the middle of cells, read as if at their ends
centres=$(awk 'BEGIN { for (i = 0; i < 20; i++) printf "%s%.17g", i ? "," : "", (i + 0.5) / 20 }')
run 0 precompute albedo --masking separable --axis mu="$centres" --axis alpha=0:1:12 -o centres.npy
run 2 validate centres.npy --axes albedo.json
says 'misplaced nodes'
says 'with mu sampled at \(i\+1/2\)/N'
sed 's/"0:1:20"/"0:1:20", "sampling": "centres"/' albedo.json >centres.json
run 0 validate centres.npy --axes centres.json

# ------------------------------------------------------------------------------- C array
cat >points <<'P'
mu,alpha
0.1,0.2
0.1,0.6
0.1,1
0.5,0.2
0.5,0.6
0.5,1
1,0.2
1,0.6
1,1
P
"$LACQUER" eval albedo --format csv <points |
    awk -F, 'NR > 1 { printf "%s%sf%s", NR % 3 == 2 ? "  { " : "", $3, NR % 3 == 1 ? " }, // a row\n" : ", " }
             BEGIN { print "/* {not these} */ static const float lut[3][3] = {" } END { print "};" }' >lut.h
cat >lut.json <<'J'
{"table": "albedo", "axes": [{"name": "mu", "nodes": "0.1,0.5,1"}, {"name": "alpha", "nodes": "0.2,0.6,1"}]}
J
run 0 validate lut.h --axes lut.json
says '; 9 entries'
head -c -4 lut.h >cut.h
refused 'not closed: truncated' validate cut.h --axes lut.json
sed 's/f,/x,/' lut.h >word.h
refused 'is not a number of a C array' validate word.h --axes lut.json

# ----------------------------------------------------------------------------------- EXR
run 0 precompute dfg --axis mu=0:1:9 --axis alpha=0:1:7 -o dfg.exr
cat >dfg.json <<'J'
{"table": "dfg", "components": ["B", "A"], "exr_channels": ["B", "A"],
 "axes": [{"name": "alpha", "nodes": "0:1:7"}, {"name": "mu", "nodes": "0:1:9"}]}
J
run 0 validate dfg.exr --axes dfg.json
sed 's/"exr_channels": \["B", "A"\]/"exr_channels": ["A", "B"]/' dfg.json >swapped.json
run 2 validate dfg.exr --axes swapped.json
says 'another definition: its two channels are swapped'
sed 's/"exr_channels": \["B", "A"\],//' dfg.json >unsaid.json
refused 'has 2 channels; say which' validate dfg.exr --axes unsaid.json

# a table of this program by the same report
run 0 precompute fgd --scattering single --axis mu=0:1:6 --axis alpha=0:1:5 --axis n=0.2:2:3 --axis kappa=1:4:3 -o fgd.exr
run 0 validate fgd.exr --diagnose
says '^fgd.exr - exact'

# ------------------------------------------------------------------------------- mistakes
sed 's/0:1:12/0:1:11/' albedo.json >short.json
refused 'holds 240 values; its description makes up 220' validate albedo.npy --axes short.json
sed 's/"mu"/"nu"/' albedo.json >name.json
refused "an axis 'nu', which albedo has not" validate albedo.npy --axes name.json
sed 's/, {"name": "mu".*/]}/' albedo.json >none.json
refused 'axis mu is missing' validate albedo.npy --axes none.json
sed 's/"masking"/"maskin"/' albedo.json >key.json
refused "unknown key 'maskin'; accepted: table" validate albedo.npy --axes key.json
sed 's/"albedo"/"albino"/' albedo.json >kind.json
refused "unknown table 'albino'" validate albedo.npy --axes kind.json
sed 's/}]}/}]/' albedo.json >open.json
refused 'open.json:3: not JSON' validate albedo.npy --axes open.json
sed 's/"0:1:20"/"0:1:20", "sampling": "middles"/' albedo.json >sampling.json
refused "sampling 'middles'; accepted: ends, centres, starts" validate albedo.npy --axes sampling.json
cp albedo.json no.npy
refused 'not a .npy file' validate no.npy --axes albedo.json
cp albedo.json no.exr
refused 'no.exr: cannot be read as EXR' validate no.exr --axes albedo.json
refused 'no such|cannot read' validate gone.npy --axes albedo.json
refused '--against has no effect with --axes' validate albedo.npy --axes albedo.json --against albedo.npy
refused '--ndf has no effect with --axes, which says how FILE was made' validate albedo.npy --axes albedo.json --ndf ggx

[ "$failures" -eq 0 ]
