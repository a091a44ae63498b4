#!/usr/bin/env bash
# `lacquer validate` with a certificate: budgets decide the exit code, every report is well formed.
set -euo pipefail
: "${LACQUER:?path of the program}"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
failures=0

fail() {
    echo "FAIL: $*" >&2
    failures=$((failures + 1))
}

# run CODE ARGUMENTS...: out, err hold what it printed.
run() {
    local code=$1 got=0
    shift
    "$LACQUER" "$@" >out 2>err || got=$?
    [ "$got" -eq "$code" ] || fail "lacquer $*: exit $got, expected $code: $(cat out err)"
}

refused() { # PATTERN ARGUMENTS...
    local pattern=$1
    shift
    run 1 "$@"
    [ "$(wc -l <err)" -eq 1 ] || fail "lacquer $*: not one line: $(cat err)"
    grep -qE -e "$pattern" err || fail "lacquer $*: '$(cat err)' does not match '$pattern'"
}

says() {
    grep -qE -e "$1" out || fail "no '$1' in: $(cat out)"
}

"$LACQUER" precompute tir-loss --axis mu=0:1:33 --axis alpha=0:1:33 --axis eta=0:1:33 -o loss.exr >/dev/null
on=(--on mu=0.1:1,alpha=0.2:1 --points 20000)

run 0 validate loss.exr --budget max=5e-2,p99=1e-2 "${on[@]}"
says '20032 exact values in 313 independent blocks'
says 'interpolation'
says 'passed  budget p99 .*with 95 % confidence'
says '^passed$'
mv out two
run 0 validate loss.exr --budget max=5e-2,p99=1e-2 "${on[@]}" --threads 1
cmp -s two out || fail "one thread changes the certificate"
run 2 validate loss.exr --budget max=5e-2,p99=1e-5 "${on[@]}" --junit loss.xml --json
says '"complaint": "budget p99"'
says '"effective_points"'
grep -q '<testsuite name="loss.exr" tests="8" failures="1"' loss.xml || fail "JUnit: $(cat loss.xml)"
python3 - <<'PY' || fail "a report is not well formed"
import json, xml.etree.ElementTree as tree
report = json.load(open("out"))
table = report["tables"][0]
assert table["points"] >= 20000 and not report["passed"]
assert table["total"]["rms"] <= table["total"]["p99"] <= table["total"]["p99_limit"] <= table["total"]["max"]
assert table["search"]["error"] >= 0.9 * table["total"]["max"]
cases = tree.parse("loss.xml").getroot().findall("testsuite/testcase")
assert [c.get("name") for c in cases if c.find("failure") is not None] == ["budget p99"]
PY

# the page: one file, every pair of axes, what each term buys; nothing is fetched
"$LACQUER" precompute tir-pass --axis mu=0.05:1:17 --axis alpha=0.1:1:9 --axis eta=1.1:2.5:9 -o pass.exr >/dev/null
"$LACQUER" pca pass.exr --separate eta:4 -o factors.exr >/dev/null
run 0 validate factors.exr --table pass.exr --budget max=5e-2 --points 5000 --report page
for part in integration interpolation factorisation half-float filter; do says "^  $part "; done
python3 - <<'PY' || fail "the page is not what it should be"
import html.parser
text = open("page/index.html", encoding="utf-8").read()
class Parser(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.open, self.maps, self.titles, self.cells, self.rings = [], 0, [], 0, 0
    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        assert not {"src", "onclick"} & set(attributes) and tag not in ("script", "link", "img")
        assert not attributes.get("href", "#").startswith("http")
        if tag == "path" and "fill" in attributes: self.cells += attributes["d"].count("M")
        self.rings += tag == "circle" and attributes["stroke"] == "#fff"
        if tag not in ("meta", "rect", "path", "polyline", "circle"): self.open.append(tag)
    def handle_endtag(self, tag):
        if tag not in ("rect", "path", "polyline", "circle"): assert self.open.pop() == tag, tag
    def handle_data(self, data):
        if self.open and self.open[-1] == "title": self.titles.append(data)
page = Parser()
page.feed(text)
assert not page.open
for pair in ("mu and alpha", "mu and eta", "alpha and eta"): assert f"largest error over {pair}" in page.titles, page.titles
assert "Errors of the points" in page.titles and "Terms, bytes and error" in page.titles
assert page.cells > 400 and page.rings == 3 # the worst point, in each map
assert '<b class="passed">Passed:</b>' in text and "<time datetime=" in text
assert text.index("The worst is off by") < text.index("<section")
PY

# a budget file: what the table does not say comes from the top
cat >budget.json <<'JSON'
{"max": 1e-6, "on": {"mu": [0.1, 1]}, "tables": {"tir-loss": {"max": 5e-2, "on": {"mu": [0.1, 1], "alpha": [0.2, 1]}}}}
JSON
run 0 validate loss.exr --budget budget.json --points 5000
says 'alpha 0.2 to 1'
sed 's/tir-loss/tir-pass/' budget.json >other.json
run 2 validate loss.exr --budget other.json --points 5000

# a folder: every table of it; a factor file needs no option
mkdir tables
cp loss.exr factors.exr tables/
run 2 validate tables --budget budget.json --points 2000 --junit tables.xml
says '^factors.exr: tir-pass'
says '^loss.exr: tir-loss'
[ "$(grep -c '<testsuite ' tables.xml)" -eq 2 ] || fail "JUnit of a folder: $(cat tables.xml)"
run 0 validate factors.exr --points 500
says 'single texels'
mkdir empty
refused "no table in the folder 'empty'" validate empty
head -c 3000 loss.exr >tables/cut.exr
refused 'tables/cut.exr' validate tables --points 500

echo '{"maximum": 1}' >key.json
refused "key.json: unknown key 'maximum'; accepted: max, p99" validate loss.exr --budget key.json
echo '{"max": }' >syntax.json
refused 'syntax.json:1: not JSON' validate loss.exr --budget syntax.json
refused "budget 'max=x'" validate loss.exr --budget max=x
refused "domain 'mu'" validate loss.exr --on mu
refused 'no part of axis mu lies in 2 to 3' validate loss.exr --on mu=2:3
refused 'needs a factor file' validate loss.exr --certificate --table loss.exr
refused 'against the solver' validate loss.exr --certificate --against walk
exit "$((failures > 0))"
