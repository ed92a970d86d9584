# Sourced by bench: running the programs and reading their output. All files are written to the current folder.

source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
programs="$kintsugi_root/build/release/bench"

# table HEADER...: begins a Markdown table; row CELL...: a line of it.
row() { local cell; for cell in "$@"; do printf '| %s ' "$cell"; done; printf '|\n'; }
table() { row "$@"; row "${@//*/---}"; }

# csv_value FILE COLUMN: the value in the first line under the header.
csv_value() {
  awk -F, -v name="$2" 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == name) c = i } NR == 2 && c { print $c }' "$1"
}

# csv_column FILE COLUMN: the values of a column, one a line.
csv_column() {
  awk -F, -v name="$2" 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == name) c = i } NR > 1 && c { print $c }' "$1"
}

# csv_as_table FILE COLUMN...: these columns as a Markdown table.
csv_as_table() {
  local file="$1"
  shift
  table "$@"
  awk -F, -v wanted="$*" 'NR == 1 { n = split(wanted, name, " "); for (i = 1; i <= NF; ++i) column[$i] = i; next }
           { line = "|"; for (i = 1; i <= n; ++i) line = line " " $column[name[i]] " |"; print line }' "$file"
}

# figure_png FILE.gp: draws a figure of kintsugi-evaluate as FILE.png.
figure_png() {
  sed "1s/.*/set terminal pngcairo size 800,340 font 'sans-serif,10' noenhanced/" "$1" | gnuplot >"${1%.gp}.png"
}

# quantile SHARE: quantile of the numbers on standard input.
quantile() {
  sort -g | awk -v share="$1" '{ v[NR] = $1 } END { r = int(share * NR); if (r < share * NR) ++r
                                                    if (r < 1) r = 1; printf "%.1f", v[r] }'
}

# calculate EXPRESSION: its value, with two decimals.
calculate() { awk "BEGIN { printf \"%.2f\", $1 }"; }

# input_device INPUT: the address of a recording's folder, or of a synthetic room by its name.
input_device() { [[ "$1" == */* ]] && echo "folder://$1" || echo "synthetic://$1"; }
input_name() { basename "$1"; }

# true_path INPUT: the file with the camera's true path; for a synthetic room it is written first.
true_path() {
  [[ "$1" == */* ]] && { echo "$1/groundtruth.txt"; return; }
  if [[ ! -e "truth_$1/groundtruth.txt" ]]; then
    "$kintsugi_root/scripts/private_bus" "$KINTSUGI_BIN/kintsugi-mapper" --device "synthetic://$1" --replay --max-frames 1 \
      --ground-truth "truth_$1" >/dev/null 2>&1
  fi
  echo "truth_$1/groundtruth.txt"
}

# map_alone NAME INPUT FLAGS...: runs only the mapper, over every frame; writes NAME.log, NAME.txt (the camera's path) and
# NAME.csv (a line a frame).
map_alone() {
  local name="$1" input="$2"
  shift 2
  "$kintsugi_root/scripts/private_bus" "$KINTSUGI_BIN/kintsugi-mapper" --device "$(input_device "$input")" --replay \
    --output-trajectory "$name.txt" --timings "$name.csv" "${frame_limit[@]}" "$@" >"$name.log" 2>&1 ||
    { tail -n 3 "$name.log" >&2; return 1; }
}

# trio_over NAME INPUT OPTIONS...: runs scripts/trio over an input, in the folder NAME; its output is in NAME.txt.
trio_over() {
  local name="$1" input="$2"
  shift 2
  "$kintsugi_root/scripts/trio" --private --device "$(input_device "$input")" --out "$name" "${frame_limit[@]}" "$@" \
    >"$name.txt" 2>&1 || { tail -n 5 "$name.txt" >&2; return 1; }
}

# google_bench NAME FLAGS...: runs a benchmark program and prints the medians of three repetitions.
google_bench() {
  "$programs/bench_$1" --benchmark_repetitions=3 --benchmark_report_aggregates_only "${@:2}" 2>/dev/null |
    grep -E '^Benchmark|_median'
}
