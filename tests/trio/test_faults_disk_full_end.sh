#!/usr/bin/env bash
# The disk is full to the end: that is said and the exit code tells; with space, --resume has everything after all.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
hold_rows disk-full-end
