#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

usage() {
    cat <<'TEXT'
Usage: ./run.sh [OPTION...]   build, then serve the demo terrain on 127.0.0.1:8080
       ./run.sh demo          build, then do the main job once: out.glb and report.json

On Debian 12 and 13. Missing packages are installed first. The options are those of
`tinsmith serve`, for example --port 9000 or --data DIR.
TEXT
}

build() {
    docker/packages/install.sh build
    if command -v ccache >/dev/null; then
        export CMAKE_CXX_COMPILER_LAUNCHER=ccache
    fi
    # A tree that is configured already may hold the tests too: it stays as it is.
    if [[ ! -f build/release/build.ninja ]]; then
        cmake --preset release -DTINSMITH_TESTS=OFF
    fi
    cmake --build --preset release --target tinsmith
}

# The page of /. The service is whole without it.
build_page() {
    docker/packages/install.sh viewer && server/viewer/build.sh build/viewer ||
        echo "warning: the page could not be built; the service runs without it" >&2
}

demo() {
    build/release/tinsmith integrate tests/data/jacksboro.tif tests/data/lake.geojson \
        -o out.glb --report report.json
    echo "Wrote $PWD/out.glb and $PWD/report.json"
}

# Prints the welcome as soon as the server has a port, unless the server is gone before.
greet() {
    local server=$1 port_file=$2
    until [[ -s $port_file ]]; do
        kill -0 "$server" 2>/dev/null || return 0
        sleep 0.1
    done
    local port
    port=$(<"$port_file")
    rm -f "$port_file"
    printf '\nThe page: http://127.0.0.1:%s/   (Ctrl-C stops the server)\n' "$port"
    printf 'From GeoTIFF to GLB, in another terminal:\n'
    printf '  cd %q\n' "$PWD"
    grep '^curl ' README.md | head -n 3 | sed "s/:8080/:$port/; s/^/  /"
    printf '\n'
}

serve() {
    local port_file
    port_file=$(mktemp)
    greet $$ "$port_file" &
    exec build/release/tinsmith serve --demo --port-file "$port_file" "$@"
}

case ${1-} in
    -h | --help | help)
        usage
        ;;
    demo)
        build
        demo
        ;;
    *)
        build
        build_page
        serve "$@"
        ;;
esac
