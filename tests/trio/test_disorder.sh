#!/usr/bin/env bash
# Duplicated and reordered datagrams do not change the map.
exec "$(dirname "${BASH_SOURCE[0]}")/../../scripts/faults" --quick disorder
