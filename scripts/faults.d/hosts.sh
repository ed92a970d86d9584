# The mapper on one host, segmenter and viewer on another, connected by a cable that loses frames.

source "$kintsugi_root/scripts/lib/played_run.sh"
source "$kintsugi_root/scripts/lib/two_hosts.sh"

for percent in 0 1 5; do
  fault_row "veth-$percent" "two hosts, MTU 1500, $percent % of frames dropped" veth_row "$percent"
done

veth_row() {
  local percent="$1" host
  choose_played
  played_reference
  two_hosts_begin || skip_row "two networks and a cable are not permitted"
  drop_frames "$percent" || skip_row "nftables are not permitted"
  mapper_at=("${mapper_host[@]}") others_at=("${desk_host[@]}")
  played_run faulty
  figure[lost]=$(($(frames_dropped mapper) + $(frames_dropped desk)))
  ((percent == 0)) || must "nothing was dropped" test "${figure[lost]}" -gt 0
  for host in mapper desk; do
    must "$(ip_count "$host" FragCreates) fragments left the host $host" test "$(ip_count "$host" FragCreates)" -eq 0
  done
  note "$(ip_count mapper OutRequests) datagrams from the mapper's host, none fragmented"
  same_map
}
