#!/usr/bin/env bash
# Installs into an empty prefix and builds small programs against it, outside the tree: through pkg-config (the
# example of the README too) and through find_package; one makes a pack, certifies it and reads it. First the library as it was built, then a shared one.
set -euo pipefail
: "${LACQUER_BUILD:?build folder}" "${LACQUER_SOURCE:?source folder}"
cmake=${CMAKE_COMMAND:-cmake}
cc=${CC:-cc}

if grep -q 'CMAKE_C_FLAGS:.*-fsanitize' "$LACQUER_BUILD/CMakeCache.txt"; then
    echo "skipped: a program of a user's is not built with sanitizers"
    exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

cat >user.c <<'END'
#include <lacquer.h>
#include <math.h>
#include <stdio.h>

int main(void) {
    lq_settings settings = lq_settings_default();
    const lq_kind *kind = lq_kind_find("fgd", NULL);
    lq_error error;
    double point[] = {0.4, 0.3, 0.2, 3.9}, value, estimate;
    if (lq_eval(kind, &settings, point, &value, &estimate, &error) != LQ_OK) return puts(error.text), 1;
    return fabs(value - 0.93688) < 1e-4 ? 0 : 2; /* random walks of 2e7 samples */
}
END
cat >recipe.json <<'END'
{"name": "small", "formats": ["dds"], "points": 200, "budget": {"max": 5e-3},
 "tables": [{"table": "albedo", "axes": {"mu": "0.02:1:32:sqrt", "alpha": "0.02:1:32:sqrt"}, "tolerance": 1e-4}]}
END
awk '/^```c$/ { inside = 1; next } /^```$/ { inside = 0 } inside' "$LACQUER_SOURCE/README.md" >readme.c
cat >CMakeLists.txt <<'END'
cmake_minimum_required(VERSION 3.25)
project(user LANGUAGES C)
find_package(lacquer 0.1 CONFIG REQUIRED)
add_executable(user user.c)
target_link_libraries(user PRIVATE lacquer::lacquer m)
END

try() { # PREFIX
    local libdir
    libdir=$(dirname "$(find "$1" -name lacquer.pc)")
    "$1/bin/lacquer" --version >/dev/null
    # shellcheck disable=SC2046 # flags are several words
    "$cc" user.c -o user-pc $(PKG_CONFIG_PATH=$libdir pkg-config --cflags --libs lacquer) -lm
    LD_LIBRARY_PATH=${libdir%/pkgconfig} ./user-pc
    # shellcheck disable=SC2046
    "$cc" readme.c -o readme $(PKG_CONFIG_PATH=$libdir pkg-config --cflags --libs lacquer)
    LD_LIBRARY_PATH=${libdir%/pkgconfig} ./readme | grep -q '^0\.93[0-9]* ± '
    # shellcheck disable=SC2046
    "$cc" "$LACQUER_SOURCE/tests/consumers/pack_user.c" -o pack-user \
        $(PKG_CONFIG_PATH=$libdir pkg-config --cflags --libs lacquer) -lm
    rm -rf made
    LD_LIBRARY_PATH=${libdir%/pkgconfig} ./pack-user recipe.json made
    "$cmake" -S . -B "$1-user" -G Ninja -DCMAKE_PREFIX_PATH="$1" -DCMAKE_C_COMPILER="$cc" >log 2>&1 || {
        cat log
        return 1
    }
    "$cmake" --build "$1-user" >log 2>&1 || {
        cat log
        return 1
    }
    "$1-user/user"
}

"$cmake" --install "$LACQUER_BUILD" --prefix "$work/first" >/dev/null
mv first moved # an installed tree that is moved still works
try "$work/moved"

"$cmake" -S "$LACQUER_SOURCE" -B shared-build -G Ninja -DBUILD_SHARED_LIBS=ON -DLACQUER_TESTS=OFF \
    -DCMAKE_BUILD_TYPE=Debug -DCMAKE_C_COMPILER="$cc" >/dev/null
"$cmake" --build shared-build >log || {
    cat log
    exit 1
}
"$cmake" --install shared-build --prefix "$work/shared" >/dev/null
try "$work/shared"

# What the shared library shows is what its header declares, and nothing else; GCC shares the locks of OpenMP's named
# sections between libraries.
"$cc" -E -P -I "$LACQUER_SOURCE" -x c - <<<'#include "lacquer.h"' | tr '\n' ' ' | sed 's/[;{}]/\n/g' |
    grep -oE '\b(lq|lacquer)_[a-z0-9_]+ *\([^*]' | sed 's/ *(.*//' | grep -v '^lacquer_ndf_plugin$' | sort -u >declared
nm -D --defined-only "$(find shared -name 'liblacquer.so' | head -1)" | awk '$2 ~ /[TDBRVW]/ && $3 !~ /^\.gomp_critical/ { print $3 }' | sort -u >shown
diff declared shown || {
    echo "FAILED: the shared library shows (>) what lacquer.h does not declare, or lacks (<) what it does" >&2
    exit 1
}
[ "$(wc -l <shown)" -gt 80 ]
