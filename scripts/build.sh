#!/usr/bin/env bash
# Builds one preset (release unless told otherwise) and nothing else: scripts/build.sh [release|dev|asan|tsan]
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1:-release}
log=$(cmake --preset "$preset" 2>&1) || { echo "$log" >&2; exit 1; }
cmake --build --preset "$preset" --parallel "$(nproc)" -- --quiet
