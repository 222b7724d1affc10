#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Usage: tests/contract/check.sh PRESET
# Fails when tests/contract.md names a test that does not exist: one that ctest of that preset does
# not have, or a file that is not there. The names in tests/openapi/requests.mjs are looked at too.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

# Of one with parameters, PREFIX/Suite.Test/PARAMETER, the name alone.
known=$(ctest --preset "$1" --show-only |
    sed -nE 's/^ *Test +#[0-9]+: //p' | sed -E 's|^[A-Za-z]+/([A-Za-z]+\.[A-Za-z]+)/.*|\1|')
# The last cell of each row, and the tests that provoke what one polite client cannot.
named=$({
    grep '^| ' tests/contract.md | grep -vE '^\| Promise' | sed -E 's/^.*\|([^|]*)\|$/\1/' | grep -oE '`[^`]+`' | tr -d '`'
    sed -nE "s/^  '[a-z-]+': '([^']+)',$/\1/p" tests/openapi/requests.mjs
} | sort -u)

missing=0
while IFS= read -r name; do
    if [[ $name == */* ]]; then
        [[ -e $name ]] && continue
    elif grep -qxF "$name" <<<"$known"; then
        continue
    fi
    echo "contract: there is no test $name"
    missing=$((missing + 1))
done <<<"$named"
rows=$(grep -c '^| ' tests/contract.md)
if grep '^| ' tests/contract.md | grep -vE '^\| Promise' | grep -vE '`[^`]+` \|$'; then
    echo "contract: the rows above name no test"
    exit 1
fi
((missing == 0)) || exit 1
echo "contract: $rows rows, $(wc -l <<<"$named") tests, all there"
