#!/usr/bin/python3
"""A controller that is hard of hearing: 2,500 batches, while calls of sbatch and squeue fail.

Of all calls of sbatch 30 % fail, and 10 % submit and lose their answer: they end with an error, with no word, by
SIGKILL, or hang. Of squeue's 10 % fail. No job may be submitted twice, so each comment's token is that of one job and
each frame in the batches of one; and the campaign must be that of one machine.

    tests/slurm/flaky.py [--batches 2500] [--seed S] [--array-size N…] [--report results/reliability/slurm.md]
"""

import collections
import json
import os
import pathlib
import shutil
import sys
import time

import cluster
import distributed
from distributed import LABELS, Bench, Complaint, report

HERE = pathlib.Path(__file__).resolve().parent
NODES, CPUS = 4, 4
# As Slurm comes, and one with which there are many calls to fail.
ARRAY_SIZES = (1001, 26)
HANGS = 0.1  # of the lost answers: the head waits a minute for each
LONGEST_S = 1200


def main():
    parser = report.parser_of(__doc__)
    parser.add_argument("--batches", type=int, default=2500)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--array-size", type=int, action="append", help=f"MaxArraySize (default: {ARRAY_SIZES})")
    options = parser.parse_args()
    missing = cluster.missing_programs()
    if missing:
        sys.exit(f"there is no {', '.join(missing)} here; scripts/slurm-dev.sh install brings them")
    begin = time.monotonic()
    rows = []
    with distributed.program_of(options) as program:
        for size in options.array_size or ARRAY_SIZES:
            with cluster.Cluster(NODES, CPUS, size, settings=["MinJobAge=100000"]) as nodes:
                rows.append(submit(program, nodes, options, size))
            print(rows[-1], file=sys.stderr, flush=True)
    text = [f"Made by `tests/slurm/flaky.py --seed {options.seed}`, which says how: *number* is how many batches there were, of one frame each.",
            f"{NODES} nodes of {CPUS} processors. Of the calls of sbatch, 30 % fail without submitting, and 10 % submit and lose their answer "
            "(an error, no word,", "SIGKILL, or a hang); of squeue's, 10 % fail. *Duplicated* counts jobs with the token of another, too, and "
            "frames in the batches of two jobs, unless Slurm has lost the task of the first.", "", *report.table_of(rows), "", *report.legend(), "",
            f"Took {time.monotonic() - begin:.0f} s."]
    print("\n".join(text))
    if options.report:
        distributed.write_section(options.report, distributed.TITLE, "A controller that is hard of hearing", text)
    return 1 if any(row.complaints for row in rows) else 0


def submit(program, nodes, options, size):
    """A row about one campaign."""
    scenes = -(-options.batches // 3)  # of three frames
    bench = Bench(program, LABELS, scenes, nodes, batch_frames=1)
    folder = stand_before(program, options.seed)
    row = report.Row(f"MaxArraySize={size}", number=bench.frames)
    begin = time.monotonic()
    bench.clear()
    run = program.run(*bench.submit_to_cluster(), timeout=LONGEST_S)
    resumes, complaints = bench.finish(run, allowed=(4,), patience_s=LONGEST_S)
    program.more_environment.clear()
    submitted = [json.loads(line) for line in (folder / "submitted.jsonl").read_text(encoding="utf-8").splitlines()]
    complaints += double_submissions(submitted, nodes, bench.frames, row)
    row.notes.update({"jobs": len(submitted), "calls of sbatch": counted(folder, "sbatch"),
                      "of them failed": counted(folder, "sbatch-failed"), "lost their answer": counted(folder, "sbatch-lost"),
                      "calls of squeue": counted(folder, "squeue"), "of those failed": counted(folder, "squeue-failed"),
                      "heads ended, resumed": resumes, "seconds": round(time.monotonic() - begin)})
    row.blame(complaints, f"seed {options.seed}")
    return row


def stand_before(program, seed):
    """Puts programs that fail before Slurm's in the PATH of the program, and returns their folder."""
    folder = program.folder / "flaky"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    ways = ["error", "says nothing", "killed"] * round((1 / HANGS - 1) / 3) + ["hangs"]
    wishes = {"seed": seed, "sbatch": {"fail": 0.3, "lose": 0.1}, "squeue": {"fail": 0.1}, "ways to lose": ways,
              "path": str(pathlib.Path(shutil.which("sbatch")).parent)}
    (folder / "wishes.json").write_text(json.dumps(wishes), encoding="utf-8")
    for name in ("sbatch", "squeue"):
        shutil.copy(HERE / "flaky_program.py", folder / name)
    program.more_environment.update({"FLAKY_FOLDER": str(folder), "PATH": f"{folder}:{os.environ['PATH']}"})
    return folder


def double_submissions(submitted, nodes, frames, row):
    """Complaints about jobs: by what sbatch has really done, and by what the controller knows.

    A frame may be in the batches of two jobs if Slurm has lost the task of the first, as it does on a busy machine.
    """
    complaints = []
    known = nodes.arrays()
    if set(known) != {int(each["job"]) for each in submitted}:
        complaints.append(Complaint("conduct", f"{len(submitted)} jobs were submitted, the controller knows {len(known)}"))
    for comment, jobs in collections.Counter(known.values()).items():
        if jobs != 1:
            complaints.append(Complaint("duplicated", f"{jobs} jobs have the comment {comment!r}"))
    batches = collections.Counter(frame for each in submitted for batch in each["batches"] for frame in batch)
    twice = [frame for frame, jobs in batches.items() if jobs > 1]
    for frame in twice:
        tasks = [f"{each['job']}_{index}" for each in submitted for index, batch in enumerate(each["batches"]) if frame in batch]
        fates = [nodes.fate(task) for task in tasks]
        print(f"frame {frame} was in the batches of {'; '.join(fates)}", file=sys.stderr, flush=True)
        if any("JobState=COMPLETED" in fate for fate in fates[:-1]):
            complaints.append(Complaint("duplicated", f"frame {frame} was in the batches of {'; '.join(fates)}"))
        else:
            row.notes["tasks that Slurm lost"] += 1
    if len(batches) != frames:
        complaints.append(Complaint("lost", f"{len(batches)} of {frames} frames were submitted"))
    return complaints


def counted(folder, what):
    file = folder / f"{what}.count"
    return int(file.read_text(encoding="ascii")) if file.exists() else 0


if __name__ == "__main__":
    sys.exit(main())
