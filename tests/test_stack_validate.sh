#!/usr/bin/env bash
# `lacquer validate stack`: solver and walks agree on the stacks that come along, and mistakes are one line.
set -euo pipefail
: "${LACQUER:?path of the program}" "${LACQUER_SOURCE:?root of the sources}"
. "$(dirname "$0")/expect.sh"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
stacks=$LACQUER_SOURCE/recipes/stacks

# ------------------------------------------------------------------------------------- in order
run 0 validate stack "$stacks/frosted-metal.json" --samples 50000
says '^frosted-metal: interfaces all, light from above, walks of 50000 samples, seed 1$'
says '^0\.15 +reflected +across +0\.13[0-9]+ '
[ "$(grep -c ' reflected ' out)" -eq 12 ] || fail "not four quantities at three cosines: $(cat out)"
grep -q transmitted out && fail "an opaque stack transmits"
says '^passed$'
[ ! -s err ] || fail "validate stack wrote to stderr: $(cat err)"

# the report does not depend on the threads, but on the seed
mv out first
run 0 validate stack "$stacks/frosted-metal.json" --samples 50000 --threads 1
cmp -s first out || fail "one thread changes the report"
run 0 validate stack "$stacks/frosted-metal.json" --samples 50000 --seed 2
cmp -s first out && fail "the seed changes nothing"

run 0 validate stack "$stacks/slab.json" --from below --interfaces single --mu 1,0.3 --samples 50000 --json
says '"from": "below"'
says '"interfaces": "single"'
says '"passed": true'
[ "$(grep -c '"z":' out)" -eq 16 ] || fail "not eight quantities at two cosines: $(cat out)"
run 0 validate stack "$stacks/varnished-base.json" --mu 0,0.02,0.5 --tolerance 1e-3 --samples 50000

echo '{"layers": [{"dielectric": {"n": 1.5, "alpha": 0.2}, "medium": {"tau": [0.8, 0.5, 0.3]}},
    {"lambertian": {"rho": 0.5}}]}' >stack
run 0 validate stack stack --mu 0.5 --samples 20000
says '^0\.5 +2 reflected +energy '

# slices: energies by order, and files that this program reads
run 0 validate stack stack --mu 0.5 --samples 50000 --slices slices
says '^0\.5 +1 reflected +twice '
[ "$(ls slices | tr '\n' ' ')" = 'mu-0.5-reflected-classic.exr mu-0.5-reflected-classic.png mu-0.5-reflected-half.exr mu-0.5-reflected-half.png ' ] ||
    fail "other files: $(ls slices)"
run 0 info slices/mu-0.5-reflected-half.exr
says 'theta +90 nodes'
says 'noise\.b +min 0'
cp -r slices again
run 0 validate stack stack --mu 0.5 --samples 50000 --slices slices --threads 1
diff -r again slices >diffs || fail "one thread changes the slices: $(cat diffs)"

# ------------------------------------------------------------------------------------- mistakes
touch file
refused "folder 'file'" validate stack stack --slices file
refused '--slices has no effect' validate x.exr --slices slices
refused 'no stack; usage' validate stack
refused "one FILE at a time: 'b' after 'a'" validate stack a b
refused 'missing.json' validate stack missing.json
refused "stack: .*EXR" validate ./stack
refused 'accepts 1e-07 to 0.1, not 0.5' validate stack stack --tolerance 0.5
refused "mu.*'2' is not a number from 0 to 1" validate stack stack --mu 0.5,2
refused 'light from below a lambertian base' validate stack stack --from below
refused '--points has no effect for a stack' validate stack stack --points 4
refused '--ndf has no effect for a stack' validate stack stack --ndf ggx
refused '--mu has no effect' validate x.exr --mu 0.5
echo '{"layers": [{"dielectric": {"n": 1.5, "alpha": {"x": 0.1, "y": 0.2}}}]}' >stack
refused 'layer 1 is anisotropic; accepted: one alpha' validate stack stack

exit "$failures"
