#!/usr/bin/env bash
# Sets up, builds and runs every test that this machine can, but for the long ones (scripts/soak.sh).
#
#   scripts/test.sh [ctest options, e.g. -R noise]
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh
scripts/build.sh release
exec ctest --preset release --parallel "$(nproc)" -LE soak "$@"
