#!/usr/bin/env bash
# A segmenter or viewer that starts late receives the whole map; what is sent again is bounded by the size of the map.
exec "$(dirname "${BASH_SOURCE[0]}")/../../scripts/faults" --quick late-segmenter-50 late-viewer-100
