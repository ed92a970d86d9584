#!/usr/bin/env bash
# A recording with a damaged image in its middle: everything before it is mapped and written, the file is named, and the
# exit code is not 0.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

"$KINTSUGI_BIN/kintsugi-render-scene" 'synthetic://office?frames=40' --out recording >render.txt 2>&1 || {
  cat render.txt
  fail "kintsugi-render-scene"
}
image="$(awk '!/^#/ {print $2}' recording/depth.txt | sed -n 30p)"
truncate -s 2000 "recording/$image"

"$root/scripts/trio" --private --device "folder://$work/recording" --replay --resolution 0.02 --volume-size 3.2 \
  --out run >trio.txt 2>&1 && fail "a spoilt recording was taken for a whole one"
grep -q "$image" trio.txt || fail "the spoilt image is not named: $(cat trio.txt)"
for file in segments.ply segments.json final.png trajectory.txt run.lcm; do expect_file "run/$file"; done
(($(grep -vc '^#' run/trajectory.txt) >= 25)) || fail "what came before it was not mapped"
