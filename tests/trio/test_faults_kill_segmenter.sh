#!/usr/bin/env bash
# The segmenter is killed at a random moment and restarted: map and pictures are the same as without.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
hold_rows kill-segmenter
