#!/usr/bin/env bash
# In the synthetic loop a third of the slices is moved by a few centimetres, and back. After each step the segments must
# be exactly those of batch, and at the end those of the uncorrected map. Takes minutes; run it by ctest -C long -L long.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

if [[ -n "${KINTSUGI_LOOP_LOG:-}" ]]; then # a run.lcm of scripts/trio --device synthetic://loop
  cp "$KINTSUGI_LOOP_LOG" run.lcm
else
  run_trio --private --device synthetic://loop --replay --volume cube --out live
  mv live/run.lcm run.lcm
fi
"$KINTSUGI_TEST_BIN/trio_revise_slices" run.lcm revised.lcm
for run in run revised; do
  "$KINTSUGI_BIN/kintsugi-segmenter" --log "$run.lcm" --audit --out "$run" >"$run.txt" 2>&1 || {
    cat "$run.txt"
    fail "kintsugi-segmenter --log $run.lcm --audit"
  }
  grep -E 'session' "$run.txt"
done
for what in num_slices num_points num_segments; do
  diff <(grep -m1 "\"$what\"" run/segments.json) <(grep -m1 "\"$what\"" revised/segments.json) || fail "$what differs"
done
