#!/usr/bin/env bash
# Each of the three stands still for half a second: the same map and pictures all the same.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
hold_rows stop-segmenter-0.5 stop-viewer-0.5 stop-mapper-0.5
