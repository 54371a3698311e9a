#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# An ensemble as an array of jobs of Slurm, by a controller, a node and an authenticator of this test alone, on this
# machine's loopback. Without Slurm (apt-get install slurm-wlm munge), or where it does not start, the test skips aloud.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"

daemons=()
stop_slurm() {
  local daemon
  for daemon in "${daemons[@]}"; do kill "$daemon" 2>/dev/null || true; done
  wait 2>/dev/null || true
}

# start_daemon NAME COMMAND...: in the background, until the test ends.
start_daemon() {
  local name=$1
  shift
  "$@" >"$slurm/$name.out" 2>&1 </dev/null &
  daemons+=("$!")
}

# start_slurm: a cluster of one node with two processors, or a skip.
start_slurm() {
  local program host
  for program in slurmctld slurmd munged srun sbatch; do
    command -v "$program" >/dev/null || skip "$program is not installed (apt-get install slurm-wlm munge)"
  done
  [[ $(id -u) -eq 0 ]] || skip "a node of Slurm is started by root"
  slurm=$(mktemp -d /tmp/talus-slurm-XXXXXX)   # sockets have short paths
  trap 'stop_slurm; rm -rf "$slurm"' EXIT
  mkdir "$slurm/state" "$slurm/spool"
  host=$(hostname -s)
  (umask 077 && head -c 1024 /dev/urandom >"$slurm/key")
  chmod 700 "$slurm"
  cat >"$slurm/slurm.conf" <<CONF
ClusterName=talus
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$((20000 + $$ % 10000))
SlurmdPort=$((30000 + $$ % 10000))
AuthType=auth/munge
AuthInfo=socket=$slurm/munge
SlurmUser=root
SlurmdUser=root
StateSaveLocation=$slurm/state
SlurmdSpoolDir=$slurm/spool
SlurmctldPidFile=$slurm/slurmctld.pid
SlurmdPidFile=$slurm/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
ReturnToService=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=$host Default=YES State=UP
CONF
  export SLURM_CONF=$slurm/slurm.conf
  start_daemon munged munged --force --foreground --key-file="$slurm/key" --socket="$slurm/munge" \
    --pid-file="$slurm/munged.pid" --log-file="$slurm/munged.log" --seed-file="$slurm/seed" --num-threads=2
  local waited
  for ((waited = 0; waited < 50; ++waited)); do
    if [[ -S $slurm/munge ]]; then break; fi
    sleep 0.1
  done
  start_daemon slurmctld slurmctld -D -f "$SLURM_CONF"
  start_daemon slurmd slurmd -D -f "$SLURM_CONF"
  for ((waited = 0; waited < 150; ++waited)); do
    if sinfo --noheader --format=%T 2>/dev/null | grep -q idle; then return; fi
    sleep 0.2
  done
  skip "Slurm did not start here: $(tail -n 2 "$slurm/slurmctld.out" "$slurm/slurmd.out" | tr '\n' ' ')"
}

# Parts of three jobs are those of ten members: 3, 3 and 4.
test_an_array_of_jobs_computes_the_parts() {
  start_slurm
  scene_of_members 10
  expect_exit 0 preprocess
  export TALUS_BIN=$bin
  expect_exit 0 timeout 240 sbatch --wait --array=0-2 --cpus-per-task=1 --output=job.%a.log \
    "$TALUS_SOURCE/pipelines/ensemble.sbatch" recipe.toml out
  local part
  for part in 0-3 3-6 6-10; do
    [[ -s out/counts.$part.h5 ]] || fail "there is no part $part: $(tail -n 5 job.*.log)"
  done
  expect_exit 0 timeout 240 sbatch --wait --array=0-2 --cpus-per-task=1 --output=again.%a.log \
    "$TALUS_SOURCE/pipelines/ensemble.sbatch" recipe.toml out
  grep -q "it holds this very part already" again.1.log || fail "a finished part was computed again"
}

# Without Slurm, PARTS and PART say which part it is. A process that is sent a part which another one computes waits.
test_the_script_runs_without_slurm() {
  scene_of_members 10
  expect_exit 0 preprocess
  local part script=$TALUS_SOURCE/pipelines/ensemble.sbatch
  export TALUS_BIN=$bin PARTS=3
  for part in 0 1 2; do expect_exit 0 env PART=$part "$script" recipe.toml out --on cpu; done
  [[ -s out/counts.6-10.h5 ]] || fail "the last part is missing"
  rm out/counts.*
  local slow=(--on cpu --threads 1 --set solve.end_time_s=100)
  PART=2 "$script" recipe.toml out "${slow[@]}" 2>first.log >/dev/null &
  for ((part = 0; part < 100; ++part)); do
    if grep -qs process out/.talus.6-10.lock; then break; fi
    sleep 0.01
  done
  expect_exit 0 env PART=2 "$script" recipe.toml out "${slow[@]}"
  expect_words "it holds this very part already"
  wait $! || fail "the first process failed: $(<first.log)"
  expect_exit 2 "$script" /dev/null out
  expect_exit 2 "$script" recipe.toml out --set ensemble.members=0
  expect_words "there are no members to divide"
}

run_test "$@"
