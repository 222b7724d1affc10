#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Usage: tests/fuzz/run_long.sh [MINUTES [TARGET...]]
# Fuzzes each target for so long (10), on from its committed corpus and from what earlier runs came
# upon, and prints the executions and findings of each. Fails on a finding, and on a target that
# executed nothing.
# All it makes is under build/fuzz: corpus/TARGET, findings/TARGET, TARGET.log. A finding that is
# mended goes to tests/fuzz/corpus/TARGET by a name that says what it was.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

minutes=${1:-10}
(($# == 0)) || shift
targets=("$@")
((${#targets[@]})) || targets=(
    integrate terrain_json obj landxml glb geojson geotiff ascii_grid delta questions edits csv delaunay)
[[ $minutes =~ ^[0-9]+$ ]] || { sed -n 3s/..//p "$0" >&2; exit 2; }

folder=build/fuzz
most_findings=10
export UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1
if command -v ccache >/dev/null; then export CMAKE_CXX_COMPILER_LAUNCHER=ccache; fi
mkdir -p build
cmake --preset fuzz >"$folder.configure.log" 2>&1 || { cat "$folder.configure.log"; exit 1; }
cmake --build --preset fuzz --parallel "${TINSMITH_JOBS:-$(nproc)}" --target "${targets[@]/%/_fuzz}"

# Many small requests say more than one large input that takes a second.
longest_input() { if [[ $1 == integrate ]]; then echo 512; else echo 4096; fi; }

count_findings() { find "$folder/findings/$1" -type f | wc -l; }

# fuzz TARGET: on after each finding, until the time is over or there are enough of them.
fuzz() {
    local target=$1 log=$folder/$1.log end executions=0 left failures=0 before known now
    mkdir -p "$folder/corpus/$target" "$folder/findings/$target"
    : >"$log"
    before=$(count_findings "$target")
    known=$before now=$before
    end=$((SECONDS + 60 * minutes))
    while left=$((end - SECONDS)) && ((left > 0)); do
        "$folder/tests/fuzz/${target}_fuzz" -max_total_time="$left" -print_final_stats=1 \
            -timeout=60 -max_len="$(longest_input "$target")" -artifact_prefix="$folder/findings/$target/" \
            "$folder/corpus/$target" "tests/fuzz/corpus/$target" >"$log.part" 2>&1 || failures=1
        cat "$log.part" >>"$log"
        executions=$((executions +
            $(sed -n 's/^stat::number_of_executed_units: *//p' "$log.part" | tail -n 1 | grep . || echo 0)))
        # One of the corpus breaks it before there is anything new: it would do so for ever.
        now=$(count_findings "$target")
        if ((now == known || now - before >= most_findings)); then break; fi
        known=$now
    done
    rm -f "$log.part"
    printf '%-14s %12d executions %4d findings\n' "$target" "$executions" "$((now - before))"
    ((failures == 0 && executions > 0))
}

outcome=0
for target in "${targets[@]}"; do
    fuzz "$target" || outcome=1
done
find "$folder/findings" -type f
exit "$outcome"
