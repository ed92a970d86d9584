#!/usr/bin/env bash
# Who knows everything but the key of a bus does not change the map; without a key it does, but ends no process.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
hold_rows forged forged-keyless
