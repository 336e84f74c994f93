#!/bin/sh
# A Slurm cluster on this machine, to try and to test `seedframe submit --executor slurm`: munged, slurmctld and a slurmd
# for each node, on loopback, as the user who calls, all below one folder. No systemd, no cgroups, nothing in /etc; a
# cluster that this machine belongs to is not touched. Anybody may have several, each in a folder of its own.
#
#   eval "$(scripts/slurm-dev.sh up DIR)"     starts it, waits until all nodes are idle, prints "export SLURM_CONF=…".
#                                             DIR is new, empty, or of a cluster that is down, which begins anew
#       --nodes 3              n1, n2, n3     or SLURM_DEV_NODES in the environment
#       --cpus 2               of a node      or SLURM_DEV_CPUS; may be more than the machine has
#       --max-array-size 1001                 or SLURM_DEV_MAX_ARRAY_SIZE
#       --port 20000           the first of nodes + 1 in a row, or SLURM_DEV_PORT; else any that are free
#       --set SlurmdTimeout=5  any line of slurm.conf, also again, in place of the one that it has; or of a partition
#   scripts/slurm-dev.sh down DIR             ends all that belongs to it, jobs too; DIR stays. Also when it is down
#
#   scripts/slurm-dev.sh kill-node DIR n1     power loss: SIGKILL to the node's slurmd, its slurmstepds and its jobs
#   scripts/slurm-dev.sh stop-node DIR n1     the same stand still (SIGSTOP)
#   scripts/slurm-dev.sh continue-node DIR n1
#   scripts/slurm-dev.sh start DIR n1         a daemon that was killed again; or slurmctld in place of n1
#   scripts/slurm-dev.sh install              Debian's packages, if they are missing: as root, or with sudo (up does so too)
#
# Exit codes: 2 for arguments that make no sense, 4 for what this machine lacks.
set -eu
PATH=$PATH:/usr/sbin
fail() { # exit code, words
  code=$1
  shift
  echo "slurm-dev.sh: $*" >&2
  exit "$code"
}

install_packages() {
  missing=""
  for pair in munged:munge slurmctld:slurm-wlm slurmd:slurm-wlm sbatch:slurm-wlm; do
    command -v "${pair%:*}" >/dev/null || missing="$missing ${pair#*:}"
  done
  [ -n "$missing" ] || return 0
  as_root=""
  if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null ||
      fail 4 "Slurm's programs are missing: as root, run: apt-get install --no-install-recommends slurm-wlm munge"
    as_root=sudo
  fi
  echo "slurm-dev.sh: installing slurm-wlm and munge" >&2
  # Debian would start munged (and slurmd, where there is a slurm.conf) for the whole machine.
  policy=/usr/sbin/policy-rc.d
  made_policy=""
  if [ ! -e $policy ]; then
    printf '#!/bin/sh\nexit 101\n' | $as_root tee $policy >/dev/null
    $as_root chmod 755 $policy
    made_policy=yes
  fi
  installed=yes
  $as_root apt-get update -qq >&2 &&
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends slurm-wlm munge \
      >/dev/null || installed=""
  [ -z "$made_policy" ] || $as_root rm -f $policy
  [ -n "$installed" ] || fail 4 "slurm-wlm and munge could not be installed: what apt-get said stands above"
}

# ---- Processes ----

# What belongs to the cluster has SLURM_DEV_PART=DIR/part in its environment: daemons from here, slurmstepds from
# their slurmd. Jobs have the environment of whoever submitted them, and what Slurm adds to it.
daemons_of() { # part, or nothing for all
  pattern="SLURM_DEV_PART=$dir/${1:-[a-z0-9]+}"
  grep -lzxE "$pattern" /proc/[0-9]*/environ 2>/dev/null | cut -d / -f 3
}
jobs_of() { # node, or nothing for all
  for environ in $(grep -lzxF "SLURM_CONF=$dir/slurm.conf" /proc/[0-9]*/environ 2>/dev/null); do
    ! grep -qzxE "SLURMD_NODENAME=${1:-.+}" "$environ" 2>/dev/null || echo "$environ" | cut -d / -f 3
  done
}
processes_of() { { daemons_of "${1:-}"; jobs_of "${1:-}"; } | sort -un | grep -vx "$$" || true; }
send() { # signal, ids
  signal=$1
  shift
  [ $# = 0 ] || kill -s "$signal" "$@" 2>/dev/null || true  # some have ended by themselves
}

start_munge() {
  SLURM_DEV_PART=$dir/munge munged --force --num-threads=2 --key-file="$dir/munge/key" --socket="$dir/munge/sock" \
    --pid-file="$dir/munge/pid" --log-file="$dir/munge/log" --seed-file="$dir/munge/seed" >&2
}
start_controller() { SLURM_DEV_PART=$dir/slurmctld slurmctld "$@" -f "$dir/slurm.conf" >&2; }
start_node() { # name, options
  node=$1
  shift
  SLURM_DEV_PART=$dir/$node slurmd "$@" -N "$node" -f "$dir/slurm.conf" >&2
}

# ---- Up ----

choose_port() { # the first of nodes + 1 that nobody listens on, below those that the kernel gives out by itself
  [ -z "$port" ] || return 0
  busy=$(awk 'FNR > 1 { sub(/.*:/, "", $2); print $2 }' /proc/net/tcp /proc/net/tcp6 2>/dev/null | sort -u)
  for _ in 1 2 3 4 5 6 7 8 9 10; do
    port=$((20000 + $(od -An -N2 -tu2 /dev/urandom) % 12000))
    is_free=yes
    for i in $(seq 0 "$nodes"); do
      ! echo "$busy" | grep -qix "$(printf %04x $((port + i)))" || is_free=""
    done
    [ -z "$is_free" ] || return 0
  done
  fail 4 "no $((nodes + 1)) free ports in a row between 20000 and 32000 were found"
}

write_config() {
  user=$(id -un)
  host=$(uname -n | cut -d . -f 1)
  {
    cat <<END
ClusterName=seedframe
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket=$dir/munge/sock
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool/%n
SlurmctldPidFile=$dir/slurmctld.pid
SlurmdPidFile=$dir/slurmd.%n.pid
SlurmctldLogFile=$dir/log/slurmctld.log
SlurmdLogFile=$dir/log/slurmd.%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
AccountingStoreFlags=job_comment
JobCompType=jobcomp/filetxt
JobCompLoc=$dir/log/jobcomp.txt
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SlurmdParameters=config_overrides
SchedulerType=sched/backfill
SchedulerParameters=batch_sched_delay=0,sched_min_interval=0,bf_interval=1
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
SlurmdTimeout=10
SlurmctldTimeout=10
KillWait=2
MinJobAge=300
MaxArraySize=$max_array_size
JobRequeue=1
END
    for i in $(seq "$nodes"); do
      echo "NodeName=n$i NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + i)) CPUs=$cpus RealMemory=1000 State=UNKNOWN"
    done
    echo "PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP"
  } >"$dir/slurm.conf.new"
  printf '%s' "$settings" | while IFS= read -r line; do
    case $line in
      PartitionName=* | NodeName=*) place=${line%% *} ;;
      *) place=${line%%=*} ;;
    esac
    { grep -vi "^$place[ =]" "$dir/slurm.conf.new" || true; echo "$line"; } >"$dir/slurm.conf.newer"
    mv "$dir/slurm.conf.newer" "$dir/slurm.conf.new"
  done
  mv "$dir/slurm.conf.new" "$dir/slurm.conf"
}

start_all() { # 1 unless all nodes are idle after a while
  for part in munge state spool log; do
    rm -rf "${dir:?}/$part"
    mkdir "$dir/$part"
  done
  rm -f "$dir"/slurm*.pid
  chmod 711 "$dir" "$dir/munge"
  (umask 077 && head -c 1024 /dev/urandom >"$dir/munge/key")
  write_config
  export SLURM_CONF="$dir/slurm.conf"
  start_munge || return 1
  start_controller -c || return 1
  for i in $(seq "$nodes"); do
    mkdir "$dir/spool/n$i"
    start_node "n$i" -c || return 1
  done
  for _ in $(seq 300); do
    [ "$(sinfo --Node --noheader --states=idle --responding --format=%N 2>/dev/null | sort -u | wc -l)" != "$nodes" ] || return 0
    sleep 0.1
  done
  return 1
}

up() {
  nodes=${SLURM_DEV_NODES:-3}
  cpus=${SLURM_DEV_CPUS:-2}
  max_array_size=${SLURM_DEV_MAX_ARRAY_SIZE:-1001}
  asked_port=${SLURM_DEV_PORT:-}
  settings=""
  while [ $# -gt 0 ]; do
    [ $# -ge 2 ] || fail 2 "expected a value behind $1"
    case $1 in
      --nodes) nodes=$2 ;;
      --cpus) cpus=$2 ;;
      --max-array-size) max_array_size=$2 ;;
      --port) asked_port=$2 ;;
      --set) settings="$settings$2
" ;;
      *) fail 2 "up knows no option $1: --nodes, --cpus, --max-array-size, --port, --set" ;;
    esac
    shift 2
  done
  for number in "$nodes" "$cpus" "$max_array_size" "${asked_port:-1}"; do
    case $number in
      '' | *[!0-9]* | 0*) fail 2 "expected a number of 1 or more, got '$number'" ;;
    esac
  done
  install_packages
  mkdir -p "$dir"
  [ -f "$dir/slurm.conf" ] || [ -z "$(ls -A "$dir")" ] ||
    fail 2 "$dir is neither empty nor of a cluster of this script: name another folder"
  [ -z "$(processes_of)" ] || fail 2 "the cluster in $dir is up: end it with scripts/slurm-dev.sh down $dir"
  for _ in 1 2 3; do
    port=$asked_port
    choose_port
    if start_all; then
      echo "export SLURM_CONF=$dir/slurm.conf"
      return 0
    fi
    tail -n 5 "$dir"/log/slurm*.log "$dir/munge/log" >&2 || true
    down
    # Somebody else was faster: other ports may be free.
    grep -qi "address already in use" "$dir"/log/slurm*.log || break
  done
  fail 4 "not all of $nodes nodes came up: the last lines of the logs stand above, all of them are in $dir/log"
}

# ---- Down ----

down() {
  for signal in TERM KILL KILL; do
    # A slurmstepd hears SIGTERM only when its job is over, and what stands still hears nothing.
    ids=$(processes_of)
    send "$signal" $ids
    send CONT $ids
    for _ in $(seq 15); do
      [ -n "$(processes_of)" ] || return 0
      sleep 0.1
    done
  done
  fail 1 "these processes cannot be ended:" $(processes_of)
}

on_node() { # signal
  is_node
  ids=$(processes_of "$node")
  [ -n "$ids" ] || fail 2 "nothing runs on $node"
  send "$1" $ids
}
is_node() {
  [ -d "$dir/spool/$node" ] && [ -n "$node" ] ||
    fail 2 "the cluster in $dir has no node '$node', but: $(ls "$dir/spool" 2>/dev/null | tr '\n' ' ')"
}

usage="usage: scripts/slurm-dev.sh up|down|kill-node|stop-node|continue-node|start|install DIR; its head says more"
what=${1:-}
[ "$what" != install ] || { install_packages; exit 0; }
[ $# -ge 2 ] || fail 2 "$usage"
dir=$(realpath -m -- "$2")
case $dir in
  *[!A-Za-z0-9/._-]*) fail 2 "Slurm takes no such path: $dir: letters, digits and . _ - only" ;;
esac
# Names of sockets have at most 107 bytes; the longest are of slurmstepds.
[ "${#dir}" -le 64 ] || fail 2 "$dir has more than 64 letters, and sockets in it would have names that are too long"
shift 2
node=${1:-}
case $what in
  up) up "$@" ;;
  down) down ;;
  kill-node) on_node KILL ;;
  stop-node) on_node STOP ;;
  continue-node) on_node CONT ;;
  start)
    [ -f "$dir/slurm.conf" ] || fail 2 "there is no cluster in $dir"
    export SLURM_CONF="$dir/slurm.conf"
    if [ "$node" = slurmctld ]; then start_controller; else is_node && start_node "$node"; fi
    ;;
  *) fail 2 "$usage" ;;
esac
