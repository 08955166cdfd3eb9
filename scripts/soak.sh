#!/usr/bin/env bash
# The fault tests at their full size, one after the other, and the lines that they count: docs/reliability.md.
# Each is in scripts/test.sh's run too, but small. Takes twenty minutes on two cores.
#
#   scripts/soak.sh [ctest options, e.g. -R PowerCut]
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh
scripts/build.sh release
log=build/release/soak.log
ctest --preset release -L soak --verbose "$@" | tee "$log" | grep -E '^ *[0-9]+/[0-9]+ Test|counted: |tests passed|^Total' || true
grep -q '100% tests passed' "$log" || { echo "soak.sh: not all passed; $log says what" >&2; exit 1; }
