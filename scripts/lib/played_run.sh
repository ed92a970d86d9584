# Sourced by rows whose mapper is the test program slice_player. It publishes a generated map of any size through the
# mapper's own stream and log.

player="${KINTSUGI_TEST_BIN:-$kintsugi_root/build/release/tests}/slice_player"
played=()                # options of slice_player
resumable=0              # 1: mapper and segmenter go on where they were when they are started again
viewer_ends=(--exit-on-final)
mapper_at=() others_at=() # prefixes of the commands of the mapper and of the others, for another host or another bus

# The same map in all rows but those of late joiners. With --quick it is small.
choose_played() {
  [[ -x "$player" ]] || skip_row "slice_player is not built (scripts/build)"
  played=(--session=7 --points=1000000 --speed=0)
  if_quick && played=(--session=7 --points=60000 --slice-points=2000 --speed=0)
  return 0
}

# start_played PROCESS...: starts mapper, segmenter, viewer or log, which writes all statuses to $out/status.csv.
start_played() {
  local name store=() saves=()
  mkdir -p "$out"
  ((resumable)) && store=(--store="$out/mapper.lcm") saves=(--save="$out/segmenter.map" --save-every=5 --resume-if-saved)
  for name in "$@"; do
    case "$name" in
      mapper) process_start mapper "${mapper_at[@]}" "$player" --linger=-1 --report="$out/player.json" \
        "${store[@]}" "${played[@]}" ;;
      segmenter) process_start segmenter "${others_at[@]}" "$KINTSUGI_BIN/kintsugi-segmenter" --out="$out" --linger=-1 \
        "${saves[@]}" ;;
      viewer) process_start viewer "${others_at[@]}" "$KINTSUGI_BIN/kintsugi-viewer" --out="$out" "${viewer_ends[@]}" \
        --every=1000000 ;;
      log) process_start log "${others_at[@]}" "$KINTSUGI_BIN/kintsugi-status" --log "$out/status.csv" ;;
    esac
  done
}

# finish_played SECONDS: waits at most so long until the viewer has drawn the whole map; then ends all.
finish_played() {
  local deadline=$((SECONDS + $1)) name code
  while process_alive viewer && process_alive segmenter && process_alive mapper && ((SECONDS < deadline)); do sleep 0.1; done
  must "the viewer has not drawn the whole map within $1 s, or the others ended before it" not_alive viewer
  for name in viewer segmenter mapper log; do
    process_stop 60 "$name" || failures+=("$name did not stop")
    code=0
    process_wait "$name" || code=$?
    ((code == 0 || code == 143)) || [[ "$name" == log ]] ||
      failures+=("$name ended with code $code, see $out/$name.log")
  done
  read_figures "$out"
}
not_alive() { ! process_alive "$1"; }

# played_run RUN: a whole run, in which all processes are there from the start.
played_run() {
  local since="$EPOCHREALTIME"
  out="$PWD/$1"
  start_played log segmenter viewer mapper
  finish_played 300
  figure[seconds]="$(since_s "$since")"
}

# played_reference: the run without a fault; sets $reference, its folder. Rows that play the same map share one.
played_reference() {
  local key
  key="$(printf '%s\n' "${played[@]}" | cksum | cut -d' ' -f1)"
  reference="$runs/played-$key"
  if [[ ! -e "$reference/seconds" ]]; then
    cd "$runs"
    played_run "played-$key"
    cd - >/dev/null
    ((!${#failures[@]})) || return 0
    echo "${figure[seconds]}" >"$reference/seconds"
  fi
  figure[reference_s]="$(<"$reference/seconds")"
}

# json_number FILE NAME: the value of a field in a report.
json_number() { grep -m1 -oP "\"$2\": \K[0-9.]+" "$1" || echo 0; }
