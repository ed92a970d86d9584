#!/usr/bin/env bash
# Error messages name the reason and the place, and the exit code is not 0.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

# expect_error PATTERN COMMAND...: COMMAND fails with a message that matches PATTERN.
expect_error() {
  local pattern="$1" said
  shift
  said="$(timeout 30 "$@" 2>&1)" && fail "'$*' succeeded; expected: $pattern"
  grep -qiE -- "$pattern" <<<"$said" || fail "'$*' does not say '$pattern' but: $said"
}
on_a_bus=("$root/scripts/private_bus")

expect_error 'unknown option --nonsense' "$root/scripts/trio" --nonsense
expect_error 'needs a value' "$root/scripts/trio" --out
expect_error 'no such file' "$root/scripts/replay" missing.lcm
mapper=("${on_a_bus[@]}" "$KINTSUGI_BIN/kintsugi-mapper" --replay)
expect_error 'missing' "${mapper[@]}" --device folder://missing
expect_error 'no synthetic scene.*office' "${mapper[@]}" --device synthetic://nowhere
expect_error 'resolution' "${mapper[@]}" --device synthetic://office --resolution -1
head -c 4000 /dev/urandom >foreign.oni
expect_error 'foreign.oni' "${mapper[@]}" --device foreign.oni
: >empty.oni
expect_error 'empty.oni' "${mapper[@]}" --device empty.oni
segmenter=("${on_a_bus[@]}" "$KINTSUGI_BIN/kintsugi-segmenter")
expect_error 'batch.*voting' "${segmenter[@]}" --mode nonsense
expect_error 'threshold' "${segmenter[@]}" --threshold -1
segment_cloud="$KINTSUGI_BIN/kintsugi-segment-cloud"
expect_error 'missing.ply' "$segment_cloud" missing.ply out.ply --mode batch
printf 'ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nend_header\n1\n' >bad.ply
expect_error 'bad.ply.*\by\b' "$segment_cloud" bad.ply out.ply --mode batch
[[ ! -e out.ply ]] || fail "a failed run left an output"
