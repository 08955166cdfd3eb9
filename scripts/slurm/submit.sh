#!/usr/bin/env bash
# Makes a data set on a Slurm cluster: an array job generates its shards, and a job after it merges and verifies them.
# The same command again, after whatever went wrong, goes on with what is missing. docs/cluster.md says more.
#
#   scripts/slurm/submit.sh CONFIG OUT --shards N [options] [-- options of sbatch, for both jobs]
#     --shards N          tasks of the array, a shard each: minutes to hours of work
#     --at-once K         at most K of them at the same time
#     --cpus C            processors, and threads, of each job (1)
#     --mem M             memory of each job, 4G for example (what the partition gives)
#     --time T            time limit of a task, as sbatch takes it (the partition's); it goes on after that, later
#     --finish-time T     time limit of merging and verifying (the partition's)
#     --partition P       (the cluster's first choice)
#     --set PATH=VALUE    override a key of the config; repeat as needed
#     --retry-failed      try clips again that failed
#
# What the jobs print is in OUT.logs/, beside the data set. The program is $SHIMMER, or else `shimmer` in the PATH, or
# else build/release/bin/shimmer of this repository.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)

refuse() { echo "submit.sh: $*" >&2; exit 2; }
fail() { echo "submit.sh: $*" >&2; exit 1; }
need() { [ $# -ge 2 ] || refuse "$1 needs a value"; }

config='' out='' shards='' at_once='' cpus=1 time='' finish_time=''
sets=() retry=() given=(--export=ALL) where=()
while [ $# -gt 0 ]; do
  [[ $1 == --*=* ]] && set -- "${1%%=*}" "${1#*=}" "${@:2}"
  case "$1" in
    --shards) need "$@"; shards=$2; shift ;;
    --at-once) need "$@"; at_once=$2; shift ;;
    --cpus) need "$@"; cpus=$2; shift ;;
    --time) need "$@"; time=$2; shift ;;
    --finish-time) need "$@"; finish_time=$2; shift ;;
    --mem | --partition) need "$@"; where+=("$1=$2"); shift ;;
    --set) need "$@"; sets+=(--set "$2"); shift ;;
    --retry-failed) retry=(--retry-failed) ;;
    --) given+=("${@:2}"); break ;;
    -*) refuse "unknown option '$1'; those of sbatch go after --" ;;
    *) [ -z "$out" ] || refuse "'$1' is one too many: CONFIG and OUT are all"
       if [ -z "$config" ]; then config=$1; else out=$1; fi ;;
  esac
  shift
done

# Of the forms M, M:S, H:M:S, D-H, D-H:M and D-H:M:S, or nothing for what is none of them.
seconds_of() {
  [[ $1 =~ ^(([0-9]+)-)?([0-9]+)(:([0-9]+))?(:([0-9]+))?$ ]] || return 0
  local days=${BASH_REMATCH[2]} parts=("${BASH_REMATCH[3]}" "${BASH_REMATCH[5]}" "${BASH_REMATCH[7]}")
  [ -z "$days" ] && [ -z "${parts[2]}" ] && parts=(0 "${parts[@]:0:2}")  # without days, M and M:S
  echo $(((10#0$days * 24 + 10#0${parts[0]}) * 3600 + 10#0${parts[1]} * 60 + 10#0${parts[2]}))
}

[ -n "$out" ] || refuse "needs CONFIG, OUT and --shards N"
[ -n "$shards" ] || refuse "needs --shards N"
for pair in "--shards=$shards" "--at-once=${at_once:-1}" "--cpus=$cpus"; do
  [[ $pair =~ =[1-9][0-9]{0,6}$ ]] || refuse "${pair%%=*} is '${pair#*=}', must be a whole number from 1"
done
for pair in "--time=${time:-60}" "--finish-time=${finish_time:-60}"; do
  limit_s=$(seconds_of "${pair#*=}")
  [ -n "$limit_s" ] ||
    refuse "${pair%%=*} is '${pair#*=}', must be like 90 (minutes), 1:30:00 or 2-12:00:00 (with days)"
  # Slurm tells a task of its end 120 s before, or up to 60 s earlier than that: what is shorter would get nothing done.
  [ "$limit_s" -ge 300 ] || refuse "${pair%%=*} is '${pair#*=}', must be 5 minutes or more"
done
command -v sbatch >/dev/null || fail "there is no sbatch here: this must run where jobs are submitted"
largest=$(scontrol show config | sed -n 's/^MaxArraySize *= *//p')
[ "$shards" -le "${largest:-$shards}" ] ||
  refuse "--shards is $shards, must be at most $largest, this cluster's MaxArraySize"

SHIMMER=${SHIMMER:-$(command -v shimmer || echo "$here/../../build/release/bin/shimmer")}
[ -x "$SHIMMER" ] ||
  fail "no program at $SHIMMER: scripts/build.sh builds it, SHIMMER=/path/to/shimmer says where it is"
SHIMMER=$(realpath "$SHIMMER")
export SHIMMER
"$SHIMMER" plan "$config" "${sets[@]}" >/dev/null || exit $?

config=$(realpath "$config")
out=$(realpath -m "$out")
logs=$out.logs
mkdir -p "$logs"
log_pattern=${logs//%/%%}
where+=(--cpus-per-task="$cpus")

array=$(sbatch --parsable "${given[@]}" "${where[@]}" ${time:+--time="$time"} \
  --array="0-$((shards - 1))${at_once:+%$at_once}" --output="$log_pattern/generate-%A_%a.log" \
  "$here/generate.sbatch" "$config" "$out" "${sets[@]}" "${retry[@]}") || fail "sbatch took nothing"
array=${array%%;*}
# afterany: afterok would stay pending for ever where a task fails.
if ! finish=$(sbatch --parsable "${given[@]}" "${where[@]}" ${finish_time:+--time="$finish_time"} \
  --dependency="afterany:$array" --output="$log_pattern/finish-%j.log" \
  "$here/finish.sbatch" "$out"); then
  scancel "$array"
  fail "sbatch did not take the second job, so the first, $array, is cancelled"
fi
finish=${finish%%;*}

echo "generating: job $array, $shards shards of $out"
echo "then:       job $finish, merges and verifies, and says what is missing in $logs/finish-$finish.log"
echo "watch:      squeue --job=$array,$finish; tail -f $logs/generate-${array}_0.log"
