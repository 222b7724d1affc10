#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Usage: tests/digest/compare.sh [PROGRAM...]
# The same operations give the same bytes whichever compiler made the program, however it optimizes,
# wherever walks begin: builds operation_digest in several ways, runs each from several places and
# fails unless all print one line. PROGRAM: one that is built already, to be compared as well.
# The line is also the one of tests/digest/expected.txt: where the core gives other bytes than it did,
# core/types/algorithm.hpp needs another number, and that file another line.
# What it makes stays under build/digest; TINSMITH_JOBS=N sets how many compilers run at a time.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

folder=build/digest
walk_seeds=(0 1 12345)
variants=("g++ -O0" "g++ -O2" "clang++ -O0" "clang++ -O2")
# Wide registers, fused multiply-add: what -ffp-contract=off has to hold against.
if [[ $(uname -m) == x86_64 ]] && grep -qw avx2 /proc/cpuinfo && grep -qw fma /proc/cpuinfo; then
    variants+=("g++ -O3 -march=x86-64-v3")
else
    echo "not compared: g++ -O3 -march=x86-64-v3, which this processor cannot run"
fi

# A variant's program, by its name: "g++ -O2" is build/digest/g++_-O2.
program_of() { printf '%s/%s' "$folder" "${1// /_}"; }

compile() {
    local program launcher=""
    program=$(program_of "$1")
    if command -v ccache >/dev/null; then launcher=ccache; fi
    # Split into words: a compiler and its options.
    # shellcheck disable=SC2086
    $launcher $1 -std=c++20 -ffp-contract=off -I. '-DTINSMITH_SOURCE_DIR="."' \
        -c "$folder/all.cpp" -o "$program.o" && ${1%% *} "$program.o" -o "$program"
}
export folder
export -f compile program_of

mkdir -p "$folder"
# One file of all sources: each variant is one call of the compiler, and it may inline at will.
find core tests/digest -name '*.cpp' | LC_ALL=C sort | sed 's/.*/#include "&"/' >"$folder/all.cpp"
printf '%s\0' "${variants[@]}" | xargs -0 -P "${TINSMITH_JOBS:-$(nproc)}" -I{} bash -c 'compile "{}"'

programs=()
for variant in "${variants[@]}"; do programs+=("$(program_of "$variant")"); done
first=""
different=0
for program in "${programs[@]}" "$@"; do
    for walk_seed in "${walk_seeds[@]}"; do
        line=$("$program" "$walk_seed") || different=1
        printf '%s  %s %s\n' "$line" "${program##*/}" "$walk_seed"
        first=${first:-$line}
        if [[ $line != "$first" ]]; then
            different=1
            # What went before tells where they part: the first operation that is not the same.
            diff <("${programs[0]}" --each "${walk_seeds[0]}") <("$program" --each "$walk_seed") |
                head -n 4 || true
        fi
    done
done
if [[ $first != "$(cat tests/digest/expected.txt)" ]]; then
    echo "error: not the bytes of $(cat tests/digest/expected.txt)" >&2
    echo "Is that meant? Then raise kAlgorithm in core/types/algorithm.hpp, for stored sessions are made" \
        "again by their number, and put the new line into tests/digest/expected.txt." >&2
    exit 1
fi
((different == 0)) || { echo "error: not the same bytes everywhere" >&2; exit 1; }
