# Sourced by trio: the folder $out of a run, so that an earlier run in it is neither overwritten nor written into by two.

# Whatever a run writes; other files in the folder are somebody's own.
run_files=(mapper.lcm 'mapper.*.lcm' segmenter.map run.lcm run.lcm.partial 'segments*.ply' 'segments*.json' final.png
  'map_final*.png' 'segments_final*.png' 'final_*.png' 'snapshot_*.png' run.mp4 trajectory.txt status.csv
  mapper.log segmenter.log viewer.log logger.log trio.options)

# lock_folder: for as long as the script or a process of its run lives; those of one that was killed end soon.
lock_folder() {
  exec {lock_fd}>>"$out/.lock"
  flock --timeout 3 "$lock_fd" && return
  say "another scripts/trio is at work in $out; give this one a folder of its own with --out"
  exit 1
}

# keep_earlier_run: moves the files of a run that is there into earlier/DATE.
keep_earlier_run() {
  local pattern file kept="" found=()
  for pattern in "${run_files[@]}"; do
    while read -r file; do found+=("$file"); done < <(compgen -G "$out/$pattern")
  done
  ((${#found[@]})) || return 0
  kept="$out/earlier/$(date -r "${found[0]}" +%Y%m%d-%H%M%S)"
  while [[ -e "$kept" ]]; do kept+="x"; done
  mkdir -p "$kept"
  mv "${found[@]}" "$kept/"
  say "$out held an earlier run; it is now in $kept"
}

# remember_options OPTION..., recall_options: so that --resume needs nothing but the folder. Relative paths among them
# are of the folder the run was started in.
remember_options() {
  printf '%s\0' "$PWD" "$@" >"$out/trio.options"
}
recall_options() {
  local saved=()
  [[ -s "$out/trio.options" ]] || {
    say "$out holds no run to go on with"
    exit 1
  }
  mapfile -d '' -t saved <"$out/trio.options"
  out="$(realpath "$out")"
  local its_folder="$out"
  cd "${saved[0]}"
  read_options "${saved[@]:1}"
  out="$its_folder"
}
