# Sourced by check_host: the checks, for $mode (alone or several), $interface, $peer and $out. Each prints a line.

source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

# Where the bus is: of LCM_DEFAULT_URL, or LCM's own.
[[ "${LCM_DEFAULT_URL:-}" =~ ^udpm://([0-9.]+):([0-9]+) ]] && group="${BASH_REMATCH[1]}" port="${BASH_REMATCH[2]}" ||
  group=239.255.76.67 port=7667
# Ethernet's MTU, into which every datagram fits that leaves the host.
ethernet_mtu=1500
receive_buffer=4194304
unfit=0

fine() { printf 'ok     %s\n' "$*"; }
# note WHAT [COMMAND...], unfit WHAT [COMMAND...]: with the commands that correct it.
note() { printf 'note   %s\n' "$1"; cures "${@:2}"; }
unfit() { printf 'UNFIT  %s\n' "$1"; cures "${@:2}"; unfit=1; }
cures() { (($#)) && printf '         %s\n' "$@" || true; }
conclude() {
  if ((unfit)); then
    echo "This machine is not fit yet: the indented commands cure that until the next start."
  else
    echo "This machine is fit to run the trio $([[ "$mode" == alone ]] && echo alone || echo "with other hosts")."
  fi
  return "$unfit"
}

# route_word ADDRESS WORD: the word after WORD in the output of `ip route get ADDRESS`.
route_word() { ip -4 route get "$1" 2>/dev/null | grep -oP "(^| )$2 \K\S+" || true; }

link_of() { ip -o link show dev "$1" 2>/dev/null || true; }
is_up() { [[ "$(link_of "$1")" =~ [\<,]UP[,\>] ]]; }

# Where the other hosts are likely to be: the default route, or the first interface with an address.
likely_interface() {
  local name
  name="$(ip -4 route show default 2>/dev/null | grep -m1 -oP 'dev \K\S+' || true)"
  [[ -n "$name" ]] || name="$(ip -4 -o address show up 2>/dev/null | awk '$2 != "lo" { print $2; exit }')"
  printf '%s' "${name:-eth0}"
}

check_url() {
  local url="${LCM_DEFAULT_URL:-}" wanted="udpm://$group:$port?ttl=1"
  case "$mode" in
    alone)
      [[ "$url" =~ ttl=[1-9] ]] && note "LCM_DEFAULT_URL is $url: other hosts hear this one" "unset LCM_DEFAULT_URL" ||
        fine "bus: what is said stays on this machine" ;;
    several)
      [[ "$url" =~ ttl=[1-9] ]] && fine "bus: $url" ||
        unfit "bus: LCM_DEFAULT_URL is '$url', other hosts will not hear this one" "export LCM_DEFAULT_URL='$wanted'" ;;
  esac
}

# Sets $interface where it is not given. LCM joins the group, and sends, where the route for it goes.
check_route() {
  local device
  device="$(route_word "$group" dev)"
  if [[ "$mode" == alone ]]; then
    if [[ -z "$device" ]]; then
      unfit "route: none for multicast" "sudo ip link set lo up" "sudo ip route add 224.0.0.0/4 dev lo"
    elif ! is_up "$device"; then
      unfit "route: multicast goes by $device, which is down" "sudo ip link set lo up" \
        "sudo ip route replace 224.0.0.0/4 dev lo"
    else
      fine "route: multicast goes by $device"
    fi
    return
  fi
  [[ -n "$interface" ]] || interface="$([[ -n "$device" && "$device" != lo ]] && echo "$device" || likely_interface)"
  [[ "$device" == "$interface" ]] && fine "route: multicast goes by $interface" ||
    unfit "route: multicast goes ${device:+by }${device:-nowhere}" \
      "sudo ip route replace 224.0.0.0/4 dev $interface"
}

check_interface() {
  local mtu
  [[ -n "$(link_of "$interface")" ]] || { unfit "interface: there is none to other hosts; name it with --interface"; return; }
  is_up "$interface" || { unfit "interface: $interface is down" "sudo ip link set dev $interface up"; return; }
  [[ "$(link_of "$interface")" == *MULTICAST* ]] || unfit "interface: $interface takes no multicast" \
    "sudo ip link set dev $interface multicast on"
  [[ -n "$(ip -4 -o address show dev "$interface")" ]] || unfit "interface: $interface has no IPv4 address"
  mtu="$(link_of "$interface" | grep -oP ' mtu \K\d+')"
  ((mtu >= ethernet_mtu)) && fine "interface: $interface is up, MTU $mtu" ||
    unfit "interface: the MTU of $interface is $mtu: datagrams are cut up, and one lost piece loses them" \
      "sudo ip link set dev $interface mtu $ethernet_mtu"
  grep -q "^ *$interface:" /proc/net/wireless 2>/dev/null && note "interface: $interface is a radio, which sends \
multicast at its lowest speed and does not repeat what is lost: use a cable, or --rate 0.5" || true
}

# With strict reverse path filtering (rp_filter 1) the kernel drops a packet unless the route back to its sender goes by the
# interface on which it came.
check_peer() {
  local device gateway strict
  [[ "$mode" == several ]] || return 0
  strict="$({ cat "/proc/sys/net/ipv4/conf/"{all,"$interface"}/rp_filter 2>/dev/null || true; } | sort -n | tail -n 1)"
  if [[ -z "$peer" ]]; then
    note "peer: not checked; --peer ADDRESS checks the way to one of the other hosts"
    return
  fi
  device="$(route_word "$peer" dev)" gateway="$(route_word "$peer" via)"
  if [[ -n "$gateway" ]]; then
    unfit "peer: $peer is behind the router $gateway, which does not pass multicast on: put both on one network"
  elif [[ "$device" == "$interface" ]]; then
    fine "peer: $peer is on the network of $interface"
  elif [[ "$strict" == 1 ]]; then
    unfit "peer: the way to $peer goes by $device, so what it says on $interface is dropped" \
      "sudo sysctl -w net.ipv4.conf.all.rp_filter=2 net.ipv4.conf.$interface.rp_filter=2"
  else
    note "peer: the way to $peer goes ${device:+by }${device:-nowhere}, not by $interface"
  fi
}

# firewall_faults: the rules on standard input (nft list ruleset) that keep messages of the bus out, a line each.
firewall_faults() {
  awk -v port="$port" -v group="${group//./\\\\.}" -v mode="$mode" -v interface="$interface" '
    /^table /   { table = $2 " " $3 }
    /^\tchain / { chain = $2; hooked = 0 }
    /hook (input|prerouting|ingress)/ { hooked = 1; if (/policy drop/) closed[table " " chain] = 1 }
    function on_bus() {
      return $0 ~ "dport [^}]*" port || $0 ~ "daddr (\\{ )?(" group "|224\\.0\\.0\\.0/4)" || /pkttype multicast/
    }
    function on_interface() {
      return mode == "alone" ? /iif(name)? "?lo"? / : interface != "" && $0 ~ "iif(name)? \"?" interface "\"? accept"
    }
    / accept/ && (on_bus() || on_interface()) { open = 1 }
    hooked && / (drop|reject)/ && !/hook/ && on_bus() { print table " " chain ": " $0 }
    END { if (!open) for (name in closed) print name ": drops what no rule accepts" }' | sed 's/\t//g'
}

check_firewall() {
  local rules faults
  if ! rules="$(nft list ruleset 2>/dev/null)"; then
    note "firewall: its rules cannot be read here; as root this checks them" "sudo $0 --$mode"
    return
  fi
  faults="$(firewall_faults <<<"$rules")"
  [[ -n "$faults" ]] || { fine "firewall: nothing drops UDP to port $port"; return; }
  while read -r fault; do
    unfit "firewall: $fault" "sudo nft insert rule ${fault%%:*} udp dport $port accept" \
      "sudo nft insert rule ${fault%%:*} ip protocol igmp accept"
  done <<<"$faults"
}

# This machine has to receive its own messages: LCM's own programs send one on a channel of its own.
check_hearing() {
  local folder logger i url="${LCM_DEFAULT_URL:-udpm://$group:$port?ttl=0}"
  ((unfit)) && return
  command -v lcm-logger >/dev/null && command -v lcm-logplayer >/dev/null || {
    note "hearing: not tried, for LCM's programs are not installed" "scripts/build"
    return
  }
  folder="$(mktemp -d)"
  # Magic, number and time (0), sizes of channel and data, channel, data.
  printf '\xED\xA1\xDA\x01\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x0E\0\0\0\x04KINTSUGI_CHECKhear' >"$folder/said"
  setpriv --pdeathsig KILL lcm-logger -q --lcm-url="$url" "$folder/heard" >/dev/null 2>&1 &
  logger=$!
  for ((i = 0; i < 10; i++)); do
    sleep 0.2
    timeout 10 lcm-logplayer -l "$url" "$folder/said" >/dev/null 2>&1 || true
    [[ -s "$folder/heard" ]] && break
  done
  kill "$logger" 2>/dev/null && wait "$logger" 2>/dev/null || true
  [[ -s "$folder/heard" ]] && fine "hearing: this machine hears itself on $url" ||
    unfit "hearing: this machine does not hear itself on $url"
  rm -rf "$folder"
}

check_receive_buffer() {
  local bytes
  bytes="$(cat /proc/sys/net/core/rmem_max 2>/dev/null || echo 0)"
  ((bytes >= receive_buffer)) && fine "receive buffer: up to $bytes bytes" ||
    note "receive buffer: $bytes bytes at most; bursts will be lost, and sent again" \
      "sudo sysctl -w net.core.rmem_max=$receive_buffer"
}

# The log of a run with a camera grows by 0.3 MB a second.
check_disk() {
  local folder="$out" free_MB
  while [[ ! -d "$folder" ]]; do folder="$(dirname "$folder")"; done
  free_MB="$(df -Pm "$folder" | awk 'NR == 2 { print $4 }')"
  [[ -w "$folder" ]] || { unfit "disk: $folder cannot be written to"; return; }
  if ((free_MB < 100)); then unfit "disk: $free_MB MB free in $folder"
  elif ((free_MB < 2000)); then note "disk: $free_MB MB free in $folder; an hour of mapping takes about 1,000"
  else fine "disk: $free_MB MB free in $folder"
  fi
}

check_processors() {
  local number memory_MB
  number="$(nproc)"
  memory_MB="$(awk '/^MemAvailable/ { print int($2 / 1024) }' /proc/meminfo)"
  ((number >= 2)) && fine "processors: $number, $memory_MB MB of memory free" ||
    note "processors: one; mapper, segmenter and viewer will wait for each other"
  ((memory_MB >= 2000)) || note "memory: $memory_MB MB free; a map of four million points takes about 1,500"
}
