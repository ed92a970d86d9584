#!/usr/bin/env bash
# Doubled and overtaken datagrams change nothing.
exec "$(dirname "${BASH_SOURCE[0]}")/../../scripts/faults" --quick disorder
