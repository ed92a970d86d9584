#!/usr/bin/env bash
# What all programs have in common: --version, --help, and that their folder can be moved.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

version="$(grep -oP 'project\(kintsugi VERSION \K[0-9.]+' "$root/CMakeLists.txt")"
for program in "$KINTSUGI_BIN"/kintsugi-*; do
  name="$(basename "$program")"
  [[ "$("$program" --version)" == "$name $version" ]] || fail "$name --version: $("$program" --version 2>&1)"
  "$program" --help >help.txt || fail "$name --help"
  code=0
  "$program" --nonsense >help.txt 2>&1 || code=$?
  ((code >= 100 && code <= 127)) || fail "$name --nonsense ends with $code, not with 100 to 127"
done

for name in mapper segmenter viewer; do
  device=()
  [[ "$name" == mapper ]] && device=(--device 'synthetic://office?frames=2')
  "$KINTSUGI_BIN/kintsugi-$name" "${device[@]}" --print-config >printed.toml
  "$KINTSUGI_BIN/kintsugi-$name" --config printed.toml --check || fail "kintsugi-$name does not read back what it prints"
  code=0
  echo 'lcm-ulr=""' >wrong.toml
  "$KINTSUGI_BIN/kintsugi-$name" --config wrong.toml --check >told.txt 2>&1 || code=$?
  ((code >= 100 && code <= 127)) || fail "kintsugi-$name takes an unknown key: exit code $code"
  grep -q "wrong.toml: unknown key 'lcm-ulr' (did you mean 'lcm-url'?)" told.txt || fail "kintsugi-$name: $(cat told.txt)"
done

mkdir moved
cp --archive --reflink=auto "$KINTSUGI_BIN" moved/bin
[[ "$(ldd moved/bin/kintsugi-mapper)" == *"=> $work/moved/bin/openni2/libOpenNI2.so.0"* ]] ||
  fail "a moved mapper uses another OpenNI2: $(ldd moved/bin/kintsugi-mapper | grep OpenNI2)"
moved/bin/kintsugi-mapper --check --device 'synthetic://office?frames=2' || fail "a moved mapper opens no device"
