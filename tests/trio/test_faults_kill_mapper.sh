#!/usr/bin/env bash
# The mapper is killed at random moments and started again: the same map and pictures all the same.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
hold_rows kill-mapper
