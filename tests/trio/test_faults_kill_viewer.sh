#!/usr/bin/env bash
# The viewer is killed at a random moment and restarted: map and pictures are the same as without.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
hold_rows kill-viewer
