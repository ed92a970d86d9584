# Sourced by what runs the trio on two hosts: two networks joined by one cable (a veth pair, MTU 1500), which are gone
# with the script, however it ends. Root is not needed where user namespaces are allowed.
#
#   two_hosts_alone "$@"        first of all: the script again, in a network of its own; ends with 77 where none is allowed
#   two_hosts_begin             the hosts `mapper` and `desk`, with addresses and multicast routes
#   on_host NAME COMMAND...     runs a command there, with the bus of both
#   mapper_host, desk_host      arrays, what to put before a command that shall run there: a process in the background
#   drop_frames PERCENT         from now on each host loses so many of the frames that come over the cable
#   frames_dropped NAME         how many that were
#   ip_count NAME COUNTER       of /proc/net/snmp: FragCreates, ReasmReqds, OutRequests...

two_hosts_url='udpm://239.255.76.67:7667?ttl=1'
declare -A two_hosts_pid=() two_hosts_address=([mapper]=10.77.0.1 [desk]=10.77.0.2)

two_hosts_alone() {
  [[ -n "${KINTSUGI_TWO_HOSTS:-}" ]] && return
  local network=(unshare --net)
  ((EUID == 0)) || network=(unshare --map-root-user --net)
  "${network[@]}" true 2>/dev/null || {
    echo "skipped: no network namespaces on this machine"
    exit 77
  }
  KINTSUGI_TWO_HOSTS=1 exec "${network[@]}" "$0" "$@"
}

# A network lives as long as a process is in it. That process ends with the script, even one that is killed.
two_hosts_begin() {
  local name
  for name in mapper desk; do
    setpriv --pdeathsig KILL unshare --net sleep infinity &
    two_hosts_pid[$name]=$!
    while [[ "$(readlink "/proc/$!/ns/net")" == "$(readlink /proc/self/ns/net)" ]]; do sleep 0.01; done
  done
  ip link add cable netns "${two_hosts_pid[mapper]}" type veth peer name cable netns "${two_hosts_pid[desk]}"
  mapper_host=(nsenter --net="/proc/${two_hosts_pid[mapper]}/ns/net" env LCM_DEFAULT_URL="$two_hosts_url")
  desk_host=(nsenter --net="/proc/${two_hosts_pid[desk]}/ns/net" env LCM_DEFAULT_URL="$two_hosts_url")
  for name in mapper desk; do
    on_host "$name" bash -ec "
      ip link set lo up
      ip address add ${two_hosts_address[$name]}/24 dev cable
      ip link set cable mtu 1500 up
      ip route add 224.0.0.0/4 dev cable"
  done
}

on_host() {
  LCM_DEFAULT_URL="$two_hosts_url" nsenter --net="/proc/${two_hosts_pid[$1]}/ns/net" "${@:2}"
}

# Before fragments are put together (priority -450), as a cable would lose them; what a host says to itself is not lost.
drop_frames() {
  local name
  for name in mapper desk; do
    on_host "$name" nft -f - <<NFT
table ip loss
delete table ip loss
table ip loss {
  chain input {
    type filter hook prerouting priority -450;
    ip saddr ${two_hosts_address[$name]} accept
    numgen random mod 1000 < $(awk "BEGIN { print int(10 * $1) }") counter drop
  }
}
NFT
  done
}

frames_dropped() { on_host "$1" nft list table ip loss | grep -oP 'counter packets \K\d+'; }

ip_count() {
  on_host "$1" awk -v name="$2" '
    $1 == "Ip:" && !c { for (i = 2; i <= NF; ++i) if ($i == name) c = i; next }
    $1 == "Ip:" { print $c }' /proc/net/snmp
}
