#!/usr/bin/env bash
# The power is cut in the middle of runs with --durable: --resume makes the whole map of what is left.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
hold_rows power-cut
