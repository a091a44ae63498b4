#!/usr/bin/env bash
# `lacquer stack`, `precompute stack` and `bench stack` as scripts see them: formats, exit codes, one line per
# mistake.
set -euo pipefail
: "${LACQUER:?path of the program}" "${LACQUER_SOURCE:?root of the sources}"
. "$(dirname "$0")/expect.sh"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
stacks=$LACQUER_SOURCE/recipes/stacks
metal=$stacks/frosted-metal.json slab=$stacks/slab.json
mkdir folder
stays_empty=folder

# near A B: within what two estimates at the default tolerance allow.
near() {
    awk -v a="$1" -v b="$2" 'BEGIN { exit !(a != "" && b != "" && (a - b) ^ 2 <= 2e-4 ^ 2) }' || fail "$3: $1 and $2"
}

# field ROW COLUMN of the CSV in out
field() {
    sed -n "$1p" out | cut -d, -f"$2"
}

# ------------------------------------------------------------------------------------------- CSV
header=mu,channel,reflected,transmitted,sin2,mean,across,transmitted_sin2,transmitted_mean,transmitted_across,error
number='[0-9.e-]+'
run 0 stack "$slab" --format csv --mu 1,0.5 --threads 1
[ "$(head -n 1 out)" = "$header" ] || fail "CSV header: $(head -n 1 out)"
[ "$(wc -l <out)" -eq 3 ] || fail "not a row for each of two cosines: $(cat out)"
says "^1(,$number){10}$"
says "^0\.5,0,0\.1222(,?$number){9}$"
[ ! -s err ] || fail "stack wrote to stderr: $(cat err)"
reflected=$(field 3 3) transmitted=$(field 3 4)
cp out one
run 0 stack "$slab" --format csv --mu 1,0.5 --threads 2
cmp -s one out || fail "the light depends on --threads: $(diff one out)"

# an opaque base transmits nothing: four fields are empty
run 0 stack "$metal" --format csv --mu 0.5
says "^0\.5,0,0\.84[0-9]+,(,$number){3},,,,$number$"
whole=$(field 2 3)
run 0 stack "$metal" --format csv --mu 0.5 --paths
[ "$(head -n 1 out)" = "$header,path" ] || fail "CSV header with --paths: $(head -n 1 out)"
[ "$(tail -n +2 out | cut -d, -f12 | xargs)" = "$(seq -s ' ' "$(tail -n +2 out | wc -l)")" ] ||
    fail "paths are not counted from 1: $(cat out)"
awk -F, 'NR > 1 { light = $3; n++ } END { exit !(n >= 3 && light < 0.01) }' out || fail "the last path: $(cat out)"
near "$(awk -F, 'NR > 1 { sum += $3 } END { print sum }' out)" "$whole" 'the paths do not make up the light'
[ "$(awk -F, '{ print NF }' out | sort -u)" = 12 ] || fail "rows of --paths with other than 12 fields: $(cat out)"

# one row for each channel; a channel that absorbs more is darker
cat >rgb.json <<'.'
{"layers": [{"dielectric": {"n": 1.5, "alpha": 0.2}, "medium": {"tau": [0.8, 0.5, 0.3]}},
    {"lambertian": {"rho": 0.5}}]}
.
run 0 stack rgb.json --format csv --mu 1,0.5
[ "$(tail -n +2 out | cut -d, -f1,2 | xargs)" = '1,0 1,1 1,2 0.5,0 0.5,1 0.5,2' ] || fail "rows of RGB: $(cat out)"
awk -F, 'NR > 1 && $2 > 0 && !($3 < last) { exit 1 } { last = $3 }' out || fail "RGB is not in order: $(cat out)"
blue=$(field 7 3)

# -------------------------------------------------------------------------------- text and JSON
run 0 stack "$slab" --mu 0.5
says '^mu +reflected +sin2 +mean +across +transm\. +sin2 +mean +across +error$'
says '^0\.5 +0\.1222'
[ "$(wc -l <out)" -eq 2 ] || fail "text of one cosine: $(cat out)"
run 0 stack "$metal"
[ "$(tail -n +2 out | awk '{ print $1 }' | xargs)" = '1 0.6 0.15' ] || fail "default cosines: $(cat out)"
grep -q transm out && fail "text of an opaque stack shows transmitted light"
run 0 stack "$slab" --mu 0.5 --from below --interfaces single --paths --format json
says '"from": "below"'
says '"interfaces": "single"'
says '"path": 2'
python3 -c 'import json; light = json.load(open("out"))["light"]; assert len(light) >= 2, light
assert all({"mu", "channel", "reflected", "transmitted", "error", "path"} == set(l) for l in light), light
assert {"energy", "sin2", "mean", "across"} == set(light[0]["reflected"]), light' || fail "JSON: $(cat out)"

# printed, but not within the tolerance: grazing light through all angles of a rough surface
echo '{"layers": [{"dielectric": {"n": 1.5, "alpha": 0.3}}]}' >rough.json
run 2 stack rough.json --mu 1e-9 --tolerance 1e-7 --format csv
[ "$(wc -l <out)" -eq 2 ] || fail "not converged: the light is not printed: $(cat out)"
grep -qE '^lacquer stack: error estimate [0-9.e-]+ is above the tolerance 1e-07$' err || fail "exit 2: $(cat err)"
[ "$(wc -l <err)" -eq 1 ] || fail "exit 2: not one line: $(cat err)"

# -------------------------------------------------------------------------------------- mistakes
refused 'no stack; usage' stack
refused "one stack at a time, not 'b' too" stack a b
refused 'missing.json: No such file' stack missing.json
refused 'not a regular file' stack folder
refused 'light from below a conductor base; accepted: ' stack "$metal" --from below
for tolerance in 1e-8 0.5 0 -1; do
    refused "--tolerance: '$tolerance' is not a number from 1e-07 to 0.1" stack "$slab" --tolerance "$tolerance"
done
refused "--mu: '1.5' is not a number from 0 to 1" stack "$slab" --mu 0.5,1.5
refused "--mu: 'half' is not a number" stack "$slab" --mu half
refused "--mu: '' is not a number" stack "$slab" --mu 0.5,
refused '--mu: accepted: up to 256 cosines' stack "$slab" --mu "$(seq -s, 0 0.003 1)"
refused "one stack at a time, not '3' too" stack "$slab" --paths 3
refused "'xml' is not one of: text, csv, json" stack "$slab" --format xml
refused "'side' is not one of: above, below" stack "$slab" --from side

# stack_refused PATTERN LAYERS
stack_refused() {
    echo "{\"layers\": [$2]}" >bad.json
    refused "$1" stack bad.json
    refused "$1" precompute stack --stack bad.json --axis mu=0:1:3 -o folder/t.exr
    refused "$1" bench stack --stack bad.json
}
stack_refused 'alpha.*a range, which only scenes take; accepted: ' \
    '{"dielectric": {"n": 1.5, "alpha": {"min": 0.1, "max": 0.2}}}'
stack_refused 'layer 1 is anisotropic; accepted: one alpha' \
    '{"dielectric": {"n": 1.5, "alpha": {"x": 0.1, "y": 0.2}}}'
stack_refused 'layer 1 has a medium that scatters' \
    '{"dielectric": {"n": 1.5, "alpha": 0.1}, "medium": {"sigma_a": 0.1, "sigma_s": 0.1, "depth": 1}}'
stack_refused "layer 2: NDF 'file:d.csv' is named by a description, which is not trusted" \
    '{"dielectric": {"n": 1.5, "alpha": 0.1}}, {"conductor": {"n": 0.2, "kappa": 3.9, "alpha": 0.3, "ndf": "file:d.csv"}}'
stack_refused 'bad.json: .*layer 1.*lambertian' \
    '{"lambertian": {"rho": 0.5}}, {"dielectric": {"n": 1.5, "alpha": 0.1}}'
stack_refused 'bad.json' '{"dielectric": {"n": 1.5'

# --allow-plugin opens what the description names: samples of GGX interpolate to the built-in GGX
awk 'BEGIN { print "theta_deg,alpha=0.25,alpha=0.35"; for (i = 0; i < 90; i++) { t = i * atan2(1, 1) / 45
    printf "%d,%.12g,%.12g\n", i, (0.0625 * cos(t) ^ 2 + sin(t) ^ 2) ^ -2, (0.1225 * cos(t) ^ 2 + sin(t) ^ 2) ^ -2
    } }' >d.csv
conductor='"n": 0.2, "kappa": 3.9, "alpha": 0.3'
echo "{\"layers\": [{\"conductor\": {$conductor, \"ndf\": \"file:d.csv\"}}]}" >file.json
echo "{\"layers\": [{\"conductor\": {$conductor}}]}" >ggx.json
run 0 stack file.json --allow-plugin --mu 0.6 --format csv
energy=$(field 2 3) sin2=$(field 2 5)
run 0 stack ggx.json --mu 0.6 --format csv
near "$energy" "$(field 2 3)" 'energy of a sampled NDF'
near "$sin2" "$(field 2 5)" 'sin2 of a sampled NDF'

# ---------------------------------------------------------------------------------------- tables
axes=(--axis mu=0:1:3 --axis top.alpha=0.1,0.3)
run 0 precompute stack --stack "$slab" "${axes[@]}" --threads 1 -o one.exr
says '^one.exr: 6 entries, error at most [0-9.e-]+, '
[ ! -s err ] || fail "precompute stack wrote to stderr: $(cat err)"
run 0 precompute stack --stack "$slab" "${axes[@]}" --threads 2 -o two.exr
cmp one.exr two.exr || fail "the table depends on --threads"
run 0 eval --from one.exr mu=0.5 top.alpha=0.1
near "$(sed -n 's/^reflected //p' out)" "$reflected" 'reflected of the table and of lacquer stack'
near "$(sed -n 's/^transmitted //p' out)" "$transmitted" 'transmitted of the table and of lacquer stack'
[ "$(cut -d' ' -f1 out | xargs)" = \
    'reflected sin2 mean across transmitted transmitted_sin2 transmitted_mean transmitted_across' ] ||
    fail "channels of a slab: $(cat out)"
run 0 info one.exr
says '^  table +stack$'
says '^  stack +\{"name": "slab", "layers": \[\{"dielectric": '
says "^  command +lacquer precompute stack --axis mu=0:1:3 --axis top.alpha=0.1,0.3 --stack "
says '^  top\.alpha +2 nodes, 0\.1 to 0\.3, custom$'

# the recorded description is that stack again
"$LACQUER" info one.exr --format json |
    python3 -c 'import json, sys; print(json.load(sys.stdin)["facts"]["stack"])' >recorded.json
run 0 stack recorded.json --format csv --mu 1,0.5
cmp one out || fail "the recorded stack is another: $(diff one out)"

run 0 precompute stack --stack rgb.json --axis mu=0,0.5 -o rgb.exr
run 0 eval --from rgb.exr mu=0.5
[ "$(cut -d' ' -f1 out | xargs)" = 'reflected.r reflected.g reflected.b' ] || fail "channels of RGB: $(cat out)"
near "$(sed -n 's/^reflected.b //p' out)" "$blue" 'blue of the table and of lacquer stack'

run 0 precompute stack --stack "$slab" --axis mu=0.5 --axis 2.n=1,1.2 --from below --interfaces single -o below.exr
run 0 info below.exr
says '^  from +below$'
says '^  scattering +single$'

# what other verbs make of it
run 0 pca one.exr --separate top.alpha:2 --nodes-only -o factors.exr
run 0 pca one.exr --separate top.alpha:2 -o factors.exr
grep -q "errors are at the table's own nodes only: it is a table of a stack" err || fail "pca: $(cat err)"
refused 'one.exr: it is a table of a stack, not of one of the kinds' validate one.exr
refused 'top.alpha = 0.5 is out of range; accepted: 0.1 to 0.3' eval --from one.exr mu=0.5 top.alpha=0.5
refused 'use lacquer stack FILE.json' eval stack mu=0.5

# ---------------------------------------------------------------------------- mistakes of tables
table=(precompute stack -o folder/t.exr)
refused 'no layers; add --stack FILE.json' "${table[@]}" --axis mu=0:1:3
refused 'needs the axis mu' "${table[@]}" --stack "$slab"
refused 'needs the axis mu' "${table[@]}" --stack "$slab" --axis top.alpha=0:1:3
refused "'9.alpha' names no layer; accepted: .*N from 1 to 2" "${table[@]}" --stack "$slab" "${axes[@]}" --axis 9.alpha=0:1:3
refused "'eta' names no layer" "${table[@]}" --stack "$slab" --axis mu=0:1:3 --axis eta=0:1:3
refused "'top.kappa': a dielectric has no such parameter; accepted: n, " "${table[@]}" --stack "$slab" --axis top.kappa=0:1:3
refused "'top.depth': the medium is said by tau" "${table[@]}" --stack "$slab" --axis top.depth=0:1:3
refused 'top.alpha from 0 to 2 is out of range; accepted: 0 to 1' "${table[@]}" --stack "$slab" --axis top.alpha=0:2:3
refused 'mu from 0 to 1.5 is out of range; accepted: 0 to 1' "${table[@]}" --stack "$slab" --axis mu=0:1.5:3
refused 'top.n = 0; accepted: 0 < n <= 10' "${table[@]}" --stack "$slab" --axis mu=0:1:3 --axis top.n=0:1:3
refused "'mu' has no nodes" "${table[@]}" --stack "$slab" --axis mu
refused "two axes called 'mu'" "${table[@]}" --stack "$slab" --axis mu=0:1:3 --axis mu=0:1:4
for same in 1.alpha top.alpha.x 1.alpha.y; do
    refused "'top.alpha' and '$same' set the same parameter" "${table[@]}" --stack "$slab" "${axes[@]}" --axis "$same=0:1:3"
done
refused 'layer 1 is anisotropic' "${table[@]}" --stack "$slab" --axis mu=0:1:3 --axis top.alpha.x=0:1:3
refused 'light from below a conductor base' "${table[@]}" --stack "$metal" --axis mu=0:1:3 --from below
refused '--tolerance: a stack accepts 1e-07 to 0.1, not 1e-12' "${table[@]}" --stack "$slab" "${axes[@]}" --tolerance 1e-12
refused '--ndf has no effect for a stack' "${table[@]}" --stack "$slab" "${axes[@]}" --ndf ggx
refused '--scattering has no effect for a stack' "${table[@]}" --stack "$slab" "${axes[@]}" --scattering single
for option in "--stack $slab" '--interfaces single' '--from below'; do
    refused "${option%% *} has no effect for this table" precompute albedo $option -o folder/t.exr
done
for format in belcour tm mitsuba; do
    refused 'a published layout holds no stack; accepted: exr, npy' "${table[@]}" --stack "$slab" "${axes[@]}" --format "$format"
done
refused 'does not follow from the name' precompute stack --stack "$slab" "${axes[@]}" -o folder/t.bin
refused 'missing.json: No such file' "${table[@]}" --stack missing.json "${axes[@]}"
refused 'cannot write nowhere/t.exr' precompute stack --stack "$slab" "${axes[@]}" -o nowhere/t.exr

# ----------------------------------------------------------------------------------------- bench
run 0 bench stack --stack rgb.json --samples 1000 --csv bench.csv
says '^rgb.json +solver +1e-04 +64 +3 '
says '^rgb.json: 3 channels take [0-9.]+ times as long as one$'
says '^rgb.json: off by [0-9.e-]+, 64 cosines: solver .* s, walk .* s: [0-9.e+]+ times faster$'
[ "$(head -n 1 bench.csv)" = \
    stack,method,setting,entries,channels,threads,runs,wall_seconds,slowest_seconds,cpu_seconds,error,off,ratio ] ||
    fail "bench.csv: $(head -n 1 bench.csv)"
[ "$(tail -n +2 bench.csv | cut -d, -f1-5 | xargs)" = \
    'rgb.json,solver,0.0001,64,3 rgb.json,solver,0.0001,64,1 rgb.json,walk,1000,1,3' ] ||
    fail "rows of bench.csv: $(cat bench.csv)"
awk -F, 'NR > 1 && !($8 > 0 && $9 >= $8 && $11 > 0 && ($12 > 0) == (NR == 2) && ($13 > 0) == (NR != 3)) { exit 1 }' bench.csv ||
    fail "figures of bench.csv: $(cat bench.csv)"
# the extrapolation: as many samples as make the noise what the solver is off by, at every cosine
awk -F, 'NR == 2 { s = $8; e = $12 } NR == 4 { r = $8 * ($11 / e) ^ 2 * 64 / s
    exit !((r / $13 - 1) ^ 2 < 1e-6) }' bench.csv || fail "ratio of bench.csv: $(cat bench.csv)"
refused "one TABLE" bench stack fgd
refused "one TABLE" bench fgd stack
refused '--stack has no effect for a table' bench fgd --stack "$slab"
refused '--stack has no effect with --report' bench --stack "$slab" --report folder/page
refused 'missing.json' bench stack --stack missing.json
refused 'nowhere' bench stack --csv nowhere/b.csv

exit "$failures"
