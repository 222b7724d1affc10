#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Usage: docker/smoke.sh [URL]      (default http://127.0.0.1:8080)
# Runs the README's curl lines, as printed but for the address, against a server that is up,
# and looks at what they bring. TINSMITH_KEY is sent as the API key when it is set.
set -euo pipefail
project=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
export base=${1:-http://127.0.0.1:8080}

# The lines name files of the project and write into the current directory: a scratch one here.
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
ln -s "$project/tests" "$scratch/tests"
cd "$scratch"

# The README's curl, made to fail on an HTTP error and to carry the key.
curl() {
    local key=()
    [[ -z ${TINSMITH_KEY-} ]] || key=(-H "Authorization: Bearer $TINSMITH_KEY")
    command curl --silent --show-error --fail-with-body --max-time 120 "${key[@]}" "$@"
}
export -f curl

fail() {
    echo "smoke: $*" >&2
    exit 1
}

curl "$base/readyz" >/dev/null || fail "$base/readyz does not say that it is ready"

mapfile -t lines < <(grep '^curl ' "$project/README.md")
((${#lines[@]} >= 3)) || fail "the README has fewer than three curl lines"
number=0
for line in "${lines[@]}"; do
    number=$((number + 1))
    echo "\$ $line"
    bash -euo pipefail -c "${line//http:\/\/127.0.0.1:8080/$base}" >"answer$number" ||
        fail "it failed, with this answer: $(head -c 2000 "answer$number")"
done

jq --exit-status '.version >= 1 and .triangles > 0' answer1 >/dev/null ||
    fail "the first line brought no session: $(head -c 500 answer1)"
jq --exit-status '.totals.crossings > 0 and ([.polygons[].max_vertical_deviation] | max) < 1e-6' answer2 >/dev/null ||
    fail "the second line brought no report of an exact integration: $(head -c 500 answer2)"
[[ $(head -c 4 hills.glb) == glTF ]] || fail "the third line brought no GLB"
jq --exit-status '.elevation > 0' answer4 >/dev/null ||
    fail "the fourth line brought no elevation: $(head -c 500 answer4)"
jq --exit-status '[.stretches[].points[].at] | index("edge") != null' answer5 >/dev/null ||
    fail "the fifth line brought no profile: $(head -c 500 answer5)"
jq --exit-status '.area > 0 and .cut + .fill > 0' answer6 >/dev/null ||
    fail "the sixth line brought no volume: $(head -c 500 answer6)"
echo "smoke: $number lines of the README work; hills.glb has $(stat --format=%s hills.glb) bytes"
