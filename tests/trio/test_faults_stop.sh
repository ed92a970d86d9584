#!/usr/bin/env bash
# Each of the three processes is stopped for half a second: map and pictures are the same as without.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
hold_rows stop-segmenter-0.5 stop-viewer-0.5 stop-mapper-0.5
