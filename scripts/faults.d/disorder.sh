# A network that duplicates datagrams and changes their order.

fault_row disorder "20 % of datagrams doubled, 20 % overtaken by later ones, both ways" disorder_row

disorder_row() {
  local link="${player%/*}/faulty_link" far='udpm://239.255.76.67:7668?ttl=1'
  # With a ttl above 0 chunks are smaller, so that there are many.
  export LCM_DEFAULT_URL='udpm://239.255.76.67:7667?ttl=1'
  choose_played
  played_reference
  out="$PWD"
  process_start link "$link" --from "$LCM_DEFAULT_URL" --to "$far" --duplicate 0.2 --reorder 0.2 \
    --held 0.02 --seed "$seed" --report link.json
  others_at=(env LCM_DEFAULT_URL="$far")
  played_run faulty
  process_stop 10 link
  process_wait link || failures+=("faulty_link failed, see link.log")
  must "nothing came twice" test "$(json_number link.json duplicated)" -gt 0
  must "nothing was overtaken" test "$(json_number link.json overtaken)" -gt 0
  note "$(json_totals duplicated) datagrams doubled, $(json_totals overtaken) overtaken, of $(json_totals in)"
  figure[lost]="$(json_totals lost_before)"
  same_map
}

# json_totals NAME: the sum over both directions.
json_totals() { grep -oP "\"$1\": \K\d+" link.json | awk '{ sum += $1 } END { print sum }'; }
