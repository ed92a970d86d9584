#!/usr/bin/env bash
# One datagram in ten is lost, on the receive buffer of a stock machine: the same map and pictures all the same.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
hold_rows loss-10
