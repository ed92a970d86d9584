# Sourced by the tests of whole runs. Each test has its own temporary folder and its own private network. Exit code: 0, 1
# with a reason, or 77 (skipped) if this machine does not permit network namespaces.
set -euo pipefail

root="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"
export KINTSUGI_BIN="${KINTSUGI_BIN:-$root/build/release/bin}"
export KINTSUGI_TEST_BIN="${KINTSUGI_TEST_BIN:-$root/build/release/tests}"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
cd "$work"

if ! unshare --net true 2>/dev/null && ! unshare --map-root-user --net true 2>/dev/null; then
  echo "skipped: this machine does not permit network namespaces"
  exit 77
fi

fail() {
  echo "FAILED: $*" >&2
  tail -n 20 ./*/*.log >&2 2>/dev/null || true
  exit 1
}

# run_trio ARGS...: runs scripts/trio, with its output in trio.txt; the test fails if it fails.
run_trio() {
  "$root/scripts/trio" "$@" >trio.txt 2>&1 || {
    cat trio.txt
    fail "scripts/trio $*"
  }
}

# wait_until COMMAND...: waits until COMMAND succeeds, at most 5 min: beside other work two mappers at once take more than
# one. False when it has not.
wait_until() {
  local i
  for ((i = 0; i < 3000; i++)); do
    "$@" && return
    sleep 0.1
  done
  return 1
}

# wait_for_file FILE: waits until FILE is not empty.
wait_for_file() { wait_until test -s "$1" || fail "$1 did not appear"; }

# wait_for_text TEXT FILE: waits until a line of FILE matches TEXT.
wait_for_text() { wait_until grep -qs "$1" "$2" || fail "$2 does not say '$1': $(cat "$2")"; }

# A short run of the synthetic office with large voxels: it takes seconds, and some slices leave the volume before the
# end. The session number is fixed, because it is part of the map.
small_room=(--private --device 'synthetic://office?frames=120' --resolution 0.02 --volume-size 3.2 --every 2
  --mapper '--session=7')

# vertices FILE.ply: the number of vertices in its header.
vertices() { head -c 2000 "$1" | grep -a -m1 -oP 'element vertex \K\d+'; }

expect_file() { [[ -s "$1" ]] || fail "$1 is missing or empty; there is: $(ls .)"; }
expect_same() { cmp "$1" "$2" || fail "$1 and $2 differ"; }
# The same points in the same segments, whose ids may differ.
expect_same_partition() { "$root/scripts/lib/same_partition.py" "$1" "$2" || fail "$1 and $2 differ"; }
expect_no_partial_files() { compgen -G "$1/*.partial*" && fail "half-written files are left" || true; }

# hold_rows ROW...: runs rows of scripts/faults in their small form. Skipped if this machine does not permit one.
hold_rows() {
  local code=0
  "$root/scripts/faults" --quick --out "$work/faults" "$@" 2>&1 || code=$?
  ((code == 77)) && exit 77
  ((code == 0)) || {
    tail -n 30 "$work"/faults/*/faulty/*.log >&2 2>/dev/null || true
    fail "scripts/faults --quick $*"
  }
}
