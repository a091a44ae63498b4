#!/usr/bin/env bash
# lacquer pack of a scene: one texture, a function a material, within its budget and as small as it says; what is wrong
# in a material is said with its line; validate solves the materials anew and sees a texel that was changed.
set -euo pipefail
cd "${LACQUER_SOURCE:-$(dirname "$0")/..}"
LACQUER=${LACQUER:-$PWD/build/release/lacquer}
. tests/expect.sh
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
export XDG_CACHE_HOME=$scratch/xdg

cat >four.json <<'END'
{"name": "four", "formats": ["ktx2", "c", "npy"], "budget": {"p99": 4e-3, "max": 2e-2}, "points": 500,
 "materials": [
  {"name": "gold", "source": "Johnson and Christy 1972",
   "layers": [{"conductor": {"n": [0.14, 0.43, 1.38], "kappa": [3.697, 2.455, 1.914], "alpha": {"min": 0.1, "max": 0.5}}}]},
  {"name": "red-plastic",
   "layers": [{"dielectric": {"n": 1.5, "alpha": 0.3}}, {"lambertian": {"rho": [0.7, 0.05, 0.04]}}]},
  {"name": "varnish",
   "layers": [{"dielectric": {"n": 1.5, "alpha": {"min": 0.1, "max": 0.4}}}, {"lambertian": {"rho": {"min": 0, "max": 1}}}]},
  {"name": "white", "layers": [{"lambertian": {"rho": 0.8}}]}]}
END
run 0 pack four.json -o pack
says '^gold +[0-9]+ '
says '^white +0 '
says '^the atlas +[0-9]+$'
[ "$(ls pack | tr '\n' ' ')" = "atlas.h atlas.ktx2 atlas.npy decode.glsl decode.h decode.hlsl decode.metal decode.vulkan.glsl decode.wgsl index.html manifest.json " ] ||
    fail "the pack holds $(ls pack)"
[ "$(stat -c %s pack/atlas.ktx2)" -lt 12000 ] || fail "an atlas of $(stat -c %s pack/atlas.ktx2) bytes"
run 0 pack four.json -o again --threads 1
diff -r pack again >/dev/null || fail "one thread makes another pack"
run 0 pack four.json -o pack # replaces its own

# ------------------------------------------------ the shipped C, as C99 and C++, warnings as errors
cat >use.c <<'END'
#include "pack/atlas.h"
#include "pack/decode.h"
#include <stdio.h>
int main(void) {
    const float *t = lacquer_atlas_texels;
    lacquer_lobes g = lacquer_gold(t, 0.5f, 0.3f), p = lacquer_red_plastic(t, 0.5f), w = lacquer_white(t, 0.5f);
    lacquer_lobes v = lacquer_varnish(t, 0.5f, 0.2f, lacquer_make3(0.5f, 0.25f, 1.0f)), n = lacquer_gold(t, NAN, 0.3f);
    printf("%.4f %.4f %.4f\n", g.top.x, g.top.y, g.top.z);
    printf("%.4f %.4f %.4f\n", p.top.x + p.base.x, p.top.y + p.base.y, p.top.z + p.base.z);
    printf("%.4f %.4f %.4f\n", v.top.x + v.base.x, v.top.y + v.base.y, v.top.z + v.base.z);
    printf("%.4f %d\n", w.base.x, n.top.x != n.top.x);
    return 0;
}
END
cc -std=c99 -Wall -Wextra -Wconversion -Wshadow -Werror -fsanitize=undefined use.c -lm -o use 2>err || fail "C99: $(head -3 err)"
c++ -x c++ -Wall -Wextra -Wconversion -Wshadow -Werror use.c -o use_cpp 2>err || fail "C++: $(head -3 err)"
./use >got.txt 2>&1
./use_cpp | diff got.txt - >/dev/null || fail "C++ says other values"

# ------------------------------------------------ the same from the exact stack, within the budget
exact() { # LAYERS: energies of the three channels at mu 0.5
    echo "{\"layers\": [$1]}" >one.json
    "$LACQUER" stack one.json --mu 0.5 --format csv | tail -n +2 | cut -d, -f3 | tr '\n' ' '
    echo
}
{
    exact '{"conductor": {"n": [0.14, 0.43, 1.38], "kappa": [3.697, 2.455, 1.914], "alpha": 0.3}}'
    exact '{"dielectric": {"n": 1.5, "alpha": 0.3}}, {"lambertian": {"rho": [0.7, 0.05, 0.04]}}'
    exact '{"dielectric": {"n": 1.5, "alpha": 0.2}}, {"lambertian": {"rho": [0.5, 0.25, 1.0]}}'
    echo "0.8 1"
} >want.txt
paste -d' ' want.txt got.txt | awk '{h = NF / 2; for (i = 1; i <= h; i++) {d = $i - $(i + h); if (d < 0) d = -d; if (d > 0.004) bad = 1}}
    END {exit bad || NR != 4}' || fail "decoded $(cat got.txt); the exact stack says $(cat want.txt)"

# ------------------------------------------------ as a GPU decodes it, by the program
"$LACQUER" eval --from pack lacquer_gold mu=0.5 alpha=0.3 | awk '{print $2}' | head -3 | tr '\n' ' ' >program.txt
awk 'NR == FNR {for (i = 1; i <= 3; i++) want[i] = $i; next} FNR == 1 {for (i = 1; i <= 3; i++) {d = $i - want[i]; if (d < 0) d = -d; if (d > 3e-3) bad = 1}}
    END {exit bad}' program.txt got.txt || fail "eval --from a pack says $(cat program.txt), its C $(head -1 got.txt)"
run 0 eval --from pack varnish mu=0.5 alpha=0.2 rho.r=0.5 rho.g=0.25 rho.b=1 --format csv
says '^mu,alpha,rho.r,rho.g,rho.b,top.r'
refused "has no function 'silver'; accepted: albedo, gold, red-plastic, varnish, white" eval --from pack silver mu=1
refused 'alpha = 0.7 is out of range; accepted: 0.1 to 0.5' eval --from pack gold mu=1 alpha=0.7
refused 'which function of pack' eval --from pack mu=1
run 0 info pack
says '^  lacquer_varnish: [0-9]+ bytes, [12] fetch'
says '^    rho +0 to 1$'
says '^files: as they were made$'
run 0 info pack --format json
python3 -c 'import json; m = json.load(open("out")); assert [f["name"] for f in m["materials"]] == ["gold", "red-plastic", "varnish", "white"]' ||
    fail "info --format json of a pack"

# ------------------------------------------------ read back
run 0 validate pack --points 1000 --junit said.xml --report said
says '^  passed  varnish '
says 'files as made'
# Every report has the materials, and the same figures of them.
run 0 validate pack --points 1000 --json
python3 - <<'END' || fail "materials in the reports of a pack"
import json, re, xml.etree.ElementTree as tree
said, page = json.load(open("out")), open("said/index.html").read()
assert said["name"] == "four" and said["passed"]
assert [m["material"] for m in said["materials"]] == ["gold", "red-plastic", "varnish", "white"]
suite = [s for s in tree.parse("said.xml").getroot() if s.get("name") == "materials"][0]
assert len(suite) == 12 and suite.get("failures") == "0"
for m in said["materials"]:
    assert re.search(rf'<td>{m["material"]}</td><td class="passed">passed</td><td>{m["max"]:.2e}</td>', page), m
END
run 2 validate pack --points 1000 --budget max=1e-9 --json
python3 -c 'import json; s = json.load(open("out")); assert not s["passed"] and not s["materials"][0]["passed"]' ||
    fail "a material over its budget has passed"
printf '\x3c' | dd of=pack/atlas.ktx2 bs=1 seek=3001 conv=notrunc 2>/dev/null
run 2 validate pack --points 1000
says 'FAILED  files as made'

# ------------------------------------------------ refusals
refused "no recipe 'scen'; accepted: a JSON file, or one of those shipped: .*dfg, .*scene" pack scen -o none
bad() { # PATTERN MATERIALS
    echo "{\"name\": \"bad\", \"formats\": [\"ktx2\"], \"materials\": [
$2]}" >bad.json
    refused "^lacquer pack: bad.json:( line )?$1" pack bad.json -o none
    [ ! -e none ] || fail "a folder for a bad scene"
}
coat='{"dielectric": {"n": 1.5, "alpha": 0.1}}'
bad '2: a material without a name' '{"layers": [{"lambertian": {"rho": 1}}]}'
bad "3: a second material 'a'" '{"name": "a", "layers": [{"lambertian": {"rho": 1}}]},
{"name": "a", "layers": [{"lambertian": {"rho": 1}}]}'
bad '.*2: layer 1: alpha is missing' '{"name": "a", "layers": [{"conductor": {"n": 1, "kappa": 2}}]}'
bad '2: the last layer lets light through' "{\"name\": \"a\", \"layers\": [$coat]}"
bad ".*unknown key 'colour'" '{"name": "a", "colour": 1, "layers": [{"lambertian": {"rho": 1}}]}'
bad "2: the name 'mix' makes lacquer_ 'mix'" '{"name": "mix", "layers": [{"lambertian": {"rho": 1}}]}'
bad "2: the name 'albedo'" '{"name": "albedo", "layers": [{"lambertian": {"rho": 1}}]}'
sed 's/"p99": 4e-3/"p99": 2.5e-4/; s/"max": 2e-2/"max": 2.5e-4/' four.json >fine.json
run 2 pack fine.json -o none
grep -q 'fine.json:[0-9]*: .* misses its budget' err || fail "a missed budget says $(cat err)"
[ ! -e none ] || fail "a pack that misses its budget"

[ "$failures" -eq 0 ]
