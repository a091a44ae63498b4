#!/usr/bin/env bash
# Which room calls which, by the undefined symbols of the object files: a call that was declared in lacquer.h counts as
# well. The table is that of test_includes.sh. And files of the library that call each other in a circle.
set -euo pipefail
: "${LACQUER_BUILD:?build folder}"
cd "${LACQUER_SOURCE:-$(dirname "$0")/..}"

LACQUER_MAY=$(sed -n '/^declare -A may=(/,/^)/p' tests/test_includes.sh) python3 - "$LACQUER_BUILD" <<'END_OF_PYTHON'
import collections, glob, os, re, subprocess, sys

may = {room: others.split() for room, others in re.findall(r'\[(\w+)\]="([^"]*)"', os.environ["LACQUER_MAY"])}
# Circles that are there: each is a whole that stands in several files. A new one fails, and so does one of these that
# is gone, so that the list only gets shorter.
known = """
microfacet/beckmann microfacet/ndf
pack/atlas_factors pack/atlas_source pack/general_source pack/lobes_source
picture/page picture/page_json
precompute/dielectric precompute/rough_level
precompute/evaluator precompute/kind_fgd
stack/model stack/model_baked
stack/model_shape stack/shape_moments
tables/published tables/published_mitsuba
"""
objects = [o for part in ("objects", "verbs")
           for o in glob.glob(f"{sys.argv[1]}/CMakeFiles/lacquer-{part}.dir/**/*.c.o", recursive=True)]
defined, wanted = {}, collections.defaultdict(set)
lines = subprocess.run(["nm", "-A"] + objects, capture_output=True, text=True, check=True).stdout.splitlines()
for line in lines:
    path, rest = line.split(":", 1)
    unit = re.search(r"\.dir/(.*)\.c\.o$", path).group(1)
    words = rest.split()
    if words[-2] == "U":
        wanted[unit].add(words[-1])
    elif words[-2] in "TDBRVW":
        defined[words[-1]] = unit
calls = {unit: {(defined[s], s) for s in symbols if s in defined} for unit, symbols in wanted.items()}
assert len(objects) > 250 and sum(map(len, calls.values())) > 2000, "the object files were not read"

failed = False
for unit, others in sorted(calls.items()):
    room = unit.split("/")[0]
    for other, symbol in sorted(others):
        target = other.split("/")[0]
        if room in may and target in may and target != room and target not in may[room]:
            print(f"{unit}.c calls {symbol} of {other}.c: {room}/ may not use {target}/", file=sys.stderr)
            failed = True

# Circles: the strongly connected parts (Tarjan 1972) of the calls between files of the library.
graph = {u: sorted({o for o, _ in c if o != u}) for u, c in calls.items() if not u.startswith("program/")}
index, low, stack, circles = {}, {}, [], set()


def visit(unit):
    index[unit] = low[unit] = len(index)
    stack.append(unit)
    for other in graph.get(unit, ()):
        if other not in index:
            visit(other)
        if other in stack:
            low[unit] = min(low[unit], low[other])
    if low[unit] == index[unit]:
        at = stack.index(unit)
        if len(stack) - at > 1:
            circles.add(" ".join(sorted(stack[at:])))
        del stack[at:]


sys.setrecursionlimit(5000)
for unit in sorted(graph):
    if unit not in index:
        visit(unit)
kept = set(filter(None, known.strip().splitlines()))
for circle in sorted(circles - kept):
    print(f"files that call each other in a circle: {circle}", file=sys.stderr)
for circle in sorted(kept - circles):
    print(f"no circle any more, take it off the list: {circle}", file=sys.stderr)
sys.exit(failed or circles != kept)
END_OF_PYTHON
