#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Usage: docker/packages/needed-by.sh PROGRAM
# Prints the Debian packages that hold the shared libraries PROGRAM loads, one a line.
set -euo pipefail

libraries=$(ldd "$1")
if grep 'not found' <<<"$libraries" >&2; then
    exit 1
fi
awk '$2 == "=>" {print $3}' <<<"$libraries" | while read -r library; do
    # The package may have filed it under /lib or /usr/lib, which are one directory.
    file=$(basename "$(realpath "$library")")
    dpkg-query --search "*/$file" | cut -d: -f1 | head -n 1
done | sort -u
