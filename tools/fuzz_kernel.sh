#!/bin/sh
# fuzz_kernel.sh [ROUNDS [SEED]]   random images through every entry point of the geodesic kernel under the address and
# undefined-behavior sanitizers: with vector instructions, without, and with the search in bands of single rows. All
# three must print the same hash. Exits with 77 where no compiler has these sanitizers.
set -eu
cd "$(dirname "$0")/../kernel"

rounds=${1:-20000}
seed=${2:-1}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
echo 'int main(void) { return 0; }' >"$folder/probe.c"
sanitize="-fsanitize=address,undefined -fno-sanitize-recover=all"

for compiler in gcc clang cc none; do
    # shellcheck disable=SC2086
    if "$compiler" $sanitize -o "$folder/probe" "$folder/probe.c" 2>/dev/null && "$folder/probe"; then
        break
    fi
done
if [ "$compiler" = none ]; then
    echo "fuzz_kernel: no compiler with address and undefined-behavior sanitizers" >&2
    exit 77
fi
# For a few rounds, compiling takes longer than running.
level=-O0
if [ "$rounds" -gt 5000 ]; then level=-O1; fi
first=
for options in "" "-DRC_SCALAR" "-DRC_BAND_PIXELS=1 -DRC_BAND_CELLS=0"; do
    # shellcheck disable=SC2086
    "$compiler" -std=c11 -g $level -Wall -Wextra -Werror -ffp-contract=off $sanitize $options -o "$folder/fuzz" fuzz/fuzz.c src/*.c -lm
    hash=$("$folder/fuzz" "$seed" "$rounds") || { echo "fuzz_kernel: seed $seed${options:+ with $options}: $hash" >&2; exit 1; }
    if [ "${first:=$hash}" != "$hash" ]; then
        echo "fuzz_kernel: seed $seed with $options: results differ from those without" >&2
        exit 1
    fi
done
echo "$rounds rounds from seed $seed by $compiler: nothing found, results $hash"
