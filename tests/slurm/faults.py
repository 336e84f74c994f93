#!/usr/bin/python3
"""What breaks in a cluster, while a campaign runs on it: daemons, nodes, jobs, and the head itself.

A fault meets each campaign once, at a random moment after its first task has begun. A head that ends before its
campaign is complete must say that `resume` goes on, and then it does. In the end the campaign must be that of one
machine, no frame committed twice, and nothing left running.

    tests/slurm/faults.py [--cycles 20] [--fault NAME…] [--seed S] [--at-once 3] [--report results/reliability/slurm.md]
"""

import concurrent.futures
import random
import signal
import subprocess
import sys
import threading
import time

import cluster
import distributed
from distributed import CHECKED, PATIENCE_S, Bench, Complaint, report

SCENES = 8  # of three frames, three frames a task: eight tasks on three nodes
FRAME_S = 0.15
ENDS_EARLY = (3, 4)  # frames have failed; what the head works with has
# Soon noticed, so that a cycle does not take minutes.
SETTINGS = ("SlurmdTimeout=5", "MessageTimeout=3", "KillWait=1", "PreemptType=preempt/partition_prio", "PreemptMode=CANCEL",
            "SlurmctldParameters=preempt_send_user_signal", "PartitionName=main Nodes=ALL Default=YES State=UP PriorityTier=1 GraceTime=5",
            "PartitionName=urgent Nodes=ALL State=UP PriorityTier=9 PreemptMode=OFF")


class Case:
    """A campaign under way: what a fault can take hold of."""

    def __init__(self, bench, process, rng):
        self.bench = bench
        self.cluster = bench.cluster
        self.process = process
        self.rng = rng
        self.node = rng.choice(bench.cluster.nodes)

    def pause(self, least=0.3, most=4.0):
        time.sleep(self.rng.uniform(least, most))

    def running(self):
        return [job for job in self.cluster.jobs() or [] if job[1] == "RUNNING"]


def controller(case):
    """SIGKILL of slurmctld, which is started again"""
    case.cluster.kill_controller()
    case.pause()
    case.cluster.start_controller()
    return True


def daemon(case):
    """SIGKILL of a slurmd, which is started again"""
    case.cluster.kill_daemon(case.node)
    case.pause()
    case.cluster.start_node(case.node)
    return True


def step(case):
    """SIGKILL of a slurmstepd"""
    steps = case.cluster.step_daemons()
    if steps:
        distributed.end_process(case.rng.choice(steps))
    return bool(steps)


def frozen(case):
    """a node that stands still for longer than SlurmdTimeout, and goes on"""
    case.cluster.stop_node(case.node)
    case.bench.wait_for(lambda: case.cluster.node_state(case.node).startswith("down"), case.process, 60)
    case.pause(0, 1)
    case.cluster.continue_node(case.node)
    return True


def cancelled(case):
    """scancel of the array"""
    jobs = case.running()
    if jobs:
        subprocess.run(["scancel", jobs[0][0].split("_")[0]], check=False)
    return bool(jobs)


def requeued(case):
    """scontrol requeue of a task"""
    jobs = case.running()
    if not jobs:
        return False
    job = case.rng.choice(jobs)[0]
    # Tasks are submitted so that they are never begun again; an administrator may think otherwise.
    subprocess.run(["scontrol", "update", f"JobId={job}", "Requeue=1"], check=False, stderr=subprocess.DEVNULL)
    return subprocess.run(["scontrol", "requeue", job], check=False, stderr=subprocess.DEVNULL).returncode == 0


def preempted(case):
    """somebody else's job that comes first on a node"""
    return subprocess.run(["sbatch", "--partition=urgent", f"--nodelist={case.node}", "--exclusive", "--output=/dev/null",
                           "--wrap=sleep 2"], check=False, stdout=subprocess.DEVNULL).returncode == 0


def power(case):
    """power loss of a node, which comes back"""
    case.cluster.kill_node(case.node)
    case.pause()
    case.cluster.start_node(case.node)
    return True


def head(case):
    """SIGKILL of the head"""
    case.process.send_signal(signal.SIGKILL)
    case.pause(0, 2)
    return True


FAULTS = {fault.__name__: fault for fault in (controller, daemon, step, frozen, cancelled, requeued, preempted, power, head)}


def main():
    parser = report.parser_of(__doc__)
    parser.add_argument("--cycles", type=int, default=20, help="campaigns for each fault")
    parser.add_argument("--fault", action="append", choices=FAULTS, help="this one only; may be repeated")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--at-once", type=int, default=3, help="clusters beside each other: they wait most of the time")
    options = parser.parse_args()
    missing = cluster.missing_programs()
    if missing:
        sys.exit(f"there is no {', '.join(missing)} here; scripts/slurm-dev.sh install brings them")
    begin = time.monotonic()
    with concurrent.futures.ProcessPoolExecutor(options.at_once) as pool:
        found = list(pool.map(meet_often, *zip(*((options, name) for name in options.fault or FAULTS))))
    rows = [row for row, _ in found]
    spans = sorted(span_s for _, span_s in found)
    text = [f"Made by `tests/slurm/faults.py --seed {options.seed}`, which says how: *number* is how many campaigns met the fault, at a",
            f"random moment. Campaigns of {3 * SCENES} frames by a fake Blender, checked against their twins, in tasks of three frames "
            "on three nodes;", f"{spans[0]:.1f} to {spans[-1]:.1f} s from the first task to the end when undisturbed, "
            f"{options.at_once} clusters at once on this machine.", "", *report.table_of(rows), "",
            *report.legend(), "", f"Took {time.monotonic() - begin:.0f} s."]
    print("\n".join(text))
    if options.report:
        distributed.write_section(options.report, distributed.TITLE, "What breaks in a cluster", text)
    return 1 if any(row.complaints for row in rows) else 0


def meet_often(options, name):
    """(row, seconds when undisturbed) of one fault, on a cluster of its own."""
    row = report.Row(FAULTS[name].__doc__)
    with distributed.program_of(options) as program, \
            cluster.Cluster(nodes=3, cpus=1, settings=SETTINGS) as nodes:
        bench = Bench(program, CHECKED, SCENES, nodes)
        span_s = undisturbed(bench)
        administrator = Administrator(nodes, row)
        for cycle in range(options.cycles):
            begin = time.monotonic()
            try:
                complaints = meet(bench, row, FAULTS[name], random.Random(f"{options.seed} {name} {cycle}"), span_s)
            except (RuntimeError, TimeoutError) as error:
                complaints = [Complaint("conduct", str(error))]
            row.blame(complaints, f"cycle {cycle}",
                      f"tests/slurm/faults.py --fault {name} --seed {options.seed} --cycles {cycle + 1}")
            print(f"{name} {cycle}: {time.monotonic() - begin:.0f} s", file=sys.stderr, flush=True)
        administrator.end()
    return row, span_s


class Administrator(threading.Thread):
    """Slurm drains a node on which it could not start a job, and leaves it so until somebody says otherwise."""

    def __init__(self, nodes, row):
        super().__init__(daemon=True)
        self.nodes = nodes
        self.row = row
        self.ending = threading.Event()
        self.start()

    def run(self):
        while not self.ending.wait(2):
            for why in self.nodes.resume_drained():
                self.row.notes["nodes that Slurm had drained were resumed"] += 1
                print(f"drained {why}", file=sys.stderr, flush=True)

    def end(self):
        self.ending.set()
        self.join()


def start(bench):
    bench.clear()
    process = bench.program.start(*bench.submit_to_cluster(), fake={"delay_s": FRAME_S})
    if not bench.wait_for(bench.claims, process):
        run = bench.program.end(process, 1)
        raise RuntimeError(f"no task has begun before the head ended with {run.code}: {run.errors[-1000:]}")
    return process


def undisturbed(bench):
    """Seconds from the first task to the end."""
    process = start(bench)
    since = time.monotonic()
    run = bench.program.end(process)
    seconds = time.monotonic() - since
    resumes, complaints = bench.finish(run)
    if resumes or complaints:
        sys.exit(f"the undisturbed campaign is not as it should be: {run} {complaints}")
    return seconds


def meet(bench, row, fault, rng, span_s):
    """Complaints about one campaign that meets the fault."""
    before = set(bench.cluster.arrays())
    process = start(bench)
    time.sleep(rng.uniform(0, 0.8 * span_s))
    try:
        if fault(Case(bench, process, rng)):
            row.number += 1
        else:
            row.notes["found nothing to break"] += 1
    except subprocess.CalledProcessError as error:
        row.notes["found nothing to break"] += 1
        print(error, file=sys.stderr)
    run = bench.program.end(process, PATIENCE_S)
    allowed = ENDS_EARLY if fault is not head else (-signal.SIGKILL,)
    resumes, complaints = bench.finish(run, allowed)
    if resumes:
        row.notes["heads ended, resumed"] += 1
    if len(set(bench.cluster.arrays()) - before) > 1:  # the first has all frames, others what was lost
        row.notes["gave frames out again"] += 1
    try:
        bench.cluster.heal()
    except TimeoutError as error:
        complaints.append(Complaint("conduct", str(error)))
    return complaints


if __name__ == "__main__":
    sys.exit(main())
