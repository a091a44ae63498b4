#!/usr/bin/env bash
# `lacquer view`: images whose pixels are the table's values, pages that hold its numbers and need nothing else,
# refusals that leave nothing behind, and, where there is Chromium, what a reader does with a page.
set -euo pipefail
cd "${LACQUER_SOURCE:-$(dirname "$0")/..}"
lacquer=${LACQUER:-$PWD/build/release/lacquer}
source=$PWD
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
mkdir out

fail() {
    echo "FAILED: $*" >&2
    exit 1
}
check() { # FUNCTION ARGUMENTS of tests/view.py
    PYTHONDONTWRITEBYTECODE=1 python3 "$source/tests/view.py" "$@" || fail "view.py $*"
}
asked() { # CODE of Python, about `p`, the data of page $1
    PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=$source/tests python3 -c "
import sys
from view import *
p = page(sys.argv[1])
$2" "$1" || fail "$1: $2"
}
refused() { # PATTERN ARGUMENTS...
    local pattern=$1 got=0
    shift
    "$lacquer" view "$@" >said.out 2>said || got=$?
    [ "$got" -eq 1 ] || fail "view $*: exit $got: $(cat said)"
    [ "$(wc -l <said)" -eq 1 ] || fail "view $*: not one line: $(cat said)"
    grep -qE -e "$pattern" said || fail "view $*: '$(cat said)' does not match '$pattern'"
    [ -z "$(ls -A out)" ] || fail "view $*: left $(ls -A out)"
}

# ------------------------------------------------------------------------------------ a table
"$lacquer" precompute tir-pass --axis mu=0:1:9:sqrt --axis alpha=0:1:5 --axis eta=0.5:0.9:4 --tolerance 1e-3 \
    -o t.exr >/dev/null
"$lacquer" view t.exr -o out/t.html
"$lacquer" view t.exr --at eta=0.5 -o out/t.png
"$lacquer" view t.exr --x eta --y mu --at alpha=0.3 -o out/t.svg
check check_nodes out/t.png out/t.html 9 5
python3 -c 'import sys, xml.dom.minidom as d; assert d.parse(sys.argv[1]).documentElement.tagName == "svg"' out/t.svg
# The page holds every value as the table does.
"$lacquer" precompute tir-pass --axis mu=0:1:9:sqrt --axis alpha=0:1:5 --axis eta=0.5:0.9:4 --tolerance 1e-3 \
    -o t.npy >/dev/null
asked out/t.html '
assert base64.b64decode(p["table"]["values"][0]) == open("t.npy", "rb").read()[-720:]
assert [a["name"] for a in p["table"]["axes"]] == ["mu", "alpha", "eta"]
assert p["table"]["axes"][0]["meaning"] == "cosine of incidence"
assert abs(p["table"]["axes"][0]["nodes"][4] - 0.25) < 1e-12 and p["table"]["axes"][0]["exponent"] == 2'
grep -q 'id="thinned"' out/t.html && fail "a small table is thinned"

# Chosen ends of the colours: 0.2 to 0.3 clamps most of the map to the two of them.
"$lacquer" view t.exr --range 0.2:0.3 -o out/ends.png
cmp -s out/t.png out/ends.png && fail "--range changes nothing"
# The same command, the same bytes.
"$lacquer" view t.exr --at eta=0.5 -o out/again.png
cmp out/t.png out/again.png

# One axis, several channels, values of both signs, of none, and a table too large.
"$lacquer" precompute albedo-average --tolerance 1e-3 -o a.exr >/dev/null
"$lacquer" view a.exr -o out/a.png
"$lacquer" view a.exr -o out/a.html
asked out/a.html 'assert p["table"]["start"]["y"] == -1'
PYTHONPATH=$source/tests PYTHONDONTWRITEBYTECODE=1 python3 -c '
from view import write_npy
write_npy("large.npy", [700, 700], lambda i: i / 490000)
write_npy("odd.npy", [4, 5], lambda i: float("nan") if i == 7 else i - 3)'
for name in large odd; do
    echo '{"table": "albedo", "axes": [{"name": "alpha", "nodes": "0:1:ROWS"}, {"name": "mu", "nodes": "0:1:COLUMNS"}]}' |
        if [ $name = large ]; then sed 's/ROWS/700/; s/COLUMNS/700/'; else sed 's/ROWS/4/; s/COLUMNS/5/'; fi >$name.json
done
"$lacquer" view large.npy --axes large.json -o out/large.html
[ "$(stat -c %s out/large.html)" -le 2000000 ] || fail "a page of $(stat -c %s out/large.html) bytes"
grep -q 'id="thinned">Thinned to fit this page: ' out/large.html || fail "nothing says that the page is thinned"
asked out/large.html '
a = p["table"]["axes"]
assert a[0]["nodes"][0] == 0 and a[0]["nodes"][-1] == 1 and a[0]["size"] == 700
n, m = len(a[0]["nodes"]), len(a[1]["nodes"])
v = floats(p["table"]["values"][0])
assert len(v) == n * m and n * m > 300000 and v[0] == 0 and abs(v[-1] - 489999 / 490000) < 1e-6
assert abs(v[5 * n + 7] - (round(a[1]["nodes"][5] * 699) * 700 + round(a[0]["nodes"][7] * 699)) / 490000) < 1e-6'
"$lacquer" view odd.npy --axes odd.json -o out/odd.png
"$lacquer" view odd.npy --axes odd.json -o out/odd.html
asked out/odd.html '
width, height, rows = png("out/odd.png")
steps, bad = colours(p, "signed"), tuple(bytes.fromhex(p["colours"]["bad"]))
at = lambda x, y: rows[228 + 299 * (3 - y)][132 + 299 * x]
assert at(2, 1) == bad, at(2, 1)
assert at(3, 0) in steps[127:129] and at(4, 3) == steps[255], (at(3, 0), at(4, 3))
assert at(0, 0) == steps[round(255 * 13 / 32)], at(0, 0)'
rm out/*

# --------------------------------------------------------------------- factors, a pack, a stack
"$lacquer" pca t.exr --separate eta --bases 2 -o f.exr >/dev/null
"$lacquer" view f.exr -o out/f.png
"$lacquer" view f.exr -o out/f.html
asked out/f.html 'assert [x["form"] for x in p["panels"]] == ["map", "map", "lines"]'
grep -q '<th>pca-max</th><td>[0-9.e-]*</td>' out/f.html || fail "the page of factors does not tell their error"

cat >r.json <<'END_OF_RECIPE'
{"name": "small", "formats": ["ktx2"], "points": 100, "tables": [
 {"table": "dfg", "axes": {"mu": "0:1:24:sqrt", "alpha": "0:1:16"}, "tolerance": 1e-3},
 {"table": "tir-pass", "axes": {"mu": "0:1:8", "alpha": "0:1:6", "eta": "0.5:0.9:5"}, "tolerance": 1e-3,
  "pca": {"separate": "eta:2"}}]}
END_OF_RECIPE
"$lacquer" pack r.json -o p --cache c >/dev/null
"$lacquer" view p -o out/p.png
"$lacquer" view p -o out/p.html
asked out/p.html '
m = json.load(open("p/manifest.json"))
assert [x["title"] for x in p["panels"][:3]] == ["dfg A", "dfg B", "tir-pass"], [x["title"] for x in p["panels"]]
assert len(p["panels"]) == 6
text = open("out/p.html", encoding="utf-8").read()
for t in m["tables"]:
    assert f"{t['"'bytes'"']} bytes, " in text and f"max {t['"'error'"']['"'max'"']:.2g}" in text, t["name"]'

# A scene: the lobes of a material add up to what its stack returns.
cat >scene.json <<'END_OF_SCENE'
{"name": "metal", "formats": ["ktx2"], "points": 100, "budget": {"max": 1e-2}, "materials": [
 {"name": "frosted", "layers": [{"dielectric": {"n": 1.5, "alpha": 0.2}},
  {"conductor": {"n": 0.2, "kappa": 3.9, "alpha": {"min": 0.05, "max": 0.45}}}]}]}
END_OF_SCENE
"$lacquer" pack scene.json -o scene --cache c >/dev/null
"$lacquer" view scene -o out/m.html
echo '{"layers": [{"dielectric": {"n": 1.5, "alpha": 0.2}}, {"conductor": {"n": 0.2, "kappa": 3.9, "alpha": 0.25}}]}' >m.json
reflected=$("$lacquer" stack m.json --mu 0.25 --format csv | awk -F, 'NR == 2 { print $3 }')
asked out/m.html "
panel = p['panels'][0]
n, v = len(panel['x']['nodes']), floats(panel['values'])
i = min(range(n), key=lambda k: abs(panel['x']['nodes'][k] - 0.25))
assert panel['title'] == 'frosted' and panel['caption'].startswith('alpha 0.25 ') and len(v) == 3 * n
assert abs(panel['x']['nodes'][i] - 0.25) < 1e-12 and abs(sum(v[i::n]) - $reflected) < 1e-2, (sum(v[i::n]), $reflected)"

stack=$source/recipes/stacks/frosted-metal.json
"$lacquer" view "$stack" -o out/s.svg
"$lacquer" view "$stack" -o out/s.html
"$lacquer" stack "$stack" --mu 1,0.25 --format csv >s.csv
asked out/s.html '
import csv
panel = p["panels"][0]
n = len(panel["x"]["nodes"])
v = floats(panel["values"])
assert panel["form"] == "areas" and len(v) == n * len(panel["series"])
for row in csv.DictReader(open("s.csv")):
    i = min(range(n), key=lambda k: abs(panel["x"]["nodes"][k] - float(row["mu"])))
    assert abs(panel["x"]["nodes"][i] - float(row["mu"])) < 1e-12
    assert abs(sum(v[i::n]) - float(row["reflected"])) < 3e-4, (row, sum(v[i::n]))'
# What a file says is text, and nothing else.
sed 's#"frosted-metal"#"</script><img src=x onerror=alert(1)>\&\\"\\u0001"#' "$stack" >evil.json
"$lacquer" view evil.json -o out/evil.html
asked out/evil.html 'assert "<img" not in open("out/evil.html", encoding="utf-8").read()'
"$lacquer" view evil.json -o out/evil.svg
python3 -c 'import xml.dom.minidom as d; d.parse("out/evil.svg")'
rm out/*

# ----------------------------------------------------------------------------------- refusals
refused 'nothing to view'
refused 'no output; .*-o' t.exr
refused "accepted: names that end in .html, .png or .svg" t.exr -o out/t.jpg
refused "accepted: names that end in .html, .png or .svg" t.exr -o out/.png/..
refused 'unexpected' t.exr t.exr -o out/t.png
refused "^lacquer view: --x: no axis 'nu'; accepted: mu, alpha, eta$" t.exr --x nu -o out/t.png
refused "'mu' is the axis of --x" t.exr --x mu --y mu -o out/t.png
refused "axis of several nodes, 'alpha', which is drawn along --x" a.exr --y alpha -o out/t.png
refused 'not NAME=VALUE' t.exr --at eta -o out/t.png
refused "no axis 'nu'; accepted" t.exr --at nu=1 -o out/t.png
refused '--at eta.* from 0.5 to 0.9' t.exr --at eta=1.5 -o out/t.png
refused '--at eta' t.exr --at eta=nan -o out/t.png
refused '--at eta: given twice' t.exr --at eta=0.5 --at eta=0.6 -o out/t.png
refused 'that axis is drawn' t.exr --at mu=0.5 -o out/t.png
refused "no channel 'q'; accepted: pass" t.exr --channel q -o out/t.png
refused 'LOW < HIGH' t.exr --range 1:1 -o out/t.png
refused 'LOW < HIGH' t.exr --range=-1e300:1e300 -o out/t.png
refused 'LOW < HIGH' t.exr --range 0:x -o out/t.png
refused 'say it with --axes' t.npy -o out/t.png
refused 'needs --kind' t.npy --layout tm -o out/t.png
refused '--x has no effect for factors' f.exr --x mu -o out/t.png
refused '--at has no effect for a pack' p --at mu=1 -o out/t.png
refused '--channel has no effect for a stack' "$stack" --channel a -o out/t.png
refused '--tolerance has no effect for a table' t.exr --tolerance 1e-3 -o out/t.png
refused 'out: a folder without manifest.json; accepted: a pack' out -o out/t.png
refused 'missing.exr' missing.exr -o out/t.png
refused 'cannot write' t.exr -o missing/t.png
head -c 700 t.exr >cut.exr
refused 'cut.exr' cut.exr -o out/t.png
echo '{"layers": []}' >empty.json
refused 'empty.json' empty.json -o out/t.html
if [ -e /dev/full ]; then
    ln -s /dev/full full.png
    refused 'full' t.exr -o full.png
    ln -s /dev/full full.html
    refused 'full' t.exr -o full.html
fi

# ---------------------------------------------------------------------------------- a browser
chromium=$(command -v chromium || command -v chromium-browser || true)
[ -n "$chromium" ] || exit 0
# view PAGE SCRIPT: what the script, which runs once the page is drawn, puts into `said`; errors of any kind first.
view() {
    python3 - "$1" "$2" <<'END_OF_PYTHON'
import sys
text = open(sys.argv[1], encoding="utf-8").read()
watch = "<script>window.faults = []; onerror = (m) => { faults.push(m); }; console.error = (m) => { faults.push(m); };</script>"
act = """<pre id="said"></pre><script>setTimeout(() => {
const set = (id, v, event) => { const e = document.getElementById(id); e.value = v; e.dispatchEvent(new Event(event)); };
const value = () => document.getElementById('value').textContent;
const pixel = (x, y) => { const m = document.getElementById('map');
    return [...m.getContext('2d').getImageData(x, y, 1, 1).data].slice(0, 3).join(); };
const said = [];
%s
document.getElementById('said').textContent = faults.concat(said).join('\\n') + '\\nend';
}, 500);</script>""" % sys.argv[2]
text = text.replace("<head>", "<head>" + watch, 1).replace("</body>", act + "</body>", 1)
open("out/watched.html", "w", encoding="utf-8").write(text)
END_OF_PYTHON
    timeout 100 "$chromium" --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --no-first-run \
        --disable-extensions --disable-background-networking --user-data-dir="$work/profile" \
        --window-size="${3:-1200},900" --virtual-time-budget=5000 --dump-dom "file://$work/out/watched.html" 2>/dev/null |
        sed -n '/<pre id="said">/,/end<\/pre>/p' | sed 's/<pre id="said">//; s/^end<\/pre>.*//' | grep . || true
}
value_at() { # POINT...: of the table, in six digits
    "$lacquer" eval --from t.exr "$@" | awk '{ printf "%.6g\n", $1 }'
}
"$lacquer" view t.exr --x mu --y alpha --at eta=0.5 -o out/t.html
view out/t.html "
said.push(value());
set('at-eta', 1, 'input');
said.push(value());
set('at-eta', 0.4, 'input');
said.push(value());
set('axis-x', 2, 'change');
said.push(document.getElementById('at-mu').value);
set('along', 0, 'change');
said.push(document.getElementById('curve-title').textContent);
" >seen
{
    echo "$(value_at mu=0.25 alpha=0.5 eta=0.5) pass at mu 0.25, alpha 0.5, eta 0.5"
    echo "$(value_at mu=0.25 alpha=0.5 eta=0.9) pass at mu 0.25, alpha 0.5, eta 0.9"
    echo "$(value_at mu=0.25 alpha=0.5 eta=0.66) pass at mu 0.25, alpha 0.5, eta 0.66"
    echo 0.5
    echo 'Along mu, through the point'
} | diff - seen || fail "the page of a table, in a browser"
# A narrow page is no wider than its window. The corner of the map has the colour of its value, and arrow keys go there.
"$lacquer" view t.exr --at eta=0.5 --range 0:1 -o out/t.html
view out/t.html "
said.push(document.documentElement.scrollWidth <= innerWidth);
const hex = JSON.parse(document.getElementById('data').textContent).colours.value, corner = pixel(60, 12);
for (const key of ['ArrowLeft', 'ArrowUp'])
    for (let i = 0; i < 9; i++) document.getElementById('map').dispatchEvent(new KeyboardEvent('keydown', { key }));
said.push(value());
const at = 6 * Math.round(255 * parseFloat(value()));
said.push(corner === [0, 2, 4].map(k => parseInt(hex.slice(at + k, at + k + 2), 16)).join());
" 500 >seen
printf 'true\n%s pass at mu 0, alpha 1, eta 0.5\ntrue\n' "$(value_at mu=0 alpha=1 eta=0.5)" | diff - seen ||
    fail "a narrow page"
"$lacquer" view p -o out/p.html
view out/p.html "said.push(document.querySelectorAll('#panels canvas').length);" >seen
echo 6 | diff - seen || fail "the page of a pack, in a browser"
