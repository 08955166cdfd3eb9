#!/usr/bin/env bash
# Evaluates the restoration from nothing: builds, generates the evaluation sets, restores their clips in every way, and
# writes a report for each set. Killed, it goes on where it stopped. Hours on two cores (docs/evaluation.md).
#
#   scripts/reproduce.sh [FOLDER] [options of unshimmer evaluate, e.g. --jobs 2]     default: build/evaluation
#
# SHIMMER_TRUTH=FOLDER: others' sets with truth, ndir_cactus and dynamic_pairs, where you have them.
# SHIMMER_REAL="A B ...": real videos.
set -euo pipefail
cd "$(dirname "$0")/.."
folder=${1:-build/evaluation}
[ $# -eq 0 ] || shift
scripts/setup.sh --photos
scripts/build.sh release
programs=build/release/bin
mkdir -p "$folder"
for kind in dynamic static; do
  "$programs/shimmer" generate "configs/eval_$kind.json" --out "$folder/$kind"
  "$programs/unshimmer" evaluate "$folder/$kind" --out "$folder/report_$kind" --ablations --baselines "$@"
done
for set in ndir_cactus dynamic_pairs; do
  [ -d "${SHIMMER_TRUTH:-}/$set" ] || continue
  "$programs/unshimmer" evaluate "$SHIMMER_TRUTH/$set" --adapter "configs/adapters/$set.json" \
    --out "$folder/report_$set" --baselines "$@"
done
if [ -n "${SHIMMER_REAL:-}" ]; then
  # shellcheck disable=SC2086  # paths, one word each
  "$programs/unshimmer" evaluate --real $SHIMMER_REAL --out "$folder/report_real" "$@"
fi
echo "Look at $folder/report_*/report.html"
