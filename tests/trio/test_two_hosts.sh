#!/usr/bin/env bash
# The mapper on one host, segmenter and viewer on another, and a cable that loses 5 % of the frames: map and pictures are
# the same as on one host, and no datagram is fragmented.
source "$(dirname "${BASH_SOURCE[0]}")/../../scripts/lib/two_hosts.sh"
two_hosts_alone "$@"
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

run_trio "${small_room[@]}" --replay --no-log --out one

scene=("${small_room[@]/--private/--no-log}")
two_hosts_begin
drop_frames 5
"${desk_host[@]}" "$root/scripts/trio" --only segmenter,viewer --every 2 --no-log --out desk >desk.txt 2>&1 &
desk=$!
"${mapper_host[@]}" "$root/scripts/trio" --only mapper "${scene[@]}" --replay --out mapper >mapper.txt 2>&1 &
mapper=$!
wait "$desk" || fail "the segmenter and the viewer on their host: $(cat desk.txt)"
kill -TERM "$mapper"
wait "$mapper" || fail "the mapper on its host: $(cat mapper.txt)"

expect_same_partition one/segments.ply desk/segments.ply
expect_same one/map_final.png desk/map_final.png
for host in mapper desk; do
  (($(ip_count "$host" FragCreates) == 0)) || fail "$(ip_count "$host" FragCreates) fragments left the host $host"
done
(($(frames_dropped mapper) + $(frames_dropped desk) > 0)) || fail "the cable lost nothing"
