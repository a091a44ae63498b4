#!/usr/bin/env bash
# `lacquer stack --model` as scripts see it: the columns of the exact stack, a line a lobe, and what is refused.
set -euo pipefail
: "${LACQUER:?path of the program}" "${LACQUER_SOURCE:?root of the sources}"
. "$(dirname "$0")/expect.sh"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
stacks=$LACQUER_SOURCE/recipes/stacks
metal=$stacks/frosted-metal.json slab=$stacks/slab.json
model='--model b18-forward'
number='[0-9.e-]+'
echo '{"layers": [{"conductor": {"n": 1, "kappa": 1, "alpha": {"x": 0.3, "y": 0.1}}}]}' >a.json

# ------------------------------------------------------------------------------------------- formats
run 0 stack "$slab" --mu 0.6 --format csv
head -n 1 out >header
run 0 stack "$slab" $model --mu 1,0.6 --format csv
cmp -s header <(head -n 1 out) || fail "CSV has other columns than the exact stack: $(head -n 1 out)"
[ "$(wc -l <out)" -eq 3 ] || fail "not a row a cosine: $(cat out)"
says "^0\.6,0(,$number){8},$"
run 0 stack "$metal" $model --mu 0.6 --format csv
says "^0\.6,0,0\.903$number,(,$number){3},,,,$"
run 0 stack "$slab" $model --mu 0.6
[ "$(wc -l <out)" -eq 4 ] || fail "not a line for each of three lobes: $(cat out)"
says '^0\.6 +2( +[0-9.]+){4}$'
says '^0\.6 +through( +[0-9.]+){4}$'
run 0 stack "$metal" $model --mu 0.6 --format json --variant released --mapping b18
says '"variant": "released"'
says '"mapping": "b18"'
[ "$(grep -c '"roughness"' out)" -eq 2 ] || fail "not two lobes: $(cat out)"

run 0 stack "$metal" --model baked --mu 0.6 --format json
says '"variant": null'
run 0 stack "$stacks/varnished-base.json" --model baked --mu 0.6 --format csv
says '^0\.6,0,0\.1157'
run 0 stack "$metal" --model weidlich-wilkie-corrected --mu 0.6 --format csv
says '^0\.6,0,0\.7931'
run 0 stack "$metal" --model b18-forward --variant released --first exact --mu 0.6 --format json
says '"first": "exact"'
run 0 stack a.json --model y19 --variant released --mu 0.6 --azimuth 90
says '^0\.6 +1 +[0-9.]+ +[0-9.]+ +0\.30000 +0\.10000 +-90\.00$'
run 0 stack --help
says '^  baked '
says '^  baked-window '

# ------------------------------------------------------------------------------------------- tables of a pack
echo '{"layers": [{"dielectric": {"n": 1.5, "alpha": 0.1}}, {"lambertian": {"rho": 0.7}}]}' >plastic.json
cat >tiny.json <<'END'
{"name": "tiny", "formats": ["exr"], "points": 100,
 "tables": [{"table": "fgd-dielectric", "axes": {"mu": "0.02:1:12", "alpha": "0.1:0.3:3", "eta": "1.4:1.6:3"}},
  {"table": "tir-pass", "axes": {"mu": "0.02:1:12", "alpha": "0:0.4:3", "eta": "0.6:0.7:3"}},
  {"table": "fgd", "axes": {"mu": "0.02:1:12", "alpha": "0:0.4:3", "n": "0.13333333333333333", "kappa": "2:3:3"}}]}
END
run 0 pack tiny.json -o tiny --cache cache
run 0 eval --from tiny fgd-dielectric mu=0.6 alpha=0.2 eta=1.5
coat=$(cat out)
run 0 stack "$metal" $model --variant released --mu 0.6 --tables tiny
awk -v coat="$coat" '$2 == 1 && ($3 - coat) ^ 2 < 1e-12 { found = 1 } END { exit !found }' out ||
    fail "the first lobe has not the pack's energy $coat: $(cat out)"
says '^0\.6 +2 +0\.8[56]' # 0.8573 by exact tables
run 0 stack "$metal" --model b18-symmetric --variant released --mu 1,0.6 --tables tiny --format csv
[ "$(wc -l <out)" -eq 3 ] || fail "not a row a cosine: $(cat out)"
says "^0\.6,0,$number,(,$number){3},,,,$"
refused 'fgd-dielectric up where pack tiny has none, at eta = 0\.666667; accepted: 1\.4 to 1\.6' \
    stack "$metal" $model --tables tiny
refused 'pack tiny has no table of transmission' \
    stack plastic.json $model --variant released --tables tiny
refused '--tables has no effect with --model baked' stack "$metal" --model baked --tables tiny

# ------------------------------------------------------------------------------------------- refused
refused "phong.*b18-forward" stack "$slab" --model phong
refused 'lambertian base; accepted by b18-symmetric' stack "$stacks/varnished-base.json" --model b18-symmetric
refused 'lambertian base under 2 coats' stack "$stacks/varnished-base.json" $model
refused '--paths has no effect with --model' stack "$slab" $model --paths
refused '--variant has no effect with --model baked' stack "$slab" --model baked --variant paper
refused '--first has no effect with --model weidlich-wilkie' stack "$metal" --model weidlich-wilkie --first exact
refused 'the last layer lets light through' stack "$slab" --model weidlich-wilkie
refused '--azimuth has no effect with --model b18-forward' stack "$metal" $model --azimuth 30
refused '--mapping has no effect without --model' stack "$slab" --mapping b18
refused 'layer 1 is anisotropic' stack a.json $model

exit $((failures > 0))
