# The power is cut at a random moment of a run with --durable. A library writes down what each process does to the disk and
# when it syncs it (tests/support/forgetful_disk.cpp); from that follows what a disk may have kept that loses all else.
# KINTSUGI_POWER_CUTS: the number of runs, each with another moment (default 200, with --quick 2).

fault_row power-cut "power cut at a random moment of each run, then scripts/trio --resume" power_cut_row
fault_row power-cut-limit "the same, of a log that is rewritten because of --store-limit" power_cut_limit_row

# forgetful COMMAND...: runs it with the folder `faulty` on such a disk.
forgetful() {
  local root="$KINTSUGI_BIN/../tests"
  env LD_PRELOAD="$(realpath "$root/libforgetful_disk.so")" FORGETFUL_DISK="$PWD/faulty" FORGETFUL_JOURNAL="$PWD/journal" "$@"
}

# cut_power MOMENT SEED: leaves in `faulty` what a power cut does, and nothing else of the run.
cut_power() {
  "$KINTSUGI_BIN/../tests/cut_power" --journal "$PWD/journal" --moment "$1" --seed "$2" --out faulty >cut.json
  rm -f journal.*
}

power_cut_row() {
  choose_scene
  reference
  cut_each_run
}

# Of a log of 8 MB, some of which is rewritten before it has grown to 2 MB.
power_cut_limit_row() {
  scene+=(--device 'synthetic://patrol?sensor=lidar&noise=off&rate=10&speed=3&frames=200' --resolution 0.025 --every 1000000
    --mapper '--session=7')
  reference
  cut_each_run --store-limit 4
}

# cut_each_run [OPTION...]: further options of the runs.
cut_each_run() {
  local num_runs="${KINTSUGI_POWER_CUTS:-200}" run share moment seed_of_cut resumed=0 most_s=0
  if_quick && num_runs="${KINTSUGI_POWER_CUTS:-2}"
  for ((run = 1; run <= num_runs; ++run)); do
    draw_share
    moment="$share" seed_of_cut="$RANDOM"
    rm -rf faulty && mkdir faulty
    forgetful "$kintsugi_root/scripts/trio" --durable --out faulty "${scene[@]}" "$@" >faulty.txt 2>&1 ||
      { failures+=("the run failed: $PWD/faulty.txt"); return; }
    cut_power "$moment" "$seed_of_cut"
    faulty_since="$EPOCHREALTIME"
    if [[ -e faulty/trio.options ]]; then
      resumed=$((resumed + 1))
      "$kintsugi_root/scripts/trio" --resume --out faulty >resumed.txt 2>&1 || failures+=("--resume failed: $PWD/resumed.txt")
    else # it was cut before there was a run
      "$kintsugi_root/scripts/trio" --durable --out faulty "${scene[@]}" "$@" >resumed.txt 2>&1 ||
        failures+=("a run in what is left failed: $PWD/resumed.txt")
    fi
    figure[seconds]="$(since_s "$faulty_since")"
    most_s="$(calculate "$most_s > ${figure[seconds]} ? $most_s : ${figure[seconds]}" 1)"
    same_map
    if ((${#failures[@]})); then
      failures+=("in run $run: at $moment of what it did to the disk, seed $seed_of_cut")
      return
    fi
  done
  figure[seconds]="$most_s"
  note "$num_runs runs, $resumed of them resumed; the time is the longest to the end after a cut"
}
