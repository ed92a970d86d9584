#!/usr/bin/env bash
# A generated map between two hosts whose cable loses frames: no datagram is fragmented, and the map is complete.
exec "$(dirname "${BASH_SOURCE[0]}")/../../scripts/faults" --quick veth-5
