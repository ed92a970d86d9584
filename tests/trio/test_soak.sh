#!/usr/bin/env bash
# At a multiple of the normal rate, memory does not grow beyond that of the map, and at the end no slice waits.
exec "$(dirname "${BASH_SOURCE[0]}")/../../scripts/faults" --quick soak
