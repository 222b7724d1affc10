#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Usage: server/viewer/build.sh FOLDER
# Builds the page of `/` into FOLDER, with Node 18 or later and npm. Does nothing when FOLDER is
# newer than its sources.
set -euo pipefail
mkdir -p "$1"
out=$(cd "$1" && pwd)
cd "$(dirname "${BASH_SOURCE[0]}")"

sources=(package.json package-lock.json build.mjs tsconfig.json index.html src)
if [[ -f $out/index.html && -z $(find "${sources[@]}" -newer "$out/index.html" -print -quit) ]]; then
    exit 0
fi
echo "Building the page into $out"
if [[ ! -f node_modules/.package-lock.json || package-lock.json -nt node_modules/.package-lock.json ]]; then
    npm ci --no-audit --no-fund --loglevel=error
    touch node_modules/.package-lock.json
fi
npm run --silent check
node build.mjs "$out"
