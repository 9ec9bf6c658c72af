# shellcheck shell=bash
# Sourced by submit and finish.
# shellcheck disable=SC2154  # variables come from the settings that submit wrote

# Submits shards, and the job that looks after them once they have all ended.
# Usage: submit_round ROUND SHARDS   (SHARDS as sbatch --array takes them; the settings are in variables)
submit_round() {
  local round=$1 list=$2 array finish logs=${run//%/%%}/slurm  # sbatch puts values for %j and the like
  local -a common=(--parsable --job-name="$job_name" --chdir="$run" --requeue --open-mode=append "${sbatch_options[@]}")
  # The signal comes 90 s before the time limit, so that the shard can end in order.
  array=$(sbatch "${common[@]}" --array="$list${at_once:+%$at_once}" --nodes=1 --ntasks=1 --cpus-per-task="$cpus" \
    --signal=B:USR1@90 --output="$logs/shard-%a.log" "$scripts/shard" "$run/slurm/settings")
  array=${array%%;*}
  if ! finish=$(sbatch "${common[@]}" --dependency="afterany:$array" --nodes=1 --ntasks=1 --cpus-per-task="$cpus" \
    --output="$logs/finish.log" "$scripts/finish" "$run/slurm/settings" "$round"); then
    scancel "$array"
    return 1
  fi
  echo "round $round: shards $list are job $array; job ${finish%%;*} looks after them"
}
