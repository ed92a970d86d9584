#!/usr/bin/env bash
# At a multiple of the normal rate memory stays that of the map, and nothing waits in the end.
exec "$(dirname "${BASH_SOURCE[0]}")/../../scripts/faults" --quick soak
