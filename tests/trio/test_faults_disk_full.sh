#!/usr/bin/env bash
# The disk is full for a while: that is said, nothing is written by half, and with space everything is there.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
hold_rows disk-full
