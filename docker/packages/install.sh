#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Usage: docker/packages/install.sh LIST...
# Installs those packages of docker/packages/LIST.txt that are missing, and says so.
# When nothing is missing it does nothing and is silent. Needs root or sudo only to install.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

# The packages of one list, without comments: "package [command that will do instead]".
entries() {
    sed -e 's/#.*//' -e '/^[[:space:]]*$/d' "$here/$1.txt"
}

is_there() {
    local package=$1 command=$2
    if [[ -n $command ]] && command -v "$command" >/dev/null; then
        return 0
    fi
    [[ $(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null) == installed ]]
}

if ! command -v dpkg-query >/dev/null; then
    echo "error: this is not Debian. Install the equivalents of these, then build with cmake --preset release:" >&2
    for list in "$@"; do entries "$list" | sed 's/^/  /' >&2; done
    exit 1
fi

missing=()
for list in "$@"; do
    while read -r package command; do
        is_there "$package" "$command" || missing+=("$package")
    done < <(entries "$list")
done
((${#missing[@]})) || exit 0

as_root=()
if ((EUID != 0)); then
    if ! command -v sudo >/dev/null; then
        echo "error: packages are missing, and installing them takes root. As root, run:" >&2
        echo "  apt-get update && apt-get install --no-install-recommends ${missing[*]}" >&2
        exit 1
    fi
    as_root=(sudo)
fi

echo "Installing ${#missing[@]} missing Debian packages: ${missing[*]}"
quiet=(-qq -o Dpkg::Use-Pty=0)
log=$(mktemp)
trap 'rm -f "$log"' EXIT
apt() {
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get "${quiet[@]}" "$@" >"$log" 2>&1 && return
    cat "$log" >&2
    echo "error: apt-get $1 failed; the packages wanted were: ${missing[*]}" >&2
    exit 1
}
apt update
apt install --yes --no-install-recommends "${missing[@]}"
