#!/usr/bin/env bash
# `lacquer validate layered` on a small set: what it writes, that it goes on where it was, that it mixes no settings,
# and that mistakes are one line. The sets that are shipped are read whole.
set -euo pipefail
: "${LACQUER:?path of the program}" "${LACQUER_SOURCE:?root of the sources}"
. "$(dirname "$0")/expect.sh"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# ------------------------------------------------------------------------------------- in order
cat >set.json <<'SET'
{"name": "small", "about": "two kinds of stack", "theta": [60],
 "stacks": [
   {"name": "plastic", "category": "plastics", "over": {"top.alpha": [0.2, 0.4]},
    "layers": [{"dielectric": {"n": 1.5, "alpha": 0}}, {"lambertian": {"rho": [0.8, 0.5, 0.1]}}]},
   {"name": "line", "category": "curves", "over": {"top.alpha": [0.1, 0.3]},
    "layers": [{"dielectric": {"n": 1.5, "alpha": 0}}, {"conductor": {"n": 0.2, "kappa": 3.9, "alpha": 0.1}}]}]}
SET
layered() { # DIR ARGUMENTS...
    run 0 validate layered --set ./set.json --model baked,weidlich-wilkie --samples 20000 --report "$@"
}
layered whole
says '^4 stacks of the set small, 0 of them from before; whole/index\.html$'
[ ! -s err ] || fail "it wrote to stderr: $(cat err)"
[ "$(grep -c '^plastic-0\.[24],plastics,60,reflected,' whole/figures.csv)" -eq 4 ] ||
    fail "not two models of two stacks: $(cat whole/figures.csv)"
[ "$(grep -c '^plastic-0\.4,.*,baked,\(direct\|rest\),[012],' whole/lobes.csv)" -eq 6 ] ||
    fail "not two lobes of three colours: $(cat whole/lobes.csv)"
grep -q '^line-0\.3,curves,60,reflected,baked,0\.3,' whole/curves.csv || fail "no curve: $(cat whole/curves.csv)"
# baked has the exact stack's energies: the cells say so too
awk -F, '/baked,(direct|rest)/ { d = $8 - $9; if (d > 2e-3 || d < -2e-3) exit 1 }' whole/lobes.csv ||
    fail "energies of baked are not exact: $(cat whole/lobes.csv)"
# and walks agree with the solver
grep -A9 walk_z whole/finished/small-plastic-0.4.json | grep -E '^ +[5-9]\.|^ +[0-9]{2,}\.' && fail "walks are off"
for file in whole/line.png whole/slices/small-plastic-0.2-60-reflected-measured.png; do
    [ -s "$file" ] || fail "no $file"
done
# every picture that the page shows is there
for file in $(grep -oE 'src="[^"]+"' whole/index.html | sed 's/src="\(.*\)"/\1/'); do
    [ -s "whole/$file" ] || fail "the page shows $file, which is not there"
done

# interrupted and gone on with is the same; threads do not show
cp -r whole again
rm again/finished/small-plastic-0.4.json again/index.html
layered again --threads 1
says '3 of them from before'
diff -r whole again >diffs || fail "going on makes another report: $(head -5 diffs)"

# other settings are not mixed in
layered again --seed 2
says ' 0 of them from before'
cmp -s whole/figures.csv again/figures.csv && fail "the seed changes nothing"
echo '{' >whole/finished/small-plastic-0.2.json
layered whole
says '3 of them from before'

# ------------------------------------------------------------------------------------- mistakes
refused 'no folder; usage' validate layered
refused "no set 'other'; accepted: ba19, b18, d22" validate layered --report r --set other
refused "no model 'x'; accepted: .*baked" validate layered --report r --model x
refused "'baked\+released'|'\+released'; accepted: \+exact-first" validate layered --report r --model baked+released
refused "of which pack" validate layered --report r --model b18-forward+tables
refused 'no effect where no model is named with .tables' validate layered --report r --model baked --tables .
refused "'baked' twice" validate layered --report r --model baked,baked
refused '--set has no effect' validate x.exr --set ba19
refused '--mu has no effect for layered' validate layered --report r --mu 0.5
echo '{"name": "a b", "theta": [30], "stacks": []}' >bad.json
refused "bad.json: 'name' is accepted as" validate layered --report r --set ./bad.json
echo '{"name": "a", "theta": [90], "stacks": []}' >bad.json
refused 'accepted: 0 <= theta < 90' validate layered --report r --set ./bad.json
sed 's/top.alpha/top.beta/' set.json >bad.json
refused "bad.json: plastic: .*beta" validate layered --report r --set ./bad.json
sed 's/"about"/"abuot"/' set.json >bad.json
refused "unknown key 'abuot'" validate layered --report r --set ./bad.json
[ ! -e r ] || fail "a refused command made its folder"

exit "$failures"
