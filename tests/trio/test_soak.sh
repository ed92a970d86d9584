#!/usr/bin/env bash
# At a multiple of the normal rate no slice is lost, and at the end none waits. Whether memory stays flat takes longer to tell:
# scripts/faults soak.
exec "$(dirname "${BASH_SOURCE[0]}")/../../scripts/faults" --quick soak
