#!/usr/bin/env bash
# scripts/check_host finds the faults of a machine, and the commands that it prints correct them.
source "$(dirname "${BASH_SOURCE[0]}")/../../scripts/lib/two_hosts.sh"
two_hosts_alone "$@"
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
two_hosts_begin

# check HOST OPTIONS...: runs check_host on HOST, with its output in said.txt and its exit code in $code.
check() {
  code=0
  on_host "$1" "$root/scripts/check_host" --out "$work" "${@:2}" >said.txt 2>&1 || code=$?
}
said() { grep -qE -- "$1" said.txt || fail "not said: $1; but: $(cat said.txt)"; }
expect_fit() { ((code == 0)) || fail "not fit: $(cat said.txt)"; }
expect_unfit() {
  ((code == 1)) || fail "fit, or failed ($code): $(cat said.txt)"
  said "^UNFIT +$1"
}
# cure HOST: runs the printed commands on HOST, without output.
cure() {
  local command
  while read -r command; do on_host "$1" bash -c "${command/#sudo /}" >cured.txt; done < <(grep -oP '^ {9}\K.*' said.txt)
}
# expect_cured HOST OPTIONS...: the printed commands make HOST fit.
expect_cured() { cure "$1"; check "$@"; expect_fit; }
several=(desk --several --peer 10.77.0.1)

check "${several[@]}"
expect_fit
said 'ok +peer: 10.77.0.1 is on the network of cable'

on_host desk ip route del 224.0.0.0/4
check "${several[@]}"
expect_unfit 'route: multicast goes nowhere'
expect_cured "${several[@]}"

on_host desk ip link set cable mtu 1280
check "${several[@]}"
expect_unfit 'interface: the MTU of cable is 1280'
expect_cured "${several[@]}"

on_host desk ip route replace 224.0.0.0/4 dev lo
check desk --several --interface cable
expect_unfit 'route: multicast goes by lo$'
expect_cured desk --several --interface cable

# Packets of the peer arrive by the cable, but the route back to it uses another interface.
on_host desk bash -c 'ip link add other type veth peer name end && ip link set other up && ip link set end up && ip route add 10.77.0.1/32 dev other &&
  echo 1 >/proc/sys/net/ipv4/conf/cable/rp_filter'
check "${several[@]}"
expect_unfit 'peer: the way to 10.77.0.1 goes by other,'
expect_cured "${several[@]}"
on_host desk bash -c 'ip route del 10.77.0.1/32; ip route add 10.9.0.0/16 via 10.77.0.1'
check desk --several --peer 10.9.0.7
expect_unfit 'peer: 10.9.0.7 is behind the router 10.77.0.1'

on_host desk nft -f - <<'NFT'
table inet filter {
  chain input {
    type filter hook input priority 0; policy drop;
    ct state established,related accept
    tcp dport 22 accept
  }
}
NFT
check "${several[@]}"
expect_unfit 'firewall: inet filter input: drops what no rule accepts'
expect_cured "${several[@]}"
on_host desk nft -f - <<'NFT'
flush ruleset
table ip guard { chain in { type filter hook input priority 0; udp dport { 5353, 7667 } drop; }; }
NFT
check "${several[@]}"
expect_unfit 'firewall: ip guard in: udp dport .* drop'
on_host desk nft flush ruleset

# A bus elsewhere, which is closed while LCM's own is open.
on_host desk nft -f - <<'NFT'
table inet filter { chain input { type filter hook input priority 0; policy drop; udp dport 7667 accept; }; }
NFT
two_hosts_url="udpm://239.255.1.2:7700?ttl=1" check "${several[@]}"
expect_unfit 'firewall: inet filter input: drops what no rule accepts'
on_host desk nft flush ruleset

# A single machine whose loopback interface is down.
on_host mapper ip link set cable down
on_host mapper ip link set lo down
check mapper --alone
expect_unfit 'route: none for multicast'
LCM_DEFAULT_URL="" two_hosts_url="" expect_cured mapper --alone
said 'ok +hearing: this machine hears itself'

# And one without any interface to other hosts.
code=0
unshare --net "$root/scripts/check_host" --several --peer 10.77.0.1 --out "$work" >said.txt 2>&1 || code=$?
expect_unfit 'interface: there is none'
said '^This machine is not fit yet'

check mapper --nonsense
((code == 2)) || fail "an unknown option was accepted"
check mapper --alone --peer 10.77.0.1
((code == 2)) || fail "--peer was accepted without --several"
