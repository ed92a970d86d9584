#!/usr/bin/env bash
# The disk is full for a while: it is reported, no file is half written, and with space everything is written.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
hold_rows disk-full
