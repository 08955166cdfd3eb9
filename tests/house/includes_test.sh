#!/usr/bin/env bash
# The house's one way (docs/build.md): noise <- sim <- sim/app -> sim/dataset <- restore/app -> restore, and both programs
# -> cli. Nothing else.
# Each rule: the files of a room, and the rooms that they may not include.
set -u
cd "${1:?root of the source tree}"
failures=0

forbid() {  # forbid "what" FORBIDDEN-REGEX FILES...
  local what=$1 regex=$2
  shift 2
  local found
  found=$(grep -nE "#include \"($regex)" "$@" 2>/dev/null) || return 0
  echo "$what:"
  echo "$found"
  failures=1
}

files_of() { find "$@" -name '*.h' -o -name '*.cpp' 2>/dev/null; }
sim_alone() { find sim \( -path sim/app -o -path sim/dataset \) -prune -o \( -name '*.h' -o -name '*.cpp' \) -print; }

mapfile -t cli < <(files_of cli)
mapfile -t noise < <(files_of noise)
mapfile -t sim < <(sim_alone)
mapfile -t dataset < <(files_of sim/dataset)
mapfile -t sim_app < <(files_of sim/app)
[ ${#cli[@]} -gt 5 ] && [ ${#noise[@]} -gt 5 ] && [ ${#sim[@]} -gt 5 ] && [ ${#dataset[@]} -gt 5 ] && [ ${#sim_app[@]} -gt 5 ] || { echo "rooms are missing"; exit 1; }

forbid "cli knows no other room" 'noise/|sim/|restore/' "${cli[@]}"
forbid "noise knows no other room" 'cli/|sim/|restore/' "${noise[@]}"
# (a lock is no thread: what many threads may ask of one object is guarded there)
grep -nE '#include <(opencv|nlohmann|tbb|thread|OpenImageIO)' "${noise[@]}" && { echo "noise knows no image, no JSON, no thread"; failures=1; }
forbid "sim knows neither files nor programs" 'cli/|sim/app/|sim/dataset/|restore/' "${sim[@]}"
grep -nE '#include <(nlohmann|OpenImageIO|fstream|filesystem)' "${sim[@]}" && { echo "sim reads and writes nothing"; failures=1; }
forbid "sim/dataset knows no noise and no scene" 'cli/|noise/|restore/|sim/[a-z_]+\.h|sim/drawn/|sim/app/' "${dataset[@]}"
forbid "sim/app goes through sim" 'noise/|restore/' "${sim_app[@]}"
if [ -d restore ]; then
  mapfile -t restore < <(find restore -path restore/app -prune -o \( -name '*.h' -o -name '*.cpp' \) -print)
  forbid "restore knows no other room, and not its program" 'cli/|sim/|noise/|restore/app/' "${restore[@]}"
  mapfile -t restore_app < <(files_of restore/app)
  forbid "restore/app reads clips through sim/dataset alone" 'noise/|sim/[a-z_]+\.h|sim/drawn/|sim/app/' "${restore_app[@]}"
fi
# The plan alone spends the accuracy budget: kernels contain no test on it.
grep -lnE 'max_error_(px|levels)' "${noise[@]}" "${sim[@]}" | grep -vE '^sim/(plan\.(h|cpp)|scene\.h)$' && { echo "the accuracy knob is read outside sim/plan"; failures=1; }
exit $failures
