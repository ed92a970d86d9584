#!/usr/bin/env bash
# A log of raw frames, played by lcm-logplayer into a mapper that reads the bus, gives the same frames again.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

run_trio "${small_room[@]}" --replay --publish-frames --out first
cat >second.sh <<'SH'
"$KINTSUGI_BIN/kintsugi-mapper" --device lcm://RGBD_FRAME --replay --max-frames 120 --resolution 0.02 --volume-size 3.2 \
  --output-trajectory second.txt &
mapper=$!
"$KINTSUGI_BIN/kintsugi-status" --until-ready mapper --timeout 20 >/dev/null
lcm-logplayer -l "$LCM_DEFAULT_URL" -e '^RGBD_FRAME$' first/run.lcm >/dev/null
sleep 2
kill -INT "$mapper" 2>/dev/null
wait "$mapper"
SH
"$root/scripts/private_bus" bash second.sh >second.log 2>&1 || {
  cat second.log
  fail "the mapper on the bus"
}
expect_file second.txt
(($(grep -vc '^#' second.txt) == 120)) || fail "not every frame was tracked: $(cat second.log)"
# One pose for each frame, at the device's own times.
diff <(grep -v '^#' first/trajectory.txt | cut -d' ' -f1) <(grep -v '^#' second.txt | cut -d' ' -f1) ||
  fail "the mapper on the bus saw other frames: $(cat second.log)"
