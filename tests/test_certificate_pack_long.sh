#!/usr/bin/env bash
# Certificates of packs: what `lacquer pack` made passes within its own budget; one texel changed by 2 % (inside, on
# an edge, in a corner), another masking, texels half a cell off, a container that differs, a file that was altered
# or is cut short are found and named.
. "$(dirname "$0")/scratch.sh"

recipe() { # NAME FORMATS MASKING
    cat <<END_OF_RECIPE
{
  "name": "$1", "formats": [$2], "points": 1000, "budget": {"p99": 2e-3, "max": 1e-2},
  "tables": [
    {"table": "albedo", "axes": {"mu": "0.02:1:48:sqrt", "alpha": "0.02:1:32:sqrt"}, "tolerance": 1e-5, "masking": "$3"},
    {"table": "fgd-dielectric", "name": "r01", "tolerance": 5e-4,
     "axes": {"mu": "0.02:1:32:sqrt", "alpha": "0.02:1:18:sqrt", "eta": "1.1:2.5:16:sqrt"},
     "pca": {"separate": "eta:4", "norm": "p99", "sweeps": 10, "texels": "mu=48,alpha=48"}},
    {"mapping": "f", "axes": {"alpha": "0.02:0.9:512"}, "pca": {"value": "square"}}
  ]
}
END_OF_RECIPE
}

# --------------------------------------------------- as it is: passed, and every container is read
recipe good '"ktx2", "ktx2-zstd", "dds", "exr", "npy", "c"' correlated >good.json
"$lacquer" pack good.json -o good --cache cache >/dev/null
"$lacquer" validate good --junit good.xml --report page >good.txt || fail "a good pack: $(cat good.txt)"
for line in '^albedo: albedo, ggx' '^r01: fgd-dielectric' '^f: f, ggx' 'of 6, by their checksums' \
    'of 12, by their checksums' 'budget p99 .*<=  2.00e-03  met with 95 % confidence' 'half-float'; do
    grep -qE "$line" good.txt || fail "no line '$line' in $(cat good.txt)"
done
[ "$(grep -c '^passed$' good.txt)" = 3 ] || fail "three tables: $(cat good.txt)"
[ "$(grep -cE 'points +1[0-9]{5} exact values' good.txt)" = 3 ] || fail "10^5 exact values each: $(cat good.txt)"
grep -q '<testsuite name="r01"' good.xml && grep -q '</html>' page/index.html || fail "reports"
"$lacquer" validate good --points 3000 >quick.txt
"$lacquer" validate good --points 3000 --threads 1 | diff quick.txt - || fail "the report depends on the threads"
"$lacquer" validate good --points 3000 --parts >parts.txt || fail "with parts: $(cat parts.txt)"
for part in integration interpolation factorisation half-float filter; do
    [ "$(grep -c "^  $part  " parts.txt)" -ge 2 ] || fail "no $part in $(cat parts.txt)"
done
code=0
"$lacquer" validate good --points 3000 --budget max=1e-4 >/dev/null || code=$?
[ "$code" = 2 ] || fail "a budget that is missed: exit $code"

# --------------------------------------------------- faults
recipe one '"ktx2"' correlated >one.json
"$lacquer" pack one.json -o one --cache cache >/dev/null
found() { # PATTERN [TEXT]: in the report of pack `bad`, which must fail
    local code=0
    "$lacquer" validate bad --points 3000 >bad.txt || code=$?
    [ "$code" = 2 ] && grep -qE "$1" bad.txt || fail "exit $code, no '$1' in $(cat bad.txt)"
}
half() { # FILE TEXEL CHANNELS CHANNEL: where that half lies
    echo $(($(od -An -tu8 -j80 -N8 "$1") + 2 * ($2 * $3 + $4)))
}
plant() { # FILE TEXEL CHANNELS CHANNEL: 2 % more
    rm -rf bad && cp -r one bad && sed -i '/"crc32"/d; s/"format": "KTX 2.0",/"format": "KTX 2.0"/' bad/manifest.json
    local at bits
    at=$(half "bad/$1" "$2" "$3" "$4")
    bits=$(od -An -tu2 -j"$at" -N2 "bad/$1")
    bits=$((bits + (bits % 1024 + 1024 + 25) / 50))
    printf "\\x$(printf %x $((bits % 256)))\\x$(printf %x $((bits / 256)))" |
        dd of="bad/$1" bs=1 seek="$at" conv=notrunc status=none
}
plant albedo.ktx2 $((20 * 48 + 30)) 1 0
found 'FAILED +stored entries'
plant albedo.ktx2 30 1 0 # first row
found 'FAILED +stored entries'
plant albedo.ktx2 $((32 * 48 - 1)) 1 0 # last corner
found 'FAILED +stored entries'
plant r01.0_0.ktx2 $((20 * 48 + 30)) 4 0
found 'FAILED +single texels'
plant r01.0_0.ktx2 $((47 * 48 + 20)) 4 0 # last row
found 'FAILED +single texels'
plant r01.0_0.ktx2 $((47 * 48)) 4 0 # a corner
found 'FAILED +single texels'
plant f.0_0.ktx2 300 4 0
found 'FAILED +(single texels|budget max)'

# The same with its checksum: the file is named.
plant r01.0_0.ktx2 5 4 3 && cp one/manifest.json bad/manifest.json
found 'FAILED +files as made .*first: r01.0_0.ktx2'

# Another masking than it says.
rm -rf bad
recipe other '"ktx2"' separable >other.json
"$lacquer" pack other.json -o bad --cache cache >/dev/null
sed -i 's/"masking": "separable"/"masking": "correlated"/' bad/manifest.json
found 'looks like .*separable masking'

# Texels meant for centres of cells, half a cell from where the decoder reads them: mu from 0.02 to 1 is said to be
# what is stored for 0.02 + half a cell ...
rm -rf bad && cp -r one bad
cat >shifted.json <<'END_OF_RECIPE'
{"name": "shifted", "formats": ["ktx2"], "points": 1000, "tables": [
  {"table": "albedo", "tolerance": 1e-5, "axes": {"mu": "0.02:1:48", "alpha": "0.02:1:32:sqrt"}}]}
END_OF_RECIPE
"$lacquer" pack shifted.json -o shifted --cache cache >/dev/null
sed 's/0.02:1:48"/0.03020833:0.98979167:48"/' shifted.json >centres.json
rm -rf bad
"$lacquer" pack centres.json -o bad --cache cache >/dev/null
cp shifted/manifest.json bad/manifest.json
sed -i '/"crc32"/d; s/"format": "KTX 2.0",/"format": "KTX 2.0"/' bad/manifest.json
code=0
"$lacquer" validate bad --points 3000 --budget max=5e-3,p99=2e-3 >bad.txt || code=$?
[ "$code" = 2 ] && grep -qE 'looks misplaced .*nodes of mu sampled at' bad.txt || fail "half a cell: $(cat bad.txt)"

# --------------------------------------------------- files that differ, are cut short, or are not there
cp -r good bad2 && cp bad2/r01.0_0.dds bad2/keep.dds
printf '\x01' | dd of=bad2/r01.0_0.dds bs=1 seek=1000 conv=notrunc status=none
rm -rf bad && mv bad2 bad
found 'FAILED +files agree +1.00e\+00 .*first in r01.0_0.dds'
head -c 3000 good/r01.0_0.ktx2 >bad/r01.0_0.ktx2
refused() { # PATTERN
    local code=0
    "$lacquer" validate bad >out.txt 2>message.txt || code=$?
    [ "$code" = 1 ] && [ "$(wc -l <message.txt)" = 1 ] && grep -qE "$1" message.txt ||
        fail "exit $code: $(cat message.txt), expected $1"
}
refused 'bad/r01.0_0.ktx2: (cut short|its level)'
rm bad/r01.0_0.ktx2
refused 'r01.0_0.ktx2.*No such file'
sed -i 's/"texels": 48/"texels": -3/' bad/manifest.json
refused 'bad/manifest.json: albedo: an axis lacks|manifest.json'
echo '{' >bad/manifest.json
refused 'bad/manifest.json:[12]: '
