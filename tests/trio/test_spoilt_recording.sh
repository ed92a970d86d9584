#!/usr/bin/env bash
# A recording with a damaged image in its middle: the file is named, and all other images are mapped and written. Without
# any image that can be read the exit code is not 0.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

"$KINTSUGI_BIN/kintsugi-render-scene" 'synthetic://office?frames=40' --out recording >render.txt 2>&1 || {
  cat render.txt
  fail "kintsugi-render-scene"
}
image="$(awk '!/^#/ {print $2}' recording/depth.txt | sed -n 30p)"
truncate -s 2000 "recording/$image"

"$root/scripts/trio" --private --device "folder://$work/recording" --replay --resolution 0.02 --volume-size 3.2 \
  --out run >trio.txt 2>&1 || fail "one spoilt image ended the run: $(cat trio.txt)"
grep -q "$image" run/mapper.log || fail "the spoilt image is not named: $(cat run/mapper.log)"
for file in segments.ply segments.json final.png trajectory.txt run.lcm; do expect_file "run/$file"; done
(($(grep -vc '^#' run/trajectory.txt) == 39)) || fail "the other images were not mapped"

truncate -s 2000 recording/depth/*
"$root/scripts/trio" --private --device "folder://$work/recording" --replay --resolution 0.02 --volume-size 3.2 \
  --out none >trio.txt 2>&1 && fail "a recording without images was taken for a whole one"
grep -q 'depth' trio.txt || fail "the reason is not given: $(cat trio.txt)"
