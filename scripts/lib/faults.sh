# Sourced by faults: the rows of the table, a run with a fault and one without, their comparison, and the output.
#
# A row is a line in a file of scripts/faults.d,
#     fault_row NAME "WHAT IS DONE" FUNCTION [ARGUMENT...]
# and its FUNCTION. This is called in an empty folder, in a private network and a mount namespace of its own, as root
# (perhaps a mapped one), with $quick 0 or 1 and a seeded RANDOM. It calls the functions below: `reference`, `faulty` and
# the fault; `must` for each condition that has to hold. It may set figure[COLUMN]. The shortest row calls `reference`,
# `faulty` and `same_map`.

source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
source "$(dirname "${BASH_SOURCE[0]}")/processes.sh"

declare -A row_what=() row_call=()
row_names=()
fault_row() {
  row_names+=("$1")
  row_what[$1]="$2"
  row_call[$1]="$(printf '%q ' "${@:3}")"
}
has_row() { [[ -n "${row_call[$1]:-}" ]]; }
list_rows() {
  local name
  for name in "${row_names[@]}"; do printf '%-26s %s\n' "$name" "${row_what[$name]}"; done
}
for group in "$kintsugi_root"/scripts/faults.d/*.sh; do source "$group"; done

# The columns of the table. A row sets figure[COLUMN]; `-` stands for what it did not measure.
columns=(lost requested resent seconds reference_s lag_slices mapper_mb segmenter_mb viewer_mb)
column_titles=("datagrams lost" requested resent "time, s" "without, s" "most slices behind"
  "mapper, MB" "segmenter, MB" "viewer, MB")
declare -A figure=()
notes=() failures=()

table_line() { printf '| %s ' "$@"; printf '|\n'; }
print_header() {
  table_line row fault holds "${column_titles[@]}" notes
  printf '|%s\n' "$(printf -- '---|%.0s' row fault holds "${columns[@]}" notes)"
}

# note TEXT: adds TEXT to the row's last column.
# must TEXT COMMAND...: the row does not hold unless COMMAND succeeds; TEXT says what is wrong then.
note() { notes+=("$*"); }
must() {
  local what="$1"
  shift
  "$@" || failures+=("$what")
}
# skip_row WHY: ends the row, because this machine does not permit it.
skip_row() {
  say "$row_name skipped: $*"
  exit 77
}
joined() { printf '%s' "${1:-}"; (($# < 2)) || printf '; %s' "${@:2}"; }

# print_held OUT NAME: prints the line of a row that holds in OUT. Fails if none does.
print_held() { cat "$1/$2/$(held_line)" 2>/dev/null; }
held_line() { if_quick && echo line.quick.md || echo line.md; }

# run_row OUT NAME: runs a row inside its network, prints its line and adds it to faults.csv; keeps the line if it holds.
# Fails when something does not hold.
run_row() {
  local column cells=() holds=yes line
  runs="$1" row_name="$2"
  export KINTSUGI_PRIVATE_BUS=1
  RANDOM="$seed"
  mkdir -p "$runs"
  rm -rf "${runs:?}/$row_name"
  mkdir "$runs/$row_name"
  cd "$runs/$row_name"
  trap end_faulty EXIT
  eval "${row_call[$row_name]}"
  ((${#failures[@]})) && holds="**no**: $(joined "${failures[@]}")"
  for column in "${columns[@]}"; do cells+=("${figure[$column]:--}"); done
  line="$(table_line "$row_name" "${row_what[$row_name]}" "$holds" "${cells[@]}" "$(joined "${notes[@]}")")"
  printf '%s\n' "$line"
  [[ -e "$runs/faults.csv" ]] || (IFS=,; echo "row,holds,${columns[*]}") >"$runs/faults.csv"
  (IFS=,; echo "$row_name,$((${#failures[@]} == 0)),${cells[*]}") >>"$runs/faults.csv"
  ((${#failures[@]} == 0)) || return
  printf '%s\n' "$line" >"$(held_line)"
}

# What the trio maps in most rows. The session number is fixed, because it is part of the map; every frame is mapped, so
# that two runs give the same slices. With --quick the map is small.
scene=(--replay --no-log)
if_quick() { ((quick)); }
choose_scene() {
  if if_quick; then small_scene; return; fi
  scene+=(--every "${snapshot_every:-1000000}")
  scene+=(--device synthetic://office --resolution 0.006 --volume-size 3.072 --mapper '--session=7 --shift=8')
}
# For rows of many runs, and with --quick.
small_scene() {
  scene+=(--every "${snapshot_every:-1000000}")
  scene+=(--device 'synthetic://office?frames=120' --resolution 0.02 --volume-size 3.2 --mapper '--session=7 --shift=8')
}

now_s() { printf '%s' "$EPOCHREALTIME"; }
since_s() { awk -v a="$1" -v b="$EPOCHREALTIME" 'BEGIN { printf "%.1f", b - a }'; }
calculate() { awk "BEGIN { printf \"%.${2:-2}f\", ($1) }"; }
# draw_share: sets $share to a random number from 0 to 1. Not to be called in $(...), where bash seeds RANDOM anew.
draw_share() {
  share="$RANDOM"
  share="$(calculate "$share / 32768" 4)"
}

# run_to_end NAME OPTION...: runs scripts/trio in the folder NAME; its output is in NAME.txt, the time it took in
# NAME/seconds. Fails if it fails.
run_to_end() {
  local name="$1" start="$EPOCHREALTIME"
  shift
  "$kintsugi_root/scripts/trio" --out "$name" "$@" >"$name.txt" 2>&1 || return
  since_s "$start" >"$name/seconds"
}

# reference [OPTION...]: the run without a fault, of this row's scene and these further options; sets $reference, its
# folder. Rows with the same scene and options share one.
reference() {
  local key
  key="$(printf '%s\n' "$quick" "${LCM_DEFAULT_URL}" "${scene[@]}" "$@" | cksum | cut -d' ' -f1)"
  reference="$runs/reference-$key"
  if [[ ! -e "$reference/seconds" ]]; then
    run_to_end "$reference" "${scene[@]}" "$@" || {
      say "$row_name: the run without a fault failed: $reference.txt"
      tail -n 20 "$reference.txt" >&2
      exit 1
    }
  fi
  figure[reference_s]="$(<"$reference/seconds")"
}

# faulty_start [OPTION...]: starts the run with a fault in the background, in the folder `faulty`.
# faulty_wait [CODE]: waits for its end, which has to be with this exit code (default 0).
# faulty [OPTION...]: both. end_faulty: ends what is left of it.
faulty_start() {
  faulty_since="$EPOCHREALTIME"
  "$kintsugi_root/scripts/trio" --out faulty "${scene[@]}" "$@" >faulty.txt 2>&1 &
  faulty_pid=$!
}
faulty_wait() {
  local code=0
  wait "$faulty_pid" || code=$?
  faulty_pid=""
  figure[seconds]="$(since_s "$faulty_since")"
  ((code == ${1:-0})) || { failures+=("trio ended with exit code $code, see $PWD/faulty.txt"); tail -n 20 faulty.txt >&2; }
  read_figures faulty
}
# faulty_fails: waits for its end; fails unless that was with an error.
faulty_fails() {
  local code=0
  wait "$faulty_pid" || code=$?
  faulty_pid=""
  figure[seconds]="$(since_s "$faulty_since")"
  ((code))
}
faulty() { faulty_start "$@" && faulty_wait; }
end_faulty() {
  [[ -n "${faulty_pid:-}" ]] || return 0
  kill -CONT "$(<faulty/mapper.pid)" "$(<faulty/segmenter.pid)" "$(<faulty/viewer.pid)" 2>/dev/null || true
  kill -TERM "$faulty_pid" 2>/dev/null && wait "$faulty_pid" || true
}

# pid_of NAME: the number of a process of the faulty run; waits at most 20 s for it.
pid_of() {
  local i
  for ((i = 0; i < 200; i++)); do
    [[ -s "faulty/$1.pid" ]] && { cat "faulty/$1.pid"; return; }
    sleep 0.1
  done
  return 1
}

# status_last RUN PROCESS FIELD, status_most ...: the last and the largest value of a field in the statuses of a run; 0 if
# there is none.
status_last() { awk -F, -v p="$2" -v f="$3" '$2 == p && $3 == f { v = $4 } END { print v + 0 }' "$1/status.csv"; }
status_most() {
  awk -F, -v p="$2" -v f="$3" '$2 == p && $3 == f && $4 > v { v = $4 } END { print v + 0 }' "$1/status.csv"
}

# read_figures RUN: sets the figures that scripts/trio printed or the statuses hold.
read_figures() {
  local process
  for process in mapper segmenter viewer; do
    figure[${process}_mb]="$(peak_memory_mb "$1" "$process")"
  done
  [[ -s "$1/status.csv" ]] || return 0
  figure[lag_slices]="$(status_most "$1" segmenter lag_slices)"
  figure[requested]=$(($(status_most "$1" segmenter requests_sent) + $(status_most "$1" viewer requests_sent)))
  figure[resent]=$(($(status_most "$1" mapper chunks_resent) + $(status_most "$1" segmenter chunks_resent)))
}
# peak_memory_mb RUN PROCESS: as scripts/trio printed it; of a run without scripts/trio, the largest value in a status.
peak_memory_mb() {
  if [[ -e "$1.txt" ]]; then
    sed -nE "s/^ *memory at most:.* $2 ([0-9]+) MB.*/\1/p" "$1.txt"
  else
    calculate "$(status_most "$1" "$2" memory_bytes) / 1e6" 0
  fi
}

# same_map [RUN]: the map of the run (default: the faulty one) has to be that of the reference: the same points in the same
# segments, and the same picture. Only the ids of the segments may differ: they depend on the order in which patches came.
same_map() {
  local run="${1:-faulty}"
  must "segments.ply has other points or segments than that of $reference" \
    "$kintsugi_root/scripts/lib/same_partition.py" "$reference/segments.ply" "$run/segments.ply"
  must "map_final.png differs from that of $reference" cmp -s "$reference/map_final.png" "$run/map_final.png"
  must "half-written files are left in $run" no_partial_files "$run"
}
no_partial_files() { ! compgen -G "$1/*.partial*" >/dev/null; }

