#!/usr/bin/env bash
# A second run of setup.sh installs nothing and says nothing; an unknown option is refused with one line and exit code 2.
set -u
cd "${1:?root of the source tree}"
scripts/setup.sh >/dev/null || { echo "setup.sh fails"; exit 1; }
output=$(scripts/setup.sh) || exit 1
[ -z "$output" ] || { echo "a second run does something: $output"; exit 1; }
scripts/setup.sh --nonsense 2>/tmp/shimmer-setup.$$
code=$?
lines=$(wc -l </tmp/shimmer-setup.$$)
rm -f /tmp/shimmer-setup.$$
[ $code -eq 2 ] && [ "$lines" -eq 1 ] || { echo "an unknown option gives exit code $code and $lines lines"; exit 1; }
for script in scripts/*.sh scripts/slurm/* .ci/run; do bash -n "$script" || exit 1; done
