#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Usage: tests/readers/fetch_models.sh FOLDER
# Lays the models that Assimp is tested with into FOLDER, out of Debian's package assimp-testmodels:
# OBJ and glTF by many programs, one packed by Draco, and broken ones. Nothing is installed. Does
# nothing where they are there already.
set -euo pipefail
to=$1
[[ -e $to/complete ]] && exit 0
mkdir -p "$to"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
(
    cd "$work"
    apt-get -qq download assimp-testmodels || {
        apt-get -qq update
        apt-get -qq download assimp-testmodels
    }
    dpkg-deb --extract ./*.deb .
)
cp -R "$work"/usr/share/assimp/models/{OBJ,glTF2,invalid} "$to/"
touch "$to/complete"
