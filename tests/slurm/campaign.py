#!/usr/bin/python3
"""Campaigns on a cluster of three nodes, which is brought up on this machine: equal to local ones, interrupted, bereft.

    tests/slurm/campaign.py [--build FOLDER] [--case NAME…]

One line a case, and a last one "N passed, M failed". Exits with 77 if Slurm's programs are missing.
"""

import signal
import sys
import time

import cluster
import distributed
from distributed import CHECKED, LABELS, PATIENCE_S, SMALL, Bench, Complaint, judge, report

SLOW = {"delay_s": 0.4}  # a frame: so that there is time to interrupt


def main():
    parser = report.parser_of(__doc__)
    parser.add_argument("--case", action="append", choices=CASES, help="this one only; may be repeated")
    options = parser.parse_args()
    missing = cluster.missing_programs()
    if missing:
        print(f"skipped: there is no {', '.join(missing)} here; scripts/slurm-dev.sh install brings them")
        return cluster.SKIPPED
    failed = 0
    cases = options.case or list(CASES)
    with distributed.program_of(options) as program, \
            cluster.Cluster(nodes=3, cpus=2, settings=["SlurmdTimeout=5"]) as nodes:
        for name in cases:
            begin = time.monotonic()
            complaints = run_case(CASES[name], program, nodes)
            failed += bool(complaints)
            print(f"{'FAILED' if complaints else 'passed'} {name}: {CASES[name].__doc__} ({time.monotonic() - begin:.1f} s)",
                  flush=True)
            for complaint in complaints:
                print(f"       {complaint.kind}: {complaint.text}", flush=True)
    print(f"{len(cases) - failed} passed, {failed} failed")
    return 1 if failed else 0


def run_case(case, program, nodes):
    """The complaints; a case that breaks down has failed, and the others are tried all the same."""
    try:
        return case(program, nodes)
    except (Exception, SystemExit) as error:  # pylint: disable=broad-except
        return [Complaint("conduct", f"{type(error).__name__}: {error}")]


def fake(program, nodes):
    """frames of a fake Blender, each checked against its twin, are those of one machine"""
    return equal(Bench(program, CHECKED, 10, nodes, batch_frames=4))


def real(program, nodes):
    """six frames of the real Blender are those of one machine"""
    return equal(Bench(program, SMALL, 2, nodes, batch_frames=2))


def labels(program, nodes):
    """labels without pictures are those of one machine"""
    return equal(Bench(program, LABELS, 20, nodes, batch_frames=10))


def equal(bench):
    bench.clear()
    before = set(bench.cluster.arrays())
    run = bench.program.run(*bench.submit_to_cluster(), timeout=PATIENCE_S)
    resumes, complaints = bench.finish(run)
    if resumes:
        complaints.append(Complaint("conduct", f"it took {resumes} more runs"))
    if not set(bench.cluster.arrays()) - before:
        complaints.append(Complaint("conduct", "Slurm has seen no array of it"))
    if (bench.campaign / "slurm").exists():
        complaints.append(Complaint("torn", "slurm/ is there still, though nothing was lost"))
    return complaints


def start_slowly(bench):
    """A head whose tasks have some frames, and work on others."""
    bench.clear()
    process = bench.program.start(*bench.submit_to_cluster(), fake=SLOW)
    if not bench.wait_for(lambda: bench.records() or bench.frames_there(), process):
        run = bench.program.end(process, 1)
        raise RuntimeError(f"no frame was made before it ended with {run.code}: {run.errors[-1000:]}")
    return process


def interrupt(program, nodes):
    """Ctrl-C ends the head with 130 and its jobs with it; what was made is kept, and resume makes the rest"""
    bench = Bench(program, CHECKED, 10, nodes, batch_frames=4)
    process = start_slowly(bench)
    process.send_signal(signal.SIGINT)
    run = program.end(process, 60)
    complaints = run.conduct(130) + bench.left_running()
    store, found = bench.judge_now()
    complaints += found
    done = store.done() if store else {}
    if not done or len(done) == bench.frames:
        complaints.append(Complaint("conduct", f"{len(done)} of {bench.frames} frames were done after Ctrl-C"))
    resumed = program.run(*bench.resume_on_cluster(), timeout=PATIENCE_S)
    complaints += resumed.conduct(0) + bench.judge() + bench.left_running()
    return complaints + judge.lost_since(done, judge.Store.read(bench.campaign, program.folder))


def killed_head(program, nodes):
    """kill -9 of the head leaves its jobs running; resume adopts them and submits nothing again"""
    bench = Bench(program, CHECKED, 10, nodes, batch_frames=4)
    process = start_slowly(bench)
    process.send_signal(signal.SIGKILL)
    program.end(process)
    complaints = [] if nodes.jobs() else [Complaint("conduct", "no job has outlived the head")]
    run = program.run(*bench.resume_on_cluster(), fake=SLOW, timeout=PATIENCE_S)
    complaints += run.conduct(0) + bench.judge() + bench.left_running()
    store = judge.Store.read(bench.campaign, program.folder)
    again = [frame for frame, row in store.frames.items() if row["attempts"] != 1]
    if again:
        complaints.append(Complaint("duplicated", f"frames {again} were made more than once, though their tasks went on"))
    return complaints


def lost_node(program, nodes):
    """a node that loses its power costs no frame: others make what it had"""
    bench = Bench(program, CHECKED, 10, nodes, batch_frames=4)
    process = start_slowly(bench)
    nodes.kill_node("n1")
    run = program.end(process, PATIENCE_S)
    nodes.start_node("n1")
    resumes, complaints = bench.finish(run)
    if resumes:
        complaints.append(Complaint("conduct", f"it took {resumes} more runs"))
    return complaints


CASES = {"fake": fake, "real": real, "labels": labels, "interrupt": interrupt, "killed-head": killed_head,
         "lost-node": lost_node}

if __name__ == "__main__":
    sys.exit(main())
