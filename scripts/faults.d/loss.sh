# Datagrams are dropped on loopback, with the default receive buffer of Linux.

for percent in 0 1 5 10; do
  fault_row "loss-$percent" "$percent % of datagrams dropped on loopback, stock receive buffer" loss_row "$percent"
done

# drop_datagrams PERCENT: from now on so many of the datagrams on the bus are dropped, for all receivers alike;
# sent_and_lost_datagrams counts all and the dropped ones.
drop_datagrams() {
  command -v nft >/dev/null || skip_row "nftables is not installed"
  nft -f - <<NFT || skip_row "nftables are not permitted"
table ip kintsugi {
  chain lossy {
    type filter hook prerouting priority -450;
    ip daddr 239.255.76.67 counter
    ip daddr 239.255.76.67 numgen random mod 100 < $1 counter drop
  }
}
NFT
}
sent_and_lost_datagrams() { nft list table ip kintsugi | grep -oP 'counter packets \K\d+' | xargs; }

loss_row() {
  local percent="$1" ttl=0 sent
  # With a ttl above 0 chunks are smaller, so that a small map has enough of them for some to be lost.
  if_quick && ttl=1
  export LCM_DEFAULT_URL="udpm://239.255.76.67:7667?ttl=$ttl&recv_buf_size=212992"
  choose_scene
  reference
  drop_datagrams "$percent"
  faulty
  read -r sent "figure[lost]" < <(sent_and_lost_datagrams)
  note "of $sent datagrams"
  same_map
  ((percent == 0)) || must "nothing was dropped" test "${figure[lost]}" -gt 0
}
