#!/usr/bin/env bash
# What `cmake --install` installs is complete: a project outside the tree finds it, builds with warnings as errors, and
# runs; the Python package is found where it is installed.
# Usage: test_install.sh BUILD_FOLDER
set -euo pipefail
build="$(cd "$1" && pwd)"
consumer="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/consumer"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
cd "$work"

fail() {
  echo "FAILED: $*" >&2
  exit 1
}
# say_nothing COMMAND...: its output only if it fails.
say_nothing() { "$@" >out.txt 2>&1 || { cat out.txt; fail "$*"; }; }

# Only what this test needs is built before it, so only that is installed.
for part in library python; do
  [[ -f "$build/segmenter/$part/cmake_install.cmake" ]] || continue
  say_nothing cmake -DCMAKE_INSTALL_PREFIX="$work/prefix" -P "$build/segmenter/$part/cmake_install.cmake"
done

say_nothing cmake -S "$consumer" -B consumer -DCMAKE_BUILD_TYPE=Debug -DCMAKE_PREFIX_PATH="$work/prefix"
say_nothing cmake --build consumer
grep -q 'ffp-contract\|fno-semantic-interposition' consumer/CMakeFiles/*/flags.make && fail "our options reach other projects"

segmented="$(consumer/segment_a_cloud)"
expected="$(sed -n 's/^inline constexpr char kVersion.*"\(.*\)";/Kintsugi \1/p' prefix/include/kintsugi/version.hpp)
2 segments
segment 1: 800 points"
[[ "$segmented" == "$expected" ]] || fail "segment_a_cloud printed: $segmented"
consumer/read_a_log none.lcm 2>err.txt && fail "read_a_log accepted a file that there is not"
grep -q 'none.lcm' err.txt || fail "read_a_log says: $(cat err.txt)"

# A version that does not fit is refused.
sed 's/find_package(Kintsugi [0-9.]*/find_package(Kintsugi 99.0/' "$consumer/CMakeLists.txt" >CMakeLists.txt
cp "$consumer"/*.cc .
cmake -S . -B other -DCMAKE_PREFIX_PATH="$work/prefix" >out.txt 2>&1 && fail "version 99 was found"
grep -q 'Kintsugi' out.txt || fail "no reason: $(cat out.txt)"

packages="prefix/lib/python3/dist-packages"
if [[ -d "$packages" ]]; then
  PYTHONPATH="$packages" /usr/bin/python3 -c '
import kintsugi, kintsugi.lcm, kintsugi.lcm.layout, os
assert kintsugi.__file__.startswith(os.path.realpath("prefix")), kintsugi.__file__
assert kintsugi.lcm.segment_update_t().num_labels == 0
for name in ("py.typed", "__init__.pyi"):
    assert os.path.exists(os.path.join(os.path.dirname(kintsugi.__file__), name)), name
' || fail "the Python package"
fi
