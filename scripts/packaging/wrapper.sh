#!/bin/sh
# Runs @SCRIPT@ with the installed programs, wherever they have been installed.
bin="$(dirname "$(readlink -f "$0")")"
share="$bin/@SHARE_FROM_BIN@"
KINTSUGI_BIN="${KINTSUGI_BIN:-$bin}" KINTSUGI_TYPES_JAR="${KINTSUGI_TYPES_JAR:-$share/kintsugi_types.jar}"
export KINTSUGI_BIN KINTSUGI_TYPES_JAR
exec "$share/scripts/@SCRIPT@" "$@"
