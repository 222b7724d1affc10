#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Usage: tests/gdal/fetch_rasters.sh FOLDER
# Lays rasters that others made into FOLDER, out of Debian's packages r-cran-terra and r-cran-stars.
# Nothing is installed. Does nothing where they are there already.
set -euo pipefail
to=$1
[[ -e $to/complete ]] && exit 0
mkdir -p "$to"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
packages=(r-cran-terra r-cran-stars)
apt-get -qq download "${packages[@]}" || {
    apt-get -qq update
    apt-get -qq download "${packages[@]}"
}
for package in *.deb; do
    dpkg-deb --extract "$package" .
done
cp usr/lib/R/site-library/terra/ex/{elev,meuse}.tif \
    usr/lib/R/site-library/stars/tif/{olinda_dem_utm25s,geomatrix,na,L7_ETMs}.tif "$to/"
touch "$to/complete"
