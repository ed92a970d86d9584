#!/usr/bin/env bash
# A log with raw frames, played by lcm-logplayer into a mapper that reads the bus, gives the same frames. Lost raw frames
# are not sent again, so a few may be missing.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

run_trio "${small_room[@]}" --replay --publish-frames --out first
cat >second.sh <<'SH'
"$KINTSUGI_BIN/kintsugi-mapper" --device lcm://RGBD_FRAME --replay --max-frames 120 --resolution 0.02 --volume-size 3.2 \
  --output-trajectory second.txt &
mapper=$!
"$KINTSUGI_BIN/kintsugi-status" --until-ready mapper --timeout 20 >/dev/null
lcm-logplayer -l "$LCM_DEFAULT_URL" -e '^RGBD_FRAME$' first/run.lcm >/dev/null
wait "$mapper"
SH
"$root/scripts/private_bus" bash second.sh >second.log 2>&1 || {
  cat second.log
  fail "the mapper on the bus"
}
expect_file second.txt
(($(grep -vc '^#' second.txt) >= 115)) || fail "too few frames were tracked: $(cat second.log)"
# One pose for each frame, with the time stamps of the device.
others="$(comm -13 <(grep -v '^#' first/trajectory.txt | cut -d' ' -f1) <(grep -v '^#' second.txt | cut -d' ' -f1))"
[[ -z "$others" ]] || fail "the mapper on the bus saw other frames: $others $(cat second.log)"
