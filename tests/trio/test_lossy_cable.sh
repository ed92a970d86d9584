#!/usr/bin/env bash
# A generated map over a cable between two hosts that loses frames: nothing is fragmented, nothing is missing.
exec "$(dirname "${BASH_SOURCE[0]}")/../../scripts/faults" --quick veth-5
