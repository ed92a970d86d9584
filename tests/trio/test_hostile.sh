#!/usr/bin/env bash
# Random and mutated messages on every channel change nothing, are counted, and cost no memory.
exec "$(dirname "${BASH_SOURCE[0]}")/../../scripts/faults" --quick hostile
