#!/usr/bin/env bash
# lacquer pack never removes what is not its own: foreign folders, added or changed files, links; signals and kills
# leave no staging folder behind.
. "$(dirname "$0")/scratch.sh"

cat >small.json <<'END'
{"name": "small", "formats": ["npy", "c"], "points": 100,
 "tables": [{"table": "albedo", "axes": {"mu": "0:1:8", "alpha": "0:1:8"}, "tolerance": 1e-3}]}
END
"$lacquer" pack small.json -o good >/dev/null

entries() {
    { find . "$1/" -maxdepth 1 ! -path './message.txt' ! -path './before.txt' 2>/dev/null || true; } | sort
}

refuse() { # FOLDER PATTERN: exit 1, one line, everything still there
    local code=0
    entries "$1" >before.txt
    "$lacquer" pack small.json -o "$1" >/dev/null 2>message.txt || code=$?
    [ "$code" = 1 ] || fail "-o $1: exit $code: $(cat message.txt)"
    [ "$(wc -l <message.txt)" = 1 ] && grep -qE "$2" message.txt || fail "-o $1: '$(cat message.txt)', not $2"
    entries "$1" | diff before.txt - || fail "-o $1 changed"
}

# --------------------------------------------------- a web app, with a manifest of its own
mkdir -p web/src && echo '{}' >web/manifest.json && echo x >web/thesis.tex
refuse web 'web.*no pack of this program'
[ "$(cat web/thesis.tex)" = x ] && [ -d web/src ] || fail "a foreign folder lost its files"
ln -s web link && refuse link 'link.*no pack of this program'
[ -L link ] || fail "the link is gone"
echo '{"format": "lacquer-pack", "version": 99, "files": {}}' >web/manifest.json
refuse web 'version 99'
echo '{"format": "lacquer-pack", "version": 1, "files": {"../small.json": "00000000"}}' >web/manifest.json
refuse web 'damaged'
echo '{"format": "lacquer-pack", "version": 1, "files": {}}' >web/manifest.json
refuse web "cannot replace .*'(src|thesis.tex)' is not part of the pack"

# --------------------------------------------------- packs with something added, or changed
cp -r good added && echo x >added/notes.txt
refuse added "'notes.txt' is not part of the pack"
cp -r good nested && mkdir nested/deeper
refuse nested "'deeper' is not part of the pack"
cp -r good changed && echo '// mine' >>changed/decode.h
refuse changed "'decode.h' was changed"
cp -r good swapped && mv swapped/decode.h mine.h && ln -s "$PWD/small.json" swapped/decode.h
refuse swapped "'decode.h' was changed"

# --------------------------------------------------- what may be replaced: a pack, an empty folder, one behind a link
cp -r good again && "$lacquer" pack small.json -o again >/dev/null && diff -r good again || fail "a pack is not replaced"
mkdir empty && "$lacquer" pack small.json -o empty/ >/dev/null && diff -r good empty || fail "an empty folder"
cp -r good real && ln -s real to-real && "$lacquer" pack small.json -o to-real >/dev/null || fail "through a link"
[ -L to-real ] && diff -r good real || fail "a link was replaced"

# --------------------------------------------------- before the work: the current folder, the root, a file, nothing
cd empty
code=0
"$lacquer" pack ../small.json -o . >/dev/null 2>../message.txt || code=$?
cd ..
[ "$code" = 1 ] && grep -q 'current folder' message.txt || fail "-o .: $code, $(cat message.txt)"
refuse / 'root of a file system'
refuse small.json 'it is a file'
ln -s nowhere dangling && refuse dangling 'link to nothing'

# --------------------------------------------------- signals while files are written leave nothing; kill -9 is cleared
for i in $(seq 1 40); do
    "$lacquer" pack small.json -o "signal$((i % 2))" >/dev/null 2>&1 &
    job=$!
    sleep "0.0$((RANDOM % 60 + 10))"
    if [ $((i % 4)) -lt 2 ]; then kill -TERM "$job" 2>/dev/null || true; else kill -INT "$job" 2>/dev/null || true; fi
    wait "$job" || true
    [ -z "$(find . -maxdepth 1 -name '*.new-*')" ] || fail "a signal left $(ls -d ./*.new-*)"
done
mkdir killed.new-AAAAAA && touch killed.new-AAAAAA/.lacquer-staging killed.new-AAAAAA/dfg.ktx2 # as kill -9 leaves it
mkdir killed.new-BBBBBB && touch killed.new-BBBBBB/thesis.tex                                  # a folder of someone's
mkdir killed.new-CCCCCC && touch killed.new-CCCCCC/.lacquer-staging                            # one at work
flock killed.new-CCCCCC "$lacquer" pack small.json -o killed >/dev/null
[ ! -e killed.new-AAAAAA ] || fail "what kill -9 left is not cleared"
[ -e killed.new-BBBBBB/thesis.tex ] || fail "a folder that only has the name was cleared"
[ -e killed.new-CCCCCC ] || fail "the folder of a run at work was cleared"
rm -rf killed.new-*
for i in $(seq 1 60); do # at any moment, over a pack that is there
    "$lacquer" pack small.json -o killed >/dev/null 2>&1 &
    job=$!
    sleep "0.0$((RANDOM % 40 + 10))"
    kill -KILL "$job" 2>/dev/null || true
    wait "$job" 2>/dev/null || true
done
"$lacquer" pack small.json -o killed >/dev/null || fail "after kills: $(ls -a killed)"
diff -r good killed && [ -z "$(find . -maxdepth 1 -name 'killed.new-*')" ] || fail "kill -9 left $(ls -d killed.new-*)"

# --------------------------------------------------- names that would write one thing over another
names() { # FORMATS NAME...: a recipe of albedo tables of these names
    local formats=$1 first=1
    shift
    echo "{\"name\": \"names\", \"formats\": [$formats], \"points\": 100, \"tables\": ["
    for name in "$@"; do
        [ "$first" = 1 ] || echo ","
        first=0
        echo "{\"table\": \"albedo\", \"name\": \"$name\", \"axes\": {\"mu\": \"0:1:4\", \"alpha\": \"0:1:4\"}, \"tolerance\": 1e-2}"
    done
    echo "]}"
}
refuse_names() { # LINE PATTERN FORMATS NAME...
    local line=$1 pattern=$2 code=0
    shift 2
    names "$@" >names.json
    "$lacquer" pack names.json -o names >/dev/null 2>message.txt || code=$?
    [ "$code" = 1 ] && [ "$(wc -l <message.txt)" = 1 ] && grep -qE "names.json:$line: .*$pattern" message.txt ||
        fail "names $*: exit $code, $(cat message.txt)"
    [ ! -e names ] || fail "names $* made a folder"
}
for helper in texel filter clamp clamp01 cosine critical Clamp; do
    refuse_names 2 "which every pack has too" '"c"' $helper
done
refuse_names 4 "lacquer_.*'a_b', which a-b has too" '"ktx2"' a-b a_b
refuse_names 4 "'a_texels', which a has too" '"ktx2"' a a_texels
refuse_names 4 "the file .*, which a has too" '"ktx2"' a A
refuse_names 2 "the file 'decode.h', which every pack has" '"c"' decode
refuse_names 4 "the file 'a.zstd.ktx2', which a has" '"ktx2", "ktx2-zstd"' a a.zstd
for name in .hidden -o _a a--b a_; do refuse_names 2 "makes no identifier" '"ktx2"' "$name"; done

# What is accepted compiles, in every language there is a compiler for.
odd=(int main float4 2x A.b sampler2D value size table texture-1)
names '"c", "ktx2"' "${odd[@]}" >names.json
"$lacquer" pack names.json -o names >/dev/null || fail "odd names are refused"
{
    echo '#include "names/decode.h"'
    for name in "${odd[@]}"; do echo "#include \"names/$name.h\""; done
    echo 'int main(void) {'
    echo '    float v[1], sum = 0.0f;'
    for name in "${odd[@]}"; do
        id=${name//[-.]/_}
        echo "    lacquer_$id(lacquer_${id}_texels, 0.5f, 0.5f, v), sum += v[0];"
    done
    echo '    return sum > 5.0f && sum < 10.0f ? 0 : 1;'
    echo '}'
} >names.c
"${CC:-cc}" -std=c99 -Wall -Wextra -Werror -o names_c names.c -lm && ./names_c || fail "the C source of odd names"
if command -v glslangValidator >/dev/null; then
    {
        printf '#version 450\nlayout(location = 0) out vec4 color;\nlayout(binding = 0) uniform sampler2D t;\n'
        cat names/decode.glsl
        echo 'void main() { float sum = 0.0;'
        for name in "${odd[@]}"; do echo "sum += lacquer_${name//[-.]/_}(t, 0.5, 0.5);"; done
        echo 'color = vec4(sum); }'
    } >names.frag
    glslangValidator names.frag >message.txt || fail "the GLSL source of odd names: $(cat message.txt)"
fi

# --------------------------------------------------- the cache: links, pipes, entries that are not what was asked
cache=$PWD/store
"$lacquer" pack small.json -o cached --cache "$cache" >/dev/null
entry=$(find "$cache" -name '*.exr' | head -1)
[ "$(find "$cache" -type f | wc -l)" = "$(find "$cache" | tail -n +2 | wc -l)" ] || fail "more than files in the cache"
for entry in "$cache"/*.exr; do
    cp "$entry" entry.exr
    echo precious >victim
    ln -sf "$PWD/victim" "$entry" # planted: writing must not follow it
    "$lacquer" pack small.json -o cached --cache "$cache" >/dev/null && diff -r good cached || fail "a planted link"
    [ "$(cat victim)" = precious ] && [ ! -L "$entry" ] || fail "the target of a planted link was overwritten"
    rm "$entry" && mkfifo "$entry"
    timeout 20 "$lacquer" pack small.json -o cached --cache "$cache" >/dev/null || fail "a pipe in the cache hangs it"
    cmp entry.exr "$entry" || fail "the entry is not computed again"
done
# An entry of the right key with other values: text of the EXR header is kept, one byte of the data changed.
for entry in "$cache"/*.exr; do
    size=$(stat -c %s "$entry")
    for at in $((size - 20)) $((size / 2)); do
        printf '\x55' | dd of="$entry" bs=1 seek="$at" conv=notrunc 2>/dev/null
        "$lacquer" pack small.json -o cached --cache "$cache" >/dev/null && diff -r good cached || fail "a changed entry"
    done
done
# What a run that was killed left in the cache is cleared by the next that stores something: not what another run is
# working in, and nothing that is not this program's.
leave() { mkdir "$cache/new-$1" && echo half >"$cache/new-$1/$2"; }
leave aaaaaa exr && leave bbbbbb .lacquer-17-0 && leave cccccc exr && leave dddddd thesis.tex
mkdir "$cache/new-folder" && echo x >"$cache/new-folder-of-mine"
rm "$(find "$cache" -name '*.exr' | head -1)"
flock "$cache/new-cccccc" "$lacquer" pack small.json -o cached --cache "$cache" >/dev/null
[ ! -e "$cache/new-aaaaaa" ] && [ ! -e "$cache/new-bbbbbb" ] || fail "left over: $(ls "$cache")"
[ -e "$cache/new-cccccc/exr" ] && [ -e "$cache/new-dddddd/thesis.tex" ] && [ -e "$cache/new-folder-of-mine" ] ||
    fail "cleared what is not left over: $(ls "$cache")"
rm -r "$cache"/new-*
for wait in 01 02 03 04 05 06 07 08 09 10 11 12; do
    rm -f "$cache"/*.exr
    "$lacquer" pack small.json -o cached --cache "$cache" >/dev/null 2>&1 &
    killed=$!
    sleep "0.0$wait" && kill -9 $killed 2>/dev/null || true
    wait $killed 2>/dev/null || true
done
rm -f "$cache"/*.exr
"$lacquer" pack small.json -o cached --cache "$cache" >/dev/null && diff -r good cached || fail "after kills"
[ -z "$(find "$cache" -name 'new-*')" ] || fail "kill -9 leaves $(find "$cache" -name 'new-*')"
# Every kind of entry is found again: tables, values at points and on a grid, factors, mappings.
cat >kinds.json <<'END'
{"name": "kinds", "formats": ["npy"], "points": 100, "tables": [
 {"table": "albedo", "axes": {"mu": "0:1:8", "alpha": "0:1:8"}, "tolerance": 1e-3},
 {"table": "fgd-dielectric", "axes": {"mu": "0:1:4", "alpha": "0:1:3", "eta": "1.2:2:3"}, "tolerance": 1e-2},
 {"table": "albedo", "name": "factors", "axes": {"mu": "0:1:8", "alpha": "0:1:8"}, "tolerance": 1e-3,
  "pca": {"separate": "alpha:2"}},
 {"mapping": "f", "axes": {"alpha": "0.01:0.9:16"}}]}
END
"$lacquer" pack kinds.json -o kinds --cache "$cache" >/dev/null
(cd "$cache" && stat -c '%n %y %i' -- *.exr) >before.txt
"$lacquer" pack kinds.json -o kinds --cache "$cache" >/dev/null
(cd "$cache" && stat -c '%n %y %i' -- *.exr) | diff before.txt - || fail "entries were not found again"
if [ "$(id -u)" = 0 ]; then
    mkdir others && chown 12345 others
    code=0
    "$lacquer" pack small.json -o cached --cache others >/dev/null 2>message.txt || code=$?
    [ "$code" = 1 ] && grep -q 'belongs to another user' message.txt || fail "another's cache: $code, $(cat message.txt)"
fi
"$lacquer" pack small.json -o cached --cache /proc/none >/dev/null 2>message.txt && diff -r good cached ||
    fail "an unwritable cache fails the pack: $(cat message.txt)"
[ "$(wc -l <message.txt)" = 1 ] && grep -q 'going on without' message.txt || fail "unwritable cache: $(cat message.txt)"
