#!/usr/bin/env bash
# The stress suite under the sanitizers, five minutes on two cores: AddressSanitizer and
# UndefinedBehaviorSanitizer over all of it, ThreadSanitizer over clips that many threads render.
set -euo pipefail
cd "$(dirname "$0")/.."
for preset in asan tsan; do
  cmake --preset "$preset" >/dev/null
  cmake --build --preset "$preset" --parallel "$(nproc)" --target test_stress -- --quiet
done
UBSAN_OPTIONS=print_stacktrace=1 ctest --preset asan --parallel "$(nproc)" -L stress
ctest --preset tsan -R 'ThreadsStress'
