#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Usage: docker/clean-root.sh [RELEASE]      (default bookworm; needs root)
# Makes a bare Debian, copies the last commit into it and nothing else, runs `./run.sh demo` and
# `./test.sh` there, and states how long each took.
#   BASE_ROOT=DIR   a minimal Debian root made earlier, copied instead of fetched with debootstrap
#   PARTS="…"       the parts of test.sh to run (default: its own default)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
release=${1:-bookworm}

if ((EUID != 0)); then
    echo "error: a new root takes root: sudo $0 $*" >&2
    exit 1
fi

# In a mount and process namespace of our own, so that nothing stays mounted or running.
if [[ -z ${TINSMITH_IN_NAMESPACE-} ]]; then
    TINSMITH_IN_NAMESPACE=1 exec unshare --mount --pid --fork --kill-child "$0" "$@"
fi

scratch=$(mktemp -d "${TMPDIR:-/var/tmp}/tinsmith-root.XXXXXX")
root=$scratch/root
# shellcheck disable=SC2317  # reached by the trap
cleanup() {
    for place in proc dev/shm dev/pts; do
        if mountpoint --quiet "$root/$place"; then umount --lazy "$root/$place"; fi
    done
    rm -rf --one-file-system "$scratch"
}
trap cleanup EXIT

if [[ -n ${BASE_ROOT-} ]]; then
    cp --archive "$BASE_ROOT" "$root"
else
    docker/packages/install.sh image
    echo "Fetching Debian $release"
    debootstrap --variant=minbase "$release" "$root" >"$scratch/debootstrap.log" ||
        { tail -n 20 "$scratch/debootstrap.log" >&2; exit 1; }
fi
mount -t proc proc "$root/proc"
mkdir -p "$root/dev/shm" "$root/dev/pts"
mount -t tmpfs shm "$root/dev/shm"
cp --dereference /etc/resolv.conf "$root/etc/resolv.conf"
# What this machine's administrator trusts, the new root trusts too, once it has ca-certificates.
if compgen -G '/usr/local/share/ca-certificates/*.crt' >/dev/null; then
    mkdir -p "$root/usr/local/share/ca-certificates"
    cp /usr/local/share/ca-certificates/*.crt "$root/usr/local/share/ca-certificates/"
fi

mkdir -p "$root/root/tinsmith"
git archive HEAD | tar --extract --directory "$root/root/tinsmith"

# in_root TITLE COMMAND: one wall time, one line. The way out to the network is the caller's.
outcome=0
times=()
in_root() {
    local title=$1 begin=$SECONDS result
    shift
    printf '\n#### %s, in a bare Debian %s\n' "$title" "$release"
    result=ok
    env -i HOME=/root LANG=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin \
        ${http_proxy+http_proxy="$http_proxy"} ${https_proxy+https_proxy="$https_proxy"} \
        ${no_proxy+no_proxy="$no_proxy"} ${TINSMITH_JOBS+TINSMITH_JOBS="$TINSMITH_JOBS"} \
        chroot "$root" bash -c "cd /root/tinsmith && $*" || result=FAILED
    [[ $result == ok ]] || outcome=1
    times+=("$(printf '%-16s %5d s  %s' "$title" $((SECONDS - begin)) "$result")")
}
in_root './run.sh demo' './run.sh demo && test -s out.glb && test -s report.json'
in_root './test.sh' "./test.sh ${PARTS-}"

printf '\nDebian %s, %d cores, packages and build included:\n' "$release" "$(nproc)"
printf '%s\n' "${times[@]}"
exit "$outcome"
