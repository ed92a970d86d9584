#!/usr/bin/env bash
# While corrections move the whole map, one datagram in ten is lost, and segmenter, viewer and mapper are killed before a
# correction is acknowledged, and started again; or the segmenter starts right after one: map and pictures are the same as
# without.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
hold_rows correction-kill-loss-10 correction-late-segmenter
