#!/usr/bin/env bash
# Who starts late gets everything, at a cost bounded by the map.
exec "$(dirname "${BASH_SOURCE[0]}")/../../scripts/faults" --quick late-segmenter-50 late-viewer-100
