#!/usr/bin/env bash
# What a run would fail of is told before anything is started or written. A private run tells how to ask it.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

# refused TEXT ARGS...: scripts/trio ends with 2, its last line has the text, and the folder "run" is as before.
refused() {
  local text="$1" before code=0
  before="$(ls -a run 2>/dev/null || true)"
  "$root/scripts/trio" --private --out run "${@:2}" >refused.txt 2>&1 || code=$?
  ((code == 2)) || fail "exit code $code: $(cat refused.txt)"
  tail -n 1 refused.txt | grep -qF -- "$text" || fail "the last line is not '$text': $(cat refused.txt)"
  [[ "$(ls -a run 2>/dev/null || true)" == "$before" ]] || fail "the folder has changed: $(ls -a run)"
}
refuse_all() {
  refused 'nowhere.oni: no such file' --device nowhere.oni
  refused "synthetic://nowhere" --device synthetic://nowhere
  refused '--resolution' --device synthetic://office --resolution -1
  refused 'see kintsugi-viewer --help' --device synthetic://office --viewer --nonsense
  refused "unknown key 'max_rnge' (did you mean 'max-range'?)" --device synthetic://office --mapper '--config wrong.toml'
  refused 'scripts/trio sets --store itself' --mapper '--store my.lcm'
}
echo 'max_rnge=3' >wrong.toml
refuse_all # before there is a folder

mkdir 'a folder'
run_trio "${small_room[@]}" --max-frames 20 --no-log --mapper "--output-trajectory 'a folder/path.txt'" \
  --viewer '--every 1' --out run
expect_file 'a folder/path.txt'
refuse_all # in a folder that holds a run

# From another folder than that of the scripts, by a relative path.
ln -s "$root" kintsugi
kintsugi/scripts/trio --private --resume --out run >trio.txt 2>&1 || fail "resumed by a relative path: $(cat trio.txt)"
tail -n 1 trio.txt | grep -q 'nothing was resumed' || fail "it does not say that nothing was resumed: $(cat trio.txt)"

# Only a camera runs long enough to be asked.
KINTSUGI_CAMERAS='synthetic://office' "$root/scripts/trio" --private --device '' --resolution 0.03 --no-log --out camera \
  >trio.txt 2>&1 &
trio=$!
wait_for_file camera/mapper.lcm
ask="$(grep -oP 'from another terminal: \Knsenter .* --once' trio.txt)" || fail "it does not say how to ask: $(cat trio.txt)"
$ask >asked.txt 2>&1 || fail "$ask: $(cat asked.txt)"
grep -q 'slices' asked.txt || fail "no status: $(cat asked.txt)"
kill -TERM "$trio"
wait "$trio" || fail "the run with the first camera: $(cat trio.txt)"
