# The power is cut at random moments of runs with --durable. A library writes down what each process does to the disk and
# when it syncs it (tests/support/forgetful_disk.cpp); from that follows, for any moment, what a disk may have kept that loses
# all else.
# KINTSUGI_POWER_CUTS: the number of cuts (default 200, with --quick 2).

fault_row power-cut "power cut at random moments of a run, then scripts/trio --resume" power_cut_row
fault_row power-cut-limit "the same, of a log that is rewritten because of --store-limit" power_cut_limit_row

# forgetful COMMAND...: runs it with the folder `faulty` on such a disk.
forgetful() {
  local root="$KINTSUGI_BIN/../tests"
  env LD_PRELOAD="$(realpath "$root/libforgetful_disk.so")" FORGETFUL_DISK="$PWD/faulty" FORGETFUL_JOURNAL="$PWD/journal" "$@"
}

# cut_power MOMENT SEED: leaves in `faulty` what a power cut does at that moment of the last forgetful run, and nothing else.
cut_power() {
  "$KINTSUGI_BIN/../tests/cut_power" --journal "$PWD/journal" --moment "$1" --seed "$2" --out faulty >cut.json
}

# So many cuts of one run: what was done to the disk before a cut does not depend on what comes after it.
cuts_of_a_run=8

# A small map, because everything after a cut is mapped again.
power_cut_row() {
  small_scene
  reference
  cut_runs
}

# Of a log of 8 MB, some of which is rewritten before it has grown to 2 MB.
power_cut_limit_row() {
  scene+=(--device 'synthetic://patrol?sensor=lidar&noise=off&rate=10&speed=3&frames=200' --resolution 0.025 --every 1000000
    --mapper '--session=7')
  reference
  cut_runs --store-limit 4
}

# cut_runs [OPTION...]: further options of the runs.
cut_runs() {
  local num_cuts="${KINTSUGI_POWER_CUTS:-200}" cut moment seed_of_cut resumed=0 most_s=0
  if_quick && num_cuts="${KINTSUGI_POWER_CUTS:-2}"
  for ((cut = 0; cut < num_cuts; ++cut)); do
    if ((cut % cuts_of_a_run == 0)); then
      rm -rf faulty journal.* && mkdir faulty
      forgetful "$kintsugi_root/scripts/trio" --durable --out faulty "${scene[@]}" "$@" >faulty.txt 2>&1 ||
        { failures+=("the run failed: $PWD/faulty.txt"); return; }
    fi
    draw_share
    moment="$share" seed_of_cut="$RANDOM"
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
      failures+=("after cut $((cut + 1)): at $moment of what the run did to the disk, seed $seed_of_cut")
      return
    fi
  done
  rm -f journal.*
  figure[seconds]="$most_s"
  note "$num_cuts cuts, $resumed of the runs resumed; the time is the longest to the end after a cut"
}
