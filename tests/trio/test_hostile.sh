#!/usr/bin/env bash
# Random and damaged messages on every channel do not change the map; they are counted and need no memory.
exec "$(dirname "${BASH_SOURCE[0]}")/../../scripts/faults" --quick hostile
