#!/usr/bin/env bash
# The command line as scripts see it: exit codes, one line per mistake, no partial files, Ctrl-C.
set -euo pipefail
: "${LACQUER:?path of the program}"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
mkdir folder files
failures=0

fail() {
    echo "FAIL: $*" >&2
    failures=$((failures + 1))
}

# run CODE ARGUMENTS...: files/out, files/err hold what it printed.
run() {
    local code=$1 got=0
    shift
    "$LACQUER" "$@" >files/out 2>files/err || got=$?
    [ "$got" -eq "$code" ] || fail "lacquer $*: exit $got, expected $code: $(cat files/err)"
}

# refused PATTERN ARGUMENTS...: exit 1, one line on stderr that matches, nothing on stdout, no file made.
refused() {
    local pattern=$1
    shift
    run 1 "$@" </dev/null
    [ "$(wc -l <files/err)" -eq 1 ] || fail "lacquer $*: not one line: $(cat files/err)"
    grep -qE -e "$pattern" files/err || fail "lacquer $*: '$(cat files/err)' does not match '$pattern'"
    [ ! -s files/out ] || fail "lacquer $*: printed on stdout: $(cat files/out)"
    no_file "lacquer $*"
}

no_file() {
    [ -z "$(ls -A folder)" ] || fail "$1: left $(ls -A folder)"
    rm -rf folder
    mkdir folder
}

point=(mu=0.4 alpha=0.3 n=0.2 kappa=3.9)
small=(--axis mu=0:1:5 --axis alpha=0:1:4 --axis n=0.2:2:3 --axis kappa=1:4:3)

# ------------------------------------------------------------------------------ help, version
run 0 --version
grep -qE '^lacquer [0-9]+\.[0-9]+\.[0-9]+$' files/out || fail "--version: $(cat files/out)"
run 0 --help
verbs=$(sed -n '/^Verbs:/,/^$/s/^  \([a-z-]*\) .*/\1/p' files/out)
[ "$(wc -w <<<"$verbs")" -ge 9 ] || fail "--help shows few verbs: $verbs"
for verb in $verbs; do
    run 0 --help
    grep -q "^  $verb " files/out || fail "--help does not show $verb"
    run 0 "$verb" --help
    grep -q '^Examples:' files/out || fail "$verb --help shows no examples"
    [ ! -s files/err ] || fail "$verb --help wrote to stderr"
    mv files/out files/help
    run 0 help "$verb"
    cmp -s files/help files/out || fail "help $verb is not $verb --help"
done
run 0 list
for id in fgd albedo albedo-average dfg ggx exr npy; do
    grep -q "^  $id " files/out || fail "list does not show $id"
done

# --------------------------------------------------------------------------------- bad words
refused 'no verb; known: list, eval'
refused "unknown verb 'x'; known: list, eval, stack, precompute, pca, fit, validate, pack, info, view, bench" x
refused "unknown option '--x'" --x
for verb in $verbs; do
    refused "unknown option '--nonsense'; accepted: .*--help" "$verb" --nonsense
    refused "unknown option '-Z'; accepted: .*--help" "$verb" -Z
done

# ------------------------------------------------------- every option of every verb, from its help
options_of() { # VERB: lines "name VALUE", no VALUE for a flag
    "$LACQUER" "$1" --help | sed -nE 's/^  (-., |    )--([a-z0-9-]+) ?([^ ]*) .*/\2 \3/p' | grep -v '^help '
}
count=0
for verb in $verbs; do
    while read -r name value; do
        count=$((count + 1))
        case $value in
        '') refused "option --$name takes no value" "$verb" "--$name=x" ;;
        [A-EG-Z])
            for bad in '' -1 nan 0x1p3; do
                refused "^lacquer $verb: --$name: '$bad' is not a .*number from" "$verb" "--$name" "$bad"
            done
            refused "^lacquer $verb: --$name: '1x' is not a .*number from" "$verb" "--$name=1x"
            ;;
        *'|'*) refused "$name|no/such" "$verb" "--$name" no/such ;;
        esac
        [ -z "$value" ] || refused "option --$name needs a value" "$verb" "--$name"
    done < <(options_of "$verb")
done
[ "$count" -ge 60 ] || fail "help shows few options: $count"

# A value that an option takes.
good() { # NAME VALUE
    case $1 in
    budget | tolerance | loss) echo 1e-3 ;;
    bytes | samples) echo 1024 ;;
    points) echo 16 ;;
    range) echo 0.1:0.5 ;;
    on) echo mu=0.1:0.5 ;;
    ndf) echo ggx ;;
    mu) echo 0.5 ;;
    *)
        case $2 in
        ?) echo 2 ;;
        *'|'*) echo "${2%%|*}" ;;
        *) echo x ;;
        esac
        ;;
    esac
}

# idle VERB OPTION... -- ARGUMENTS: in the mode of ARGUMENTS exactly these options are refused. Those not on
# the list may do their work; ARGUMENTS are such that it cannot start, or (a last "only") they are not tried.
idle() {
    local verb=$1 list=' '
    shift
    while [ "$1" != -- ]; do
        list+="$1 "
        shift
    done
    shift
    while read -r name value; do
        local option=("--$name")
        [ -z "$value" ] || option+=("$(good "$name" "$value")")
        if [[ $list == *" $name "* ]]; then
            refused "--$name has no effect .*; accepted there: " "$verb" "$@" "${option[@]}"
            ! sed 's/.*accepted there//' files/err | grep -q -e "--$name," || fail "$verb: --$name is accepted"
        elif [ -n "${tries:-}" ]; then
            "$LACQUER" "$verb" "$@" "${option[@]}" >files/out 2>files/err </dev/null || true
            ! grep -q 'has no effect' files/err || fail "$verb $* ${option[*]}: $(cat files/err)"
        fi
    done < <(options_of "$verb")
}
: >files/empty
tries=yes
idle eval ndf scattering masking tolerance threads orders -- --from files/empty
idle info kind ndf -- files/empty
idle pca separate scheme value bases critical texels ndf -- files/empty --budget 1e-3 -o /proc/x
idle pca random seed ndf allow-plugin -- files/empty --nodes-only -o /proc/x
idle fit texture samples -- hg -o /proc/x
idle fit samples -- variance -o /proc/x
idle fit report texture snippet -- bounces -o /proc/x
idle fit report texture snippet family range points norm loss -- anisotropic -o /proc/x
idle fit report texture snippet family range points norm loss samples -- transmitted -o /proc/x
tries=
certificate='certificate on table parts junit report'
light='mu interfaces from'
layered='set model tables'
idle bench csv svg full scattering masking stack allow-plugin -- --report /proc/x
idle bench svg points report ndf scattering masking -- stack --csv /proc/x
idle stack interfaces from paths tolerance -- files/empty --model b18-forward
idle stack variant mapping -- files/empty
idle validate against layout kind axes diagnose samples points seed budget $certificate \
    scattering masking tolerance $light slices $layered -- hard-cases
idle validate against layout kind axes diagnose points budget $certificate ndf scattering masking $layered -- \
    stack files/empty
idle validate against layout kind axes diagnose points budget certificate on table parts junit ndf scattering masking \
    tolerance format json allow-plugin $light slices -- layered
idle validate against layout kind diagnose samples $certificate ndf scattering masking tolerance $light slices $layered -- \
    files/empty --axes files/empty
idle validate layout kind samples $certificate ndf scattering masking tolerance $light slices $layered -- \
    files/empty --diagnose
idle validate samples $certificate $light slices $layered -- files/empty --layout tm --kind fgd
idle validate ndf scattering masking tolerance kind $light slices $layered -- files/empty
slices='x y at channel range'
echo '{}' >files/empty.json
idle view layout kind tolerance allow-plugin threads -- files/empty --axes files/empty -o folder/x.png
idle view tolerance allow-plugin threads -- files/empty --layout tm --kind fgd -o folder/x.png
idle view $slices kind tolerance allow-plugin threads -- files -o folder/x.png
idle view $slices kind -- files/empty.json -o folder/x.png
refused 'no arguments' list fgd

# -------------------------------------------------------------------------------------- eval
refused 'no table' eval
refused "'nothing'.*fgd.*albedo" eval nothing mu=1
refused 'missing .*: n, kappa$' eval fgd mu=1 alpha=1
refused "unknown axis 'eta'; fgd has: mu, alpha, n, kappa" eval fgd eta=1
refused 'mu = 1.5 is out of range; accepted: 0 to 1' eval fgd mu=1.5
refused 'alpha = -0.1 is out of range' eval fgd alpha=-0.1
refused "mu: 'nan' is not a number" eval fgd mu=nan
refused "mu: 'inf' is not a number" eval fgd mu=inf
refused "mu: '0.3x' is not a number" eval fgd mu=0.3x
refused "mu: '' is not a number" eval fgd mu=
refused "mu: '1e999' is not a number" eval fgd mu=1e999
refused 'mu is given twice' eval fgd mu=0.3 mu=0.3
refused "unexpected 'mu'" eval fgd mu
refused 'needs a value' eval fgd "${point[@]}" --tolerance
refused "'0' is not a number from" eval fgd "${point[@]}" --tolerance 0
refused "'tiny' is not a number" eval fgd "${point[@]}" --tolerance tiny
refused 'accepts 1e-08 to 0.1, not 0.5' eval fgd "${point[@]}" --tolerance 0.5
refused "unknown verb 'evil'; known: list" help evil
refused 'tolerance.*1e-14' eval fgd "${point[@]}" --tolerance 1e-14
refused "unknown NDF 'phong'; known: ggx, beckmann" eval fgd "${point[@]}" --ndf phong
refused 'single, multiple' eval fgd "${point[@]}" --scattering double
refused 'correlated, separable' eval fgd "${point[@]}" --masking none
refused 'text, csv, json' eval fgd "${point[@]}" --format xml
refused 'takes no --scattering' eval albedo mu=1 alpha=1 --scattering multiple
refused 'only table fgd' eval albedo mu=1 alpha=1 --orders 3
refused 'from 1 to' eval fgd "${point[@]}" --orders 0
refused 'scattering single' eval fgd "${point[@]}" --orders 3 --scattering single
refused 'from 1 to' eval fgd "${point[@]}" --threads -1
refused 'empty' eval fgd --format csv
refused 'missing.exr' eval --from folder/missing.exr mu=1

run 0 eval fgd "${point[@]}"
grep -qE '^0\.936[0-9]+ ± [0-9.e-]+$' files/out || fail "eval fgd: $(cat files/out)"
run 0 eval dfg mu=0.5 alpha=0.5
[ "$(grep -cE '^[a-zA-Z0-9]+ 0\.[0-9]+ ± ' files/out)" -eq 2 ] || fail "eval dfg: $(cat files/out)"
run 0 eval fgd "${point[@]}" --format json
grep -qE '^\{.*"value": 0\.936.*"error": .*"converged": true' files/out || fail "json: $(cat files/out)"
run 0 eval fgd "${point[@]}" --format csv
[ "$(head -n 1 files/out)" = mu,alpha,n,kappa,value,error ] || fail "csv: $(cat files/out)"
run 0 eval fgd mu=1 alpha=1 n=0.2 kappa=3.9 --orders 3
[ "$(grep -c '^order [123]: ' files/out)" -eq 3 ] || fail "orders: $(cat files/out)"

# What takes long near eta = 1 says so before the work, once, and nothing else does.
run 0 eval fgd-dielectric mu=0.5 alpha=0.1 eta=0.9995
grep -q '^lacquer eval: note: eta = 0.9995 is nearly 1: 1 pair ' files/err || fail "eta near 1: $(cat files/err)"
run 0 precompute fgd-dielectric --axis mu=0.5 --axis alpha=0,0.05,0.1 --axis eta=1,1.0005,1.5 -o files/near.exr
grep -q 'eta = 1.0005 is nearly 1: 2 pairs' files/err || fail "a table near 1: $(cat files/err)"
run 0 eval fgd-dielectric mu=0.5 alpha=0.1 eta=1.01
[ ! -s files/err ] || fail "eta = 1.01: $(cat files/err)"

# --------------------------------------------------------------------------------------- CSV
csv() { # CODE INPUT PATTERN: the message, or the first row of the output
    local got=0
    printf '%b' "$2" | "$LACQUER" eval albedo --format csv >files/out 2>files/err || got=$?
    [ "$got" -eq "$1" ] || fail "csv '$2': exit $got, expected $1: $(cat files/err)"
    if [ "$1" -eq 0 ]; then
        [ ! -s files/err ] || fail "csv '$2': $(cat files/err)"
        sed -n 2p files/out | grep -qE -e "$3" || fail "csv '$2': $(cat files/out)"
    else
        [ "$(wc -l <files/err)" -eq 1 ] || fail "csv '$2': not one line: $(cat files/err)"
        grep -qE -e "$3" files/err || fail "csv '$2': $(cat files/err)"
    fi
}
csv 0 'mu,alpha\n1,1\n' '^1,1,0\.30685[0-9]*,[0-9.e-]+$'
csv 0 'alpha,mu\r\n1, 1\r\n\r\n' '^1, 1,0\.30685'
csv 0 'mu,alpha\n1,1' '^1,1,0\.30685'
csv 0 '"mu","alpha"\n1,1\n' '^1,1,0\.30685'
csv 1 'mu,alpha,eta\n1,1,1\n' "line 1: unknown axis 'eta'; albedo has: mu, alpha"
csv 1 'mu\n1\n' 'line 1: missing .* alpha'
csv 1 'mu,mu\n1\n' 'line 1: .*twice'
csv 1 'mu,alpha\n1,1\n1\n' 'line 3: 1 fields, expected 2'
csv 1 'mu,alpha\n1,1,1\n' 'line 2: 3 fields, expected 2'
csv 1 'mu,alpha\n1,x\n' "line 2: alpha: 'x' is not a number"
csv 1 'mu,alpha\n2,1\n' 'line 2: mu = 2 is out of range; accepted: 0 to 1'
csv 1 'mu,alpha\n1,1\0\n' 'line 2: .*NUL'
csv 1 '' 'empty'

{
    echo mu,alpha
    for i in $(seq 0 999); do echo "0.$i,0.5"; done
} >files/points.csv
for threads in 1 2; do
    "$LACQUER" eval albedo --format csv --threads "$threads" <files/points.csv >"files/values$threads.csv"
done
cmp files/values1.csv files/values2.csv || fail "CSV depends on threads"
[ "$(wc -l <files/values1.csv)" -eq 1001 ] || fail "CSV rows are lost"
cut -d, -f1,2 files/values1.csv | cmp - files/points.csv || fail "CSV rows are out of order"

# -------------------------------------------------------------------------------- precompute
refused 'no table' precompute
refused 'no output file' precompute fgd
refused "'nothing'.*fgd" precompute nothing -o folder/t.exr
refused 'one TABLE' precompute fgd albedo -o folder/t.exr
refused 'end it in .exr or .npy' precompute fgd -o folder/t.tiff
refused 'exr, npy' precompute fgd --format tiff -o folder/t.exr
refused "unknown axis 'eta'; fgd has: mu" precompute fgd --axis eta=0:1:4 -o folder/t.exr
refused 'mu .*out of range; accepted: 0 to 1' precompute fgd --axis mu=0:2:4 -o folder/t.exr
refused 'mu is given twice' precompute fgd --axis mu=0:1:4 --axis mu=0:1:5 -o folder/t.exr
refused 'has no nodes' precompute fgd --axis mu -o folder/t.exr
refused 'mu.* 0 nodes' precompute fgd --axis mu=0:1:0 -o folder/t.exr
refused 'mu' precompute fgd --axis mu=0:1:-4 -o folder/t.exr
refused 'mu' precompute fgd --axis mu=0:1:4:cubic -o folder/t.exr
refused 'mu' precompute fgd --axis mu=0:nan:4 -o folder/t.exr
refused 'mu' precompute fgd --axis mu=1:0:4 -o folder/t.exr
refused 'nodes' precompute fgd --axis mu=0:1:99999999999 -o folder/t.exr
refused 'entries' precompute fgd --axis mu=0:1:1000000 --axis alpha=0:1:1000000 -o folder/t.exr
refused 'No such file or directory' precompute fgd -o folder/none/t.exr
refused 'cannot write /proc/t.exr' precompute fgd -o /proc/t.exr
refused 'No space left' precompute fgd "${small[@]}" --format npy -o /dev/full
refused 'is a folder' precompute fgd --format exr -o folder
[ -c /dev/full ] || fail "/dev/full was replaced"

run 0 precompute fgd "${small[@]}" --threads 1 -o files/one.exr
[ ! -s files/err ] || fail "precompute wrote to stderr: $(cat files/err)"
grep -qE '^files/one.exr: 180 entries, error at most ' files/out || fail "summary: $(cat files/out)"
run 0 precompute fgd "${small[@]}" --threads 2 -o files/two.exr
cmp files/one.exr files/two.exr || fail "the file depends on the number of threads"
run 0 precompute fgd "${small[@]}" --threads=2 --format=exr -ofiles/two.exr
cmp files/one.exr files/two.exr || fail "the file depends on how --threads is written"
for threads in '--threads 1' --threads=2 '--csv=files/t.csv --svg=files/t.svg'; do
    run 0 pca files/one.exr --separate n+kappa:2 --nodes-only --sweeps 2 $threads -o "files/pca${threads: -1}.exr"
done
cmp files/pca1.exr files/pca2.exr || fail "the factors depend on how --threads is written"
cmp files/pca1.exr files/pcag.exr || fail "the factors depend on --csv=FILE"
run 0 precompute fgd "${small[@]}" -o files/t.npy
head -c 6 files/t.npy | grep -q NUMPY || fail "t.npy is no .npy file"

# A file size limit stands for a full disk: the older file stays, nothing else does.
full_disk() { # FILE
    local got=0
    echo older >folder/"$1"
    (ulimit -f 8 && "$LACQUER" precompute albedo --axis mu=0:1:80 --axis alpha=0:1:80 -o folder/"$1") \
        >files/out 2>files/err || got=$?
    [ "$got" -eq 1 ] || fail "full disk, $1: exit $got: $(cat files/err)"
    [ "$(wc -l <files/err)" -eq 1 ] || fail "full disk, $1: not one line: $(cat files/err)"
    grep -q "$1" files/err || fail "full disk: '$(cat files/err)' does not name $1"
    [ "$(cat folder/"$1")" = older ] || fail "full disk: the older $1 is damaged"
    rm folder/"$1"
    no_file "full disk, $1"
}
full_disk t.exr
full_disk t.npy
got=0
"$LACQUER" list >/dev/full 2>files/err || got=$?
[ "$got" -eq 1 ] || fail "list >/dev/full: exit $got"
grep -q 'No space left' files/err || fail "list >/dev/full: $(cat files/err)"
got=0
"$LACQUER" eval albedo --format csv <files/points.csv >/dev/full 2>files/err || got=$?
[ "$got" -eq 1 ] || fail "CSV to /dev/full: exit $got"
[ "$(wc -l <files/err)" -eq 1 ] || fail "CSV to /dev/full: not one line: $(cat files/err)"
grep -q 'No space left' files/err || fail "CSV to /dev/full: $(cat files/err)"

# ------------------------------------------------------------------------------- stored files
run 0 info files/one.exr
for text in mu alpha kappa 'min .*max .*mean' 'command *lacquer precompute fgd' ggx; do
    grep -q "$text" files/out || fail "info does not show $text: $(cat files/out)"
done
run 0 info --format json files/one.exr
grep -q '"entries": 180' files/out || fail "info json: $(cat files/out)"
run 0 eval --from files/one.exr mu=0.5 alpha=0 n=0.2 kappa=1
grep -qE '^0\.[0-9]+$' files/out || fail "eval --from: $(cat files/out)"
refused 'kappa = 5 is out of range; accepted: 1 to 4' eval --from files/one.exr mu=0.5 alpha=0 n=0.2 kappa=5
refused '--ndf has no effect with --from' eval --from files/one.exr --ndf ggx mu=0.5

head -c "$(($(stat -c %s files/one.exr) / 2))" files/one.exr >files/cut.exr
head -c 100 files/one.exr >files/stump.exr
: >files/empty.exr
echo 'this is a text' >files/text.exr
LC_ALL=C sed 's/lacquer/foreign/g' files/one.exr >files/foreign.exr # an EXR file of some other program
for file in cut stump empty text foreign none; do
    refused "$file.exr" info "files/$file.exr"
    refused "$file.exr" eval --from "files/$file.exr" mu=0.5
    refused "$file.exr" validate "files/$file.exr" --against walk --samples 10
done
refused 'files' info files

# ------------------------------------------------------------------------------------ signals
interrupt() { # SIGNAL
    local got=0
    "$LACQUER" precompute fgd --tolerance 1e-7 -o folder/t.exr >files/out 2>files/err &
    local job=$!
    sleep 0.7
    kill "-$1" "$job"
    wait "$job" || got=$?
    [ "$got" -eq 130 ] || fail "SIG$1: exit $got: $(cat files/err)"
    [ "$(wc -l <files/err)" -eq 1 ] || fail "SIG$1: not one line: $(cat files/err)"
    no_file "SIG$1"
}
interrupt INT
interrupt TERM

[ "$failures" -eq 0 ] || {
    echo "$failures failures" >&2
    exit 1
}
