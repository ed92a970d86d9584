#!/usr/bin/env bash
# Random and damaged messages do not change what a detector of objects finds, and its clients tell of them.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
hold_rows hostile-objects
