# A process is stopped for a while (SIGSTOP), as by a debugger, by a suspended machine or by swapping.

for process in segmenter viewer mapper; do
  for seconds in 0.5 10; do
    fault_row "stop-$process-$seconds" "$process stopped for $seconds s" stop_row "$process" "$seconds"
  done
done

# mapper_rate RUN: the mean frame rate and the dropped frames.
mapper_rate() {
  awk -F, '$2 == "mapper" && $3 == "frame_rate_hz" && $4 > 0 { sum += $4; ++n }
           $2 == "mapper" && $3 == "frames_dropped" { dropped = $4 }
           END { printf "%.1f Hz and %d frames dropped", n ? sum / n : 0, dropped }' "$1/status.csv"
}

# At the camera's rate a mapper that waited for the others would drop frames. The frames come from a recording, because
# rendering takes processor time. Where the mapper itself is stopped, the run is one without dropped frames (--replay), so
# that the maps can be compared.
choose_live_scene() {
  local recording="$runs/recording"
  [[ -e "$recording/done" ]] || {
    "$KINTSUGI_BIN/kintsugi-render-scene" 'synthetic://office?frames=375' --out "$recording" >render.txt 2>&1
    : >"$recording/done"
  }
  scene=(--every 1000000 --no-log --device "folder://$recording" --resolution 0.01 --volume-size 3.2
    --mapper '--session=7 --shift=8')
}

stop_row() {
  local process="$1" seconds="$2" pid
  if if_quick || [[ "$process" == mapper ]]; then choose_scene; else choose_live_scene; fi
  reference
  must "the machine is too busy: frames were dropped without a fault" test \
    "$(status_last "$reference" mapper frames_dropped)" = 0
  faulty_start
  pid="$(pid_of "$process")"
  pid_of mapper >/dev/null
  sleep "$(calculate "0.2 * ${figure[reference_s]}")"
  kill -STOP "$pid"
  sleep "$seconds"
  kill -CONT "$pid"
  faulty_wait
  same_map
  note "mapper $(mapper_rate faulty), without: $(mapper_rate "$reference")"
  [[ "$process" == mapper ]] ||
    must "the mapper dropped frames" test "$(status_last faulty mapper frames_dropped)" = \
      "$(status_last "$reference" mapper frames_dropped)"
}
