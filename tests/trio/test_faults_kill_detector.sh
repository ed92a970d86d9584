#!/usr/bin/env bash
# The detector of objects is killed at a random moment and restarted: it ends with the same detections as without.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
hold_rows kill-detector
