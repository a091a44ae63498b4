#!/usr/bin/env bash
# Files around the program: whose they are and who may read them, standard streams that are closed, reports with names
# that are not UTF-8, folders where everyone may write.
set -euo pipefail
: "${LACQUER:?path of the program}" "${LACQUER_SOURCE:?source folder}"
source "$LACQUER_SOURCE/tests/expect.sh"
own_folder
export XDG_CACHE_HOME=$work/xdg
table=(precompute albedo --axis mu=0.1:1:4 --axis alpha=0.2:1:3 -o)

# ------------------------------------------------------------------ who may read what is written
mode() { # FILE OCTAL
    [ "$(stat -c %a "$1")" = "$2" ] || fail "$1 has mode $(stat -c %a "$1"), not $2"
}
(umask 077 && run 0 "${table[@]}" private.exr)
mode private.exr 600
(umask 022 && run 0 "${table[@]}" private.exr && run 0 "${table[@]}" public.exr)
mode private.exr 600 # replaced: what only its owner could read stays so
mode public.exr 644
cat >small.json <<'END'
{"name": "small", "formats": ["npy"], "points": 100,
 "tables": [{"table": "albedo", "axes": {"mu": "0:1:8", "alpha": "0:1:8"}, "tolerance": 1e-3}]}
END
(umask 022 && run 0 pack small.json -o pack --cache "$work/cache")
mode cache 700
mode pack/manifest.json 644

# ------------------------------------------------------------------ closed streams: no file takes their place
reference=$(cksum <public.exr)
closed() { # NAME CODE: table written with streams closed
    [ "$2" -le 1 ] || fail "$1 closed: exit $2"
    [ ! -e closed.exr ] || [ "$(cksum <closed.exr)" = "$reference" ] || fail "$1 closed: the file holds something else"
    rm -f closed.exr
}
code=0 && "$LACQUER" "${table[@]}" closed.exr >&- 2>err || code=$?
closed stdout $code
[ "$code" -eq 0 ] || [ "$(wc -l <err)" -eq 1 ] || fail "stdout closed: $(cat err)"
code=0 && "$LACQUER" "${table[@]}" closed.exr 2>&- >out || code=$?
[ -e closed.exr ] || fail "stderr closed: no file"
closed stderr $code
code=0 && "$LACQUER" "${table[@]}" closed.exr <&- >out 2>err || code=$?
[ -e closed.exr ] || fail "stdin closed: no file"
closed stdin $code
code=0 && "$LACQUER" "${table[@]}" closed.exr <&- >&- 2>&- || code=$?
closed "every stream" $code
code=0 && "$LACQUER" list >&- 2>err || code=$?
[ "$code" -eq 1 ] && grep -q 'cannot write to standard output' err || fail "list into nothing: exit $code, $(cat err)"
code=0 && "$LACQUER" list >/dev/full 2>err || code=$?
[ "$code" -eq 1 ] && [ "$(wc -l <err)" -eq 1 ] || fail "list into a full disk: exit $code, $(cat err)"

# ------------------------------------------------------------------ reports with names that are not UTF-8
odd=$(printf 'o\377<&"\033.exr')
cp public.exr "$odd"
run 2 validate "$odd" --budget max=1e-9,p99=1e-9 --points 2000 --junit report.xml --json
python3 - <<'PY' || fail "a report of an odd name: $(head -c 600 report.xml)"
import json, xml.etree.ElementTree as tree
suite = tree.parse("report.xml").getroot().find("testsuite")
assert suite.get("name").startswith("o") and '<&"' in suite.get("name"), suite.get("name")
cases = suite.findall("testcase")
assert int(suite.get("tests")) == len(cases) > 1
assert int(suite.get("failures")) == sum(c.find("failure") is not None for c in cases) >= 1
report = json.load(open("out", encoding="utf-8"))
assert report["tables"][0]["file"].startswith("o") and not report["passed"]
PY

# ------------------------------------------------------------------ folders where everyone may write
if [ "$(id -u)" -eq 0 ]; then
    mkdir sticky && chmod 1777 sticky && chown 65533 sticky && mkdir home && chown 65534 . home && chmod 755 . home
    as_nobody() {
        setpriv --reuid 65534 --regid 65534 --clear-groups env HOME="$work/home" "$LACQUER" "$@"
    }
    if as_nobody --version >/dev/null 2>&1; then
        as_nobody pack small.json -o home/a --cache "$work/sticky" >out 2>err || fail "a sticky cache: $(cat err)"
        before=$(cd sticky && stat -c '%n %y %i' -- *.exr)
        as_nobody pack small.json -o home/b --cache "$work/sticky" >out 2>err || fail "a sticky cache, again: $(cat err)"
        [ "$before" = "$(cd sticky && stat -c '%n %y %i' -- *.exr)" ] || fail "entries of a sticky cache were not used"
        # Another's entries are neither used nor replaced.
        chown 65532 sticky/*.exr
        as_nobody pack small.json -o home/c --cache "$work/sticky" >out 2>err || fail "another's entries: $(cat err)"
        diff -r home/a home/c || fail "another's entries change the pack"
        [ "$before" = "$(cd sticky && stat -c '%n %y %i' -- *.exr)" ] || fail "another's entries were replaced"
        # The same folder without the sticky bit is refused.
        chmod 777 sticky
        code=0 && as_nobody pack small.json -o home/d --cache "$work/sticky" >out 2>err || code=$?
        [ "$code" -eq 1 ] && grep -q 'belongs to another user' err || fail "no sticky bit: exit $code, $(cat err)"
        # Another's file in a sticky folder is refused before the work.
        chmod 1777 sticky
        cp public.exr sticky/theirs.exr && chown 65532 sticky/theirs.exr && chmod 666 sticky/theirs.exr
        code=0 && as_nobody "${table[@]}" sticky/theirs.exr >out 2>err || code=$?
        [ "$code" -eq 1 ] && grep -q "another user's, in a sticky folder" err || fail "theirs: exit $code, $(cat err)"
    fi
fi

[ "$failures" -eq 0 ]
