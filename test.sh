#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")" || exit 1

usage() {
    cat <<'TEXT'
Usage: ./test.sh [PART...]    installs what is missing, builds, tests; the fast parts first

  fast        formatting, then every test program on the release build, then the same
              operations by other compilers and options: the same bytes
  readme      the curl lines of the README and of the interface page, as printed
  node        what other people's readers say of our files (tests/*/package.json)
  sanitizers  every test again under ASan and UBSan, server and end-to-end tests under TSan
  tidy        clang-tidy over core, api and server (minutes; not among the default)
  image       the container image, built and asked with no engine (root; not among the default)

Without a PART: fast, readme, node, sanitizers. The last line is "N passed, N failed".
TINSMITH_JOBS=N sets how many compilers and tests run at a time.
TEXT
}

jobs=${TINSMITH_JOBS:-$(nproc)}
export CMAKE_BUILD_PARALLEL_LEVEL=$jobs
if command -v ccache >/dev/null; then
    export CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi

passed=0
failed=0
failures=()

heading() { printf '\n== %s\n' "$*"; }

# tally NAME PASSED FAILED
tally() {
    passed=$((passed + $2))
    failed=$((failed + $3))
    (($3 == 0)) || failures+=("$1: $3 failed")
}

# check NAME COMMAND...: one test that passes when the command does.
check() {
    local name=$1
    shift
    if "$@"; then tally "$name" 1 0; else tally "$name" 0 1; fi
}

# build PRESET [TARGET...]: a build that fails is one failed test and ends its part.
build() {
    local preset=$1
    shift
    heading "build $preset"
    if cmake --preset "$preset" -DTINSMITH_TESTS=ON >"build/$preset.configure.log" 2>&1 &&
        cmake --build --preset "$preset" ${1+--target "$@"}; then
        return 0
    fi
    grep -A 20 'CMake Error' "build/$preset.configure.log"
    tally "build $preset" 0 1
    return 1
}

# The number that the attribute $2 has in the head of the JUnit file $1.
junit_count() {
    grep -m 1 -oE "\b$2=\"[0-9]+\"" "$1" | grep -oE '[0-9]+' || echo 0
}

# run_ctest PRESET [CTEST OPTION...]
run_ctest() {
    local preset=$1 results=$PWD/build/$1/results.xml
    shift
    heading "test $preset"
    rm -f "$results"
    "${launcher[@]}" ctest --preset "$preset" --parallel "$jobs" --no-tests=error \
        --output-junit "$results" "$@" | grep -vE '^ *Start +[0-9]+:| Passed +[0-9.]+ sec$'
    local outcome=${PIPESTATUS[0]}
    if [[ ! -s $results ]]; then
        tally "test $preset" 0 1
        return
    fi
    local total bad idle
    total=$(junit_count "$results" tests)
    bad=$(junit_count "$results" failures)
    idle=$(($(junit_count "$results" disabled) + $(junit_count "$results" skipped)))
    # What ctest calls a failure without naming a test still counts as one.
    if ((outcome != 0 && bad == 0)); then
        tally "test $preset" "$((total - idle))" 1
    else
        tally "test $preset" "$((total - idle - bad))" "$bad"
    fi
}
launcher=()

# Formatting is judged by Debian 12's clang-format alone: other versions wrap a few lines otherwise.
check_format() {
    local version
    version=$(clang-format --version | grep -oE 'version [0-9]+' | grep -oE '[0-9]+')
    if [[ $version != 14 ]]; then
        echo "formatting: not judged (clang-format is version $version, the rules are version 14's)"
        return 0
    fi
    find core api server tests -name node_modules -prune -o \( -name '*.cpp' -o -name '*.hpp' \) -print0 |
        xargs -0 clang-format --dry-run -Werror
}

part_fast() {
    heading "formatting"
    check formatting check_format
    build release && run_ctest release
    heading "the same bytes from every compiler"
    check digest tests/digest/compare.sh build/release/tests/digest/operation_digest
    heading "what is promised has a test"
    check contract tests/contract/check.sh release
}

part_readme() {
    build release tinsmith || return
    heading "the README's lines, and those of the interface page"
    check recipes tests/recipes/run.sh build/release/tinsmith
}

# Node's test runner ends with "# pass N" and "# fail N", or "ℹ pass N" from version 23 on.
node_count() {
    grep -oE "^(#|ℹ) $2 [0-9]+" "$1" | grep -oE '[0-9]+$' | awk '{n += $1} END {print n + 0}'
}

part_node() {
    build release || return
    heading "the page"
    check page server/viewer/build.sh build/viewer
    local package folder log good bad
    log=$(mktemp)
    for package in tests/*/package.json; do
        [[ -e $package ]] || continue
        folder=$(dirname "$package")
        heading "node $folder"
        if ! (cd "$folder" && npm ci --no-audit --no-fund --loglevel=error); then
            tally "npm ci in $folder" 0 1
            continue
        fi
        (cd "$folder" && TINSMITH=$OLDPWD/build/release/tinsmith npm test) 2>&1 | tee "$log"
        local outcome=${PIPESTATUS[0]}
        good=$(node_count "$log" pass)
        bad=$(node_count "$log" fail)
        if ((outcome != 0 && bad == 0)); then bad=1; fi
        if ((outcome == 0 && good == 0)); then good=1; fi
        tally "node $folder" "$good" "$bad"
    done
    rm -f "$log"
}

part_sanitizers() {
    export UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1
    export LSAN_OPTIONS=suppressions=$PWD/tests/lsan.supp:print_suppressions=0
    export TSAN_OPTIONS=halt_on_error=1:second_deadlock_stack=1
    build asan-ubsan && run_ctest asan-ubsan --label-exclude '^arch$'
    # Threads meet in the server only. GCC 12's runtime cannot place its shadow under the widest
    # address randomization that kernels offer, so that is off for these tests where allowed.
    if build tsan unit_server e2e; then
        setarch --addr-no-randomize true 2>/dev/null && launcher=(setarch --addr-no-randomize)
        run_ctest tsan --label-regex '^(unit_server|e2e.*)$'
        launcher=()
    fi
}

part_tidy() {
    docker/packages/install.sh tidy || { tally "installing clang-tidy" 0 1; return; }
    build dev || return
    heading "clang-tidy"
    check tidy bash -o pipefail -c "find core api server -name '*.cpp' -print0 |
        xargs -0 -n 4 -P $jobs clang-tidy --quiet --extra-arg=-Wno-unknown-warning-option -p build/dev 2>&1 | grep -v 'warnings generated'"
}

part_image() {
    heading "container image"
    check image docker/build-without-engine.sh
}

parts=("$@")
((${#parts[@]})) || parts=(fast readme node sanitizers)
for part in "${parts[@]}"; do
    case $part in
        fast | readme | node | sanitizers | tidy | image) ;;
        -h | --help | help) usage && exit 0 ;;
        *) usage >&2 && exit 2 ;;
    esac
done

mkdir -p build
if docker/packages/install.sh build test; then
    for part in "${parts[@]}"; do
        "part_$part"
    done
else
    tally "installing packages" 0 1
fi

printf '\n'
for line in "${failures[@]}"; do
    printf 'FAILED %s\n' "$line"
done
printf '%d passed, %d failed\n' "$passed" "$failed"
((failed == 0))
