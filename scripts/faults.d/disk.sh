# The disk that everything is written to is full: the mapper's log, the segmenter's saved map, the viewer's snapshots.

fault_row disk-full "disk full in the middle of a run, until all three have said so" disk_full_row
fault_row disk-full-end "disk full from the middle of a run on; then space, and scripts/trio --resume" disk_full_end_row

# small_disk: the folder `faulty` becomes a disk of its own. What is on it is copied to `kept` by keep_disk.
small_disk() {
  mkdir faulty
  mount -t tmpfs -o size=64m kintsugi-faults faulty 2>/dev/null || skip_row "mounting a tmpfs is not permitted"
}
keep_disk() { cp -r faulty kept; }

# fill_disk: until free_disk; what others give free is taken at once.
fill_disk() {
  (while :; do
    cat /dev/zero >>faulty/ballast 2>/dev/null || true
    sleep 0.05
  done) &
  filler=$!
}
free_disk() {
  kill "$filler" && wait "$filler" 2>/dev/null || true
  rm faulty/ballast
}

# watch_statuses: into a file that is not on the small disk.
watch_statuses() {
  "$KINTSUGI_BIN/kintsugi-status" --log statuses.csv >/dev/null 2>&1 &
  watcher=$!
}
unwatch_statuses() { kill "$watcher" && wait "$watcher" || true; }

# said_problem PROCESS FIELD: that its status named the full disk.
said_problem() { grep -qE "^[0-9]+,$1,$2,.*No space" statuses.csv; }

# problems_are_said [SECONDS]: by all three, or will be in so long.
problems_are_said() {
  local i
  for ((i = 0; i < 10 * ${1:-0}; ++i)); do
    said_problem mapper store_problem && said_problem segmenter problem && said_problem viewer problem && return
    sleep 0.1
  done
  must "the mapper does not say that its log cannot be written" said_problem mapper store_problem
  must "the segmenter does not say that its map cannot be saved" said_problem segmenter problem
  must "the viewer does not say that its pictures cannot be written" said_problem viewer problem
}

# fill_disk_in_a_run: starts the run, with a snapshot and a saved map at each slice, so that all writers meet the full
# disk; after a third of the time that the reference took, it is full.
fill_disk_in_a_run() {
  local snapshot_every=1
  choose_scene
  scene+=(--segmenter '--write-every=1')
  reference
  small_disk
  watch_statuses
  faulty_start
  pid_of mapper >/dev/null
  sleep "$(calculate "0.3 * ${figure[reference_s]}")"
  fill_disk
}

disk_full_row() {
  fill_disk_in_a_run
  problems_are_said 60
  free_disk
  faulty_wait 1 # a snapshot is missing for good
  unwatch_statuses
  keep_disk
  same_map
}

disk_full_end_row() {
  fill_disk_in_a_run
  must "trio did not say that not all is written" faulty_fails
  unwatch_statuses
  must "half-written files are left" no_partial_files faulty
  free_disk
  problems_are_said
  "$kintsugi_root/scripts/trio" --resume --out faulty >resumed.txt 2>&1 || failures+=("scripts/trio --resume failed")
  keep_disk
  same_map
}
