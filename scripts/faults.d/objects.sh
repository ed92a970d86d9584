# The detector of objects beside a trio: killed, among hostile messages, and with a library that is damaged. What it has found
# at the end has to be what it finds without the fault.

fault_row kill-detector "detector of objects killed at a random moment of each run" kill_detector_row
fault_row hostile-objects "random and mutated messages on every channel beside a detector and its clients" hostile_objects_row
fault_row library "objects of the library damaged, foreign and half-written" library_row

# teach_scene: makes $library from the map of the reference. Its objects are segments of middle size that are found again
# in the map, those of the best scores, so that there are some of which the detector cannot be in doubt.
teach_scene() {
  local id name num_kept=0
  library="$runs/objects-$(basename "$reference")"
  [[ ! -e "$library.done" ]] || return 0
  rm -rf "$library" all
  for id in $(middle_segments "$reference/segments.json" 24); do
    "$KINTSUGI_BIN/kintsugi-objects" teach --map "$reference/segmenter.map" --ids "$id" --name "thing_$id" \
      --library all >>teach.txt 2>&1 || {
      say "$row_name: teaching failed: $PWD/teach.txt"
      exit 1
    }
  done
  "$KINTSUGI_BIN/kintsugi-objects" detect "$reference/segmenter.map" --library all --json all.json >>teach.txt 2>&1 || {
    say "$row_name: detecting failed: $PWD/teach.txt"
    exit 1
  }
  mkdir -p "$library"
  for name in $(names_found all.json); do
    ((num_kept < 6)) || break
    [[ ! -e "$library/$name" ]] || continue
    cp -r "all/$name" "$library/"
    num_kept=$((num_kept + 1))
  done
  ((num_kept > 3)) || { # row `library` damages three of them
    say "$row_name: only $num_kept of the segments of $reference are found again: $PWD/all.json"
    exit 1
  }
  : >"$library.done"
}

# names_found FILE.json: of the objects that were found, the highest score first.
names_found() {
  python3 -c '
import json, sys
detections = json.load(open(sys.argv[1]))["detections"]
print(*[d["name"] for d in sorted(detections, key=lambda d: (-d["score"], d["name"]))])' "$1"
}

# middle_segments SEGMENTS.json N: the ids of the N largest segments of 60 points and more that could be carried: at most
# 0.6 m along each axis.
middle_segments() {
  python3 -c '
import json, sys
def is_carried(segment):
    return all(high - low <= 0.6 for low, high in zip(segment["box_min"], segment["box_max"]))
segments = [s for s in json.load(open(sys.argv[1]))["segments"] if s["points"] >= 60 and is_carried(s)]
print(*[s["id"] for s in sorted(segments, key=lambda s: (-s["points"], s["id"]))[:int(sys.argv[2])]])' "$@"
}

# whole_run: a run without a fault, with the detector; sets $found, what it has found.
whole_run() {
  choose_scene
  reference
  teach_scene
  found="$library.json"
  [[ -e "$found" ]] || {
    run_to_end whole "${scene[@]}" --objects "$library" || {
      say "$row_name: the run without a fault failed: $PWD/whole.txt"
      exit 1
    }
    must "a detector that was not killed counts as restarted" not_restarted whole.txt
    cp whole/objects.json "$found"
  }
  must "nothing was found without a fault" test "$(num_detections "$found")" -ge 3
}
not_restarted() { ! grep -q 'detector restarted' "$1"; }
num_detections() { grep -c '"detection":' "$1" || true; }

# same_detections FILE: the faulty run has to have found what is in the file, and to have drawn it.
same_detections() {
  must "other objects were found than without the fault" "$kintsugi_root/scripts/lib/same_detections.py" "$1" \
    faulty/objects.json
  must "there is no picture of the objects" test -s faulty/objects_final.png
}

kill_detector_row() {
  local num_runs="${KINTSUGI_KILL_RUNS:-20}" run moment kills=0
  if_quick && num_runs="${KINTSUGI_KILL_RUNS:-1}"
  whole_run
  for ((run = 1; run <= num_runs; ++run)); do
    draw_moment
    faulty_start --objects "$library"
    pid_of detector >/dev/null
    kill_at "$moment" detector
    faulty_wait
    kills=$((kills + $(grep -c 'detector was killed' faulty.txt || true)))
    same_detections "$found"
    same_map
    if ((${#failures[@]})); then
      failures+=("in run $run: killed at $moment s")
      return
    fi
    rm -rf faulty
  done
  must "no detector was killed" test "$kills" -ge 1
  note "$kills kills in $num_runs runs; $(num_detections "$found") objects found in each"
}

tells_of_invalid() { grep -q 'messages of objects dropped: [0-9]' "$1.err"; }

hostile_objects_row() {
  local hostile="${KINTSUGI_TEST_BIN:-$kintsugi_root/build/release/tests}/hostile_publisher" events query=0 sender
  [[ -x "$hostile" ]] || skip_row "hostile_publisher is not built (scripts/build)"
  whole_run
  faulty_start --objects "$library"
  pid_of detector >/dev/null
  "$KINTSUGI_BIN/kintsugi-segment-events" --exit-on-final --quiet >events.txt 2>events.err &
  events=$!
  # Until the run has ended.
  "$hostile" --seconds=600 --seed="$seed" --listen=0.5 --report=hostile.json >hostile.txt 2>&1 &
  sender=$!
  # Until it has also heard invalid messages: on a busy machine they begin late.
  while kill -0 "$faulty_pid" 2>/dev/null && ((!query)); do
    "$KINTSUGI_BIN/kintsugi-query" --objects --timeout 5 >query.txt 2>query.err && tells_of_invalid query && query=1
  done
  faulty_wait
  kill -TERM "$sender" && wait "$sender" || true
  wait "$events" || failures+=("kintsugi-segment-events failed, see $PWD/events.err")
  must "kintsugi-query never found an object and told of invalid messages" test "$query" = 1
  must "kintsugi-segment-events does not tell of invalid messages" tells_of_invalid events
  note "$(json_number hostile.json OBJECT_DETECTION) hostile detections and $(json_number hostile.json DETECTOR_STATUS) \
statuses of detectors"
  same_detections "$found"
  same_map
}

library_row() {
  local names bad
  whole_run
  cp -r "$library" damaged
  mapfile -t names < <(ls damaged)
  bad=("${names[@]:0:3}")
  truncate --size=-100 "damaged/${bad[0]}/model.ply"
  echo '{"format": "a shopping list"}' >"damaged/${bad[1]}/object.json"
  rm "damaged/${bad[2]}/model.ply"
  cp -r "damaged/${names[3]}" "damaged/.${names[3]}.tmp" # what a killed program leaves: nobody reads it
  mkdir good
  for name in "${names[@]:3}"; do cp -r "damaged/$name" good/; done
  faulty_start --objects "$PWD/damaged"
  faulty_wait
  for name in "${bad[@]}"; do
    must "$name is not named as refused" grep -q "$name is not used: .*/$name" faulty/detector.log
  done
  must "the status does not count three refused objects" test "$(status_last faulty detector library_refused)" = 3
  "$KINTSUGI_BIN/kintsugi-objects" detect faulty/segmenter.map --library good --json good.json >good.txt 2>&1 ||
    failures+=("kintsugi-objects detect failed, see $PWD/good.txt")
  must "nothing was found with the other objects" test "$(num_detections good.json)" -ge 1
  same_detections good.json
  note "$(num_detections good.json) objects found with the $((${#names[@]} - 3)) that are left"
}
