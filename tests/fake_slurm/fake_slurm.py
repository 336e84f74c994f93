#!/usr/bin/python3
"""Stands in for Slurm where its commands are to misbehave: sbatch, squeue, scancel, sinfo and scontrol are links to it.

FAKE_SLURM is a folder of its own: jobs.jsonl has a line for each array that was submitted, log the calls. Tasks run on
this machine, one after the other, as those of the nodes n1, n2, … that
are not excluded, in turn. FAKE_SLURM_DO is a JSON object; all keys are optional:

    "sbatch": ["fail", "lose", "ok"]  what its calls do in turn, the last from then on: "fail" submits nothing,
                                      "lose" submits and fails all the same, "refuse" fails for good
    "squeue": ["fail", "ok"]          the same
    "hold": true                      tasks never begin
    "vanish": [0]                     indices of the first array that leave the queue without having begun
    "twice": true                     each task is started twice
    "bad_nodes": ["n1"]               where the program is missing
    "nodes": 3, "max_array_size": 1001, "max_job_count": 10000
"""

import fcntl
import json
import os
import pathlib
import re
import subprocess
import sys

FOLDER = pathlib.Path(os.environ["FAKE_SLURM"])
WISH = json.loads(os.environ.get("FAKE_SLURM_DO", "{}"))
NODES = WISH.get("nodes", 3)


def turn(name):
    """What this call of a program does."""
    with open(FOLDER / (name + ".calls"), "a+") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        file.seek(0)
        count = len(file.read())
        file.write(".")
    plan = WISH.get(name, ["ok"])
    return plan[min(count, len(plan) - 1)]


def option(name, default=""):
    for argument in sys.argv[1:]:
        if argument.startswith(f"--{name}="):
            return argument.split("=", 1)[1]
    return default


def indices_of(text):
    for part in text.split("%")[0].split(","):
        first, _, last = part.partition("-")
        yield from range(int(first), int(last or first) + 1)


def jobs():
    try:
        return [json.loads(line) for line in open(FOLDER / "jobs.jsonl")]
    except FileNotFoundError:
        return []


def sbatch():
    outcome = turn("sbatch")
    if outcome == "refuse":
        sys.exit("sbatch: error: invalid partition specified: " + option("partition"))
    if outcome == "fail":
        sys.exit("sbatch: error: Slurm temporarily unable to accept job, sleeping and retrying")
    job = {"id": 1 + len(jobs()), "comment": option("comment"), "script": sys.argv[-1], "logs": option("output"),
           "indices": list(indices_of(option("array"))), "arguments": sys.argv[1:]}
    with open(FOLDER / "jobs.jsonl", "a") as file:
        file.write(json.dumps(job) + "\n")
    for index in job["indices"]:
        (FOLDER / f"{job['id']}_{index}.queued").touch()
    if job["id"] == 1:
        for index in WISH.get("vanish", []):
            (FOLDER / f"1_{index}.queued").unlink()
    if not WISH.get("hold"):
        # Of nobody: Seedframe ends what its children leave behind.
        nobodys = {name: value for name, value in os.environ.items() if name != "SEEDFRAME_CHILD_OF"}
        subprocess.Popen([sys.executable, __file__, "run", json.dumps(job)], start_new_session=True, env=nobodys,
                         stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    if outcome == "lose":
        sys.exit("sbatch: error: Batch job submission failed: Socket timed out on send/recv operation")
    print(job["id"])


def run(job):
    for turn_of, index in enumerate(job["indices"]):
        queued = FOLDER / f"{job['id']}_{index}.queued"
        if not queued.exists():
            continue
        excluded = [argument.split("=")[1] for argument in job["arguments"] if argument.startswith("--exclude=")]
        nodes = [f"n{i + 1}" for i in range(NODES) if f"n{i + 1}" not in ",".join(excluded).split(",")]
        node = nodes[turn_of % len(nodes)]
        queued.write_text(node)
        script = pathlib.Path(job["script"]).read_text()
        if node in WISH.get("bad_nodes", []):
            script = re.sub("exec '[^']*'", "exec '/nowhere/seedframe'", script)
        for _ in range(2 if WISH.get("twice") else 1):
            with open(job["logs"].replace("%A", str(job["id"])).replace("%a", str(index)), "a") as log:
                subprocess.run(["/bin/sh", "-c", script], stdout=log, stderr=log, env={
                    **os.environ, "SLURM_ARRAY_JOB_ID": str(job["id"]), "SLURM_ARRAY_TASK_ID": str(index),
                    "SLURMD_NODENAME": node, "SLURM_CPUS_PER_TASK": "1"})
        queued.unlink(missing_ok=True)


def squeue():
    if turn("squeue") == "fail":
        sys.exit("slurm_load_jobs error: Unable to contact slurm controller (connect failure)")
    comments = {job["id"]: job["comment"] for job in jobs()}
    for path in sorted(FOLDER.glob("*.queued")):
        job, index = re.match(r"(\d+)_(\d+)", path.name).groups()
        try:
            node = path.read_text()
        except FileNotFoundError:
            continue
        print(f"{job}|{index}|{'RUNNING' if node else 'PENDING'}|{node or 'n/a'}|{comments[int(job)]}")


def scancel():
    for argument in sys.argv[1:]:
        if not argument.startswith("-"):
            pattern = argument if "_" in argument else argument + "_*"
            for path in FOLDER.glob(pattern + ".queued"):
                if not path.read_text():
                    path.unlink()


def sinfo():
    for node in range(NODES):
        print(f"n{node + 1}|1|idle|main*")


def scontrol():
    if sys.argv[1:3] == ["show", "config"]:
        print(f"MaxArraySize            = {WISH.get('max_array_size', 1001)}")
        print(f"MaxJobCount             = {WISH.get('max_job_count', 10000)}")


def main():
    name = pathlib.Path(sys.argv[0]).name
    if sys.argv[1:2] == ["run"]:
        return run(json.loads(sys.argv[2]))
    with open(FOLDER / "log", "a") as log:
        log.write(" ".join([name, *sys.argv[1:]]) + "\n")
    {"sbatch": sbatch, "squeue": squeue, "scancel": scancel, "sinfo": sinfo, "scontrol": scontrol}[name]()


main()
