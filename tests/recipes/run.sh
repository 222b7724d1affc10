#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Usage: tests/recipes/run.sh PROGRAM
# Pastes every line of the sh blocks of api/README.md, in their order, into one shell, against a
# server of its own. A line's curl has to be answered by a status below 400, or by the one that the
# line's comment begins with ("# 412: ..."). At the end every operation of /openapi.json has to have
# been used with success by one of these lines or by the README's (docker/smoke.sh).
set -euo pipefail
program=$(realpath "$1")
project=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
scratch=$(mktemp -d)

stop_server() {
    [[ -z ${server-} ]] || { kill "$server" 2>/dev/null; wait "$server" || true; } 2>/dev/null
    server=
}
trap 'stop_server; rm -rf "$scratch"' EXIT

fail() {
    echo "recipes: $*" >&2
    exit 1
}

"$program" serve --demo --log-format json --log-level debug --port 0 --port-file "$scratch/port" >"$scratch/log" 2>&1 &
server=$!
for _ in {1..600}; do
    [[ ! -s $scratch/port ]] || break
    kill -0 "$server" 2>/dev/null || fail "the server did not start: $(cat "$scratch/log")"
    sleep 0.1
done
base=http://127.0.0.1:$(<"$scratch/port")

# The page's curl, with the head of its answer in a file.
curl() {
    command curl --silent --show-error --max-time 120 --dump-header "$scratch/head" "$@"
}

# Lines of all sh blocks: no comments of their own, those that end in a backslash joined.
recipe_lines() {
    awk '/^```sh$/ {inside = 1; next} /^```$/ {inside = 0} inside' "$1" |
        sed -e :join -e '/\\$/ {N; s/\\\n *//; b join}' -e '/^ *\(#\|$\)/d'
}

paste_all() {
    local line want status number=0
    cd "$scratch"
    ln -s "$project/tests" tests
    while IFS= read -r line; do
        number=$((number + 1))
        echo "\$ $line"
        want=$(grep -oE '# [45][0-9]{2}\b' <<<"$line" | tail -n 1 | cut -c 3- || true)
        : >"$scratch/head"
        eval "${line//http:\/\/127.0.0.1:8080/$base}" >answer </dev/null || fail "the line failed"
        [[ $line == *curl* ]] || continue
        status=$(sed -nE 's/^HTTP\/[0-9.]+ ([0-9]+).*/\1/p' "$scratch/head" | tail -n 1)
        if [[ -n $want ]]; then
            ((status == want)) || fail "answered $status instead of $want: $(head -c 2000 answer)"
        else
            ((status < 400)) || fail "answered $status: $(head -c 2000 answer)"
        fi
    done < <(recipe_lines "$project/api/README.md")
    echo "recipes: $number lines of api/README.md work"
}

# "GET /v1/sessions/{id}", a line each.
operations() {
    jq -r '.paths | to_entries[] | .key as $path | .value | keys[] | ascii_upcase + " " + $path'
}

# The same of what the server's log says it answered with success.
used() {
    jq -r 'select(.event == "request" and .status < 400) | .method + " " + .path' "$scratch/log" | sort -u
}

check_coverage() {
    local operation pattern missing=()
    while IFS= read -r operation; do
        pattern=$(sed -E 's/\./\\./g; s/\{[^}]*\}/[^\/]+/g' <<<"$operation")
        used | grep -qxE "$pattern" || missing+=("$operation")
    done < <(command curl --silent --fail "$base/openapi.json" | operations)
    ((${#missing[@]} == 0)) || fail "no line uses $(printf '%s; ' "${missing[@]}")"
    echo "recipes: every operation of /openapi.json is among them"
}

(cd "$project" && docker/smoke.sh "$base")
paste_all
check_coverage
if jq -e 'select(.level == "warning" or .level == "error")' "$scratch/log"; then fail "the server complained"; fi
