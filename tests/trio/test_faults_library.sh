#!/usr/bin/env bash
# Damaged, foreign and half-written objects of a library are named, and the others are found.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
hold_rows library
