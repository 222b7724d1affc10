#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Usage: docker/build-without-engine.sh [RELEASE]      (default trixie; needs root)
# Builds the container image where no engine runs, starts its server, and runs docker/smoke.sh
# against it. Leaves build/image/tinsmith.tar, which `docker load` and `podman load` read.
#   BASE_ROOT=DIR   a minimal Debian root made earlier, copied instead of fetched with debootstrap
#   NODE_EXTRA_CA_CERTS=FILE   certificates that npm trusts while it builds the page, beside its own
#   PORT=N          where the image's server listens meanwhile (default 18080)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
release=${1:-trixie}
port=${PORT:-18080}

if ((EUID != 0)); then
    echo "error: entering an image takes root: sudo $0 $*" >&2
    exit 1
fi
docker/packages/install.sh image

scratch=$(mktemp -d "${TMPDIR:-/var/tmp}/tinsmith-image.XXXXXX")
container=
server=
# A store of its own: nothing of the caller's images is touched. vfs and chroot ask nothing of
# the kernel; they cost disk, since each layer is a whole copy.
image=(buildah --root "$scratch/store" --runroot "$scratch/run" --storage-driver vfs)
# shellcheck disable=SC2317  # reached by the trap
cleanup() {
    [[ -z $server ]] || kill "$server" 2>/dev/null || true
    [[ -z $server ]] || wait "$server" 2>/dev/null || true
    [[ -z $container ]] || "${image[@]}" rm "$container" >/dev/null || true
    rm -rf "$scratch"
}
trap cleanup EXIT

base=docker.io/library/debian:$release-slim
if [[ -n ${BASE_ROOT-} ]]; then
    root=$BASE_ROOT
else
    root=$scratch/root
    echo "Fetching Debian $release"
    debootstrap --variant=minbase "$release" "$root" >"$scratch/debootstrap.log" ||
        { tail -n 20 "$scratch/debootstrap.log" >&2; exit 1; }
    # As Debian's own slim images: documentation and translations neither there nor installed later.
    unneeded=(/usr/share/{doc,info,locale,man})
    printf 'path-exclude %s/*\n' "${unneeded[@]}" >"$root/etc/dpkg/dpkg.cfg.d/slim"
    echo 'path-include /usr/share/doc/*/copyright' >>"$root/etc/dpkg/dpkg.cfg.d/slim"
    find "${unneeded[@]/#/$root}" -type f,l ! -name copyright -delete
    rm -rf "$root"/var/lib/apt/lists/* "$root"/var/cache/apt/*
fi
container=$("${image[@]}" from scratch)
"${image[@]}" add --quiet "$container" "$root/" / >/dev/null
"${image[@]}" commit --quiet --rm "$container" "$base" >/dev/null
container=
[[ -n ${BASE_ROOT-} ]] || rm -rf "$root"

echo "Building the image on $base"
secrets=()
[[ -z ${NODE_EXTRA_CA_CERTS-} ]] || secrets=(--secret "id=ca,src=$NODE_EXTRA_CA_CERTS")
"${image[@]}" bud --isolation chroot --format docker --pull-never --build-arg "BASE=$base" "${secrets[@]}" \
    --file docker/Dockerfile --tag tinsmith:latest .

mkdir -p build/image
rm -f build/image/tinsmith.tar
"${image[@]}" push --quiet tinsmith:latest "docker-archive:build/image/tinsmith.tar:tinsmith:latest"
echo "build/image/tinsmith.tar: $(du --human-readable build/image/tinsmith.tar | cut -f 1)," \
    "compressed as registries keep it $(gzip --stdout build/image/tinsmith.tar | wc --bytes | numfmt --to=iec)"

container=$("${image[@]}" from --pull-never tinsmith:latest)
# `buildah run` knows neither ENTRYPOINT nor CMD; these are what an engine would start.
mapfile -t command < <("${image[@]}" inspect --type image tinsmith:latest |
    jq --raw-output '.Docker.config | (.Entrypoint // []) + (.Cmd // []) | .[]')
echo "Starting in the image: ${command[*]}"
"${image[@]}" run --isolation chroot --env "TINSMITH_PORT=$port" "$container" -- "${command[@]}" >"$scratch/log" 2>&1 &
server=$!
for _ in {1..3000}; do
    if curl --silent --fail "http://127.0.0.1:$port/readyz" >/dev/null; then
        # Since the server's own start: what enters the image is not an engine, and slower.
        read -r up _ </proc/uptime
        begun=$(cut -d ' ' -f 22 "/proc/$(pgrep --newest --exact tinsmith)/stat")
        awk -v up="$up" -v begun="$begun" -v hertz="$(getconf CLK_TCK)" \
            'BEGIN { printf "Ready %.0f ms after its start (to 10 ms)\n", 1000 * (up - begun / hertz) }'
        break
    fi
    kill -0 "$server" 2>/dev/null || break
    sleep 0.01
done

# With keys in force the first start prints one, as TINSMITH_KEY=… on a line of its own.
TINSMITH_KEY=${TINSMITH_KEY-$(sed -n 's/^TINSMITH_KEY=//p' "$scratch/log" | head -n 1)}
export TINSMITH_KEY
outcome=0
docker/smoke.sh "http://127.0.0.1:$port" || outcome=1
# The page of / is in it, with all that it names.
mapfile -t files < <(curl --silent --fail "http://127.0.0.1:$port/" | grep -oE '(src|href)="viewer/[^"]+"' | cut -d '"' -f 2)
((${#files[@]} >= 2)) || { echo "the page of / was not built into the image" >&2; outcome=1; }
for file in "${files[@]}"; do
    curl --silent --fail --output /dev/null "http://127.0.0.1:$port/$file" || { echo "the page's $file is not served" >&2; outcome=1; }
done
"${image[@]}" run --isolation chroot --env "TINSMITH_PORT=$port" "$container" -- tinsmith-healthcheck ||
    { echo "the image's health check fails" >&2; outcome=1; }
((outcome == 0)) || cat "$scratch/log" >&2
exit "$outcome"
