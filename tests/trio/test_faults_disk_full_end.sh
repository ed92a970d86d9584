#!/usr/bin/env bash
# The disk is full until the end: it is reported, the exit code is not 0, and with space --resume writes everything.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
hold_rows disk-full-end
