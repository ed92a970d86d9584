# The disk of the run is full: the mapper's log, the segmenter's saved map and the viewer's snapshots cannot be written.

fault_row disk-full "disk full in the middle of a run, until all three have said so" disk_full_row
fault_row disk-full-end "disk full from the middle of a run on; then space, and scripts/trio --resume" disk_full_end_row

# small_disk: mounts a disk of 256 MB, twice what a run writes, at the folder `faulty`. keep_disk copies its files to the folder `kept`.
small_disk() {
  mkdir faulty
  mount -t tmpfs -o size=256m kintsugi-faults faulty 2>/dev/null || skip_row "mounting a tmpfs is not permitted"
}
keep_disk() { cp -r faulty kept; }

# fill_disk: keeps the disk full until free_disk; space that others free is taken at once.
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

# watch_statuses: records the statuses in a file that is not on the small disk.
watch_statuses() {
  "$KINTSUGI_BIN/kintsugi-status" --log statuses.csv >/dev/null 2>&1 &
  watcher=$!
}
unwatch_statuses() { kill "$watcher" && wait "$watcher" || true; }

# said_problem PROCESS FIELD: whether a status of the process named the full disk.
said_problem() { grep -qE "^[0-9]+,$1,$2,.*No space" statuses.csv; }

# problems_are_said [SECONDS]: all three statuses have to name the full disk, within so many seconds (default 0).
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

# fill_disk_in_a_run: starts the run with many snapshots and a saved map at each slice, so that all writers meet the full disk,
# and fills the disk after a third of the time that the reference took.
fill_disk_in_a_run() {
  local snapshot_every=0.1
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
