#!/bin/sh
# Runs @SCRIPT@ with the installed programs.
KINTSUGI_BIN="${KINTSUGI_BIN:-@BIN@}" KINTSUGI_TYPES_JAR="${KINTSUGI_TYPES_JAR:-@SHARE@/kintsugi_types.jar}"
export KINTSUGI_BIN KINTSUGI_TYPES_JAR
exec "@SHARE@/scripts/@SCRIPT@" "$@"
