#!/usr/bin/env bash
# One datagram in ten is lost, with the default receive buffer of Linux: map and pictures are the same as without.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
hold_rows loss-10
