#!/usr/bin/env bash
# The segmenter is killed at random moments and started again: the same map and pictures all the same.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
hold_rows kill-segmenter
