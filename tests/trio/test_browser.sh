#!/usr/bin/env bash
# The map in a headless Chromium: of a viewer with --http that reads a log, and of kintsugi-export --html.
source "$(dirname "$0")/lib.sh"
for program in chromium chromedriver; do
  command -v "$program" >/dev/null || {
    echo "skipped: there is no $program; scripts/packages-browser.txt has what this test needs"
    exit 77
  }
done
export HOME="$work" # Chromium's profile

run_trio "${small_room[@]}" --out run
"$KINTSUGI_BIN/kintsugi-export" run/segmenter.map --html scene.html 2>export.log || fail "kintsugi-export: $(cat export.log)"
! grep -qE 'https?://' scene.html || fail "scene.html names an address"
python3 "$root/tests/trio/browser_page.py" "file://$work/scene.html" "$work/export.png" || fail "the exported page"

touch viewer.log
"$KINTSUGI_BIN/kintsugi-viewer" --log run/run.lcm --every 1000 --out pictures --http 127.0.0.1:0 >viewer.log 2>&1 &
viewer=$!
trap 'kill "$viewer" 2>/dev/null || true; rm -rf "$work"' EXIT
for ((i = 0; i < 300; i++)); do
  grep -q "the log has been read" viewer.log && break
  sleep 0.1
done
url="$(grep -oP 'in a browser: \Khttp://\S+' viewer.log)" || fail "the viewer serves nothing: $(cat viewer.log)"
python3 "$root/tests/trio/browser_page.py" "$url" "$work/live.png" || fail "the page of the viewer"
kill -INT "$viewer"
wait "$viewer" || fail "the viewer ended with an error: $(cat viewer.log)"
[[ -z "${KINTSUGI_KEEP:-}" ]] || cp ./*.png "$KINTSUGI_KEEP"
