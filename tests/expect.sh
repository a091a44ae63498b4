# What tests of the command line share; a test sources it, goes to a folder of its own, and ends with a look at
# `failures`. out and err hold what the program printed last.
failures=0

# A folder that goes with the test, to work in: $work.
own_folder() {
    work=$(mktemp -d)
    trap 'rm -rf "$work"' EXIT
    cd "$work"
}

fail() {
    echo "FAIL: $*" >&2
    failures=$((failures + 1))
}

# run CODE ARGUMENTS...
run() {
    local code=$1 got=0
    shift
    "$LACQUER" "$@" >out 2>err || got=$?
    [ "$got" -eq "$code" ] || fail "lacquer $*: exit $got, expected $code: $(cat out err)"
}

# refused PATTERN ARGUMENTS...: exit 1, one line on stderr that matches, nothing on stdout, and no file in the folder
# `stays_empty`, where a test has set that.
refused() {
    local pattern=$1
    shift
    run 1 "$@"
    [ "$(wc -l <err)" -eq 1 ] || fail "lacquer $*: not one line: $(cat err)"
    grep -qE -e "$pattern" err || fail "lacquer $*: '$(cat err)' does not match '$pattern'"
    [ ! -s out ] || fail "lacquer $*: printed on stdout: $(cat out)"
    [ -z "${stays_empty:-}" ] || [ -z "$(ls -A "$stays_empty")" ] || fail "lacquer $*: left $(ls -A "$stays_empty")"
}

says() {
    grep -qE -e "$1" out || fail "no '$1' in: $(cat out)"
}
