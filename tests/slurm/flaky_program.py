#!/usr/bin/python3 -SE
"""Stands before a program of Slurm in PATH and fails now and then, as its controller does when it is busy.

FLAKY_FOLDER names a folder with wishes.json: "seed"; by program "fail" and "lose", shares of its calls; "path", where
the real ones are. Which calls fail follows from the seed and from a count in that folder. What sbatch has really
submitted is written to submitted.jsonl there, with the batches of each job.
"""

import fcntl
import json
import os
import pathlib
import random
import signal
import subprocess
import sys
import time

NAME = pathlib.Path(sys.argv[0]).name
FOLDER = pathlib.Path(os.environ["FLAKY_FOLDER"])
TIMED_OUT = {"sbatch": "sbatch: error: Batch job submission failed: Socket timed out on send/recv operation",
             "squeue": "slurm_load_jobs error: Unable to contact slurm controller (connect failure)"}


def main():
    wishes = json.loads((FOLDER / "wishes.json").read_text(encoding="utf-8"))
    shares = wishes[NAME]
    rng = random.Random(f"{wishes['seed']} {NAME} {count(NAME)}")
    drawn = rng.random()
    if drawn < shares.get("fail", 0):
        count(f"{NAME}-failed")
        print(TIMED_OUT[NAME], file=sys.stderr)
        return 1
    real = [str(pathlib.Path(wishes["path"]) / NAME), *sys.argv[1:]]
    if NAME != "sbatch":
        os.execv(real[0], real)
    run = subprocess.run(real, check=False, stdout=subprocess.PIPE, text=True)
    if run.returncode == 0:
        note(run.stdout)
        if drawn < shares["fail"] + shares["lose"]:
            count("sbatch-lost")
            return lose(rng.choice(wishes["ways to lose"]))
    sys.stdout.write(run.stdout)
    return run.returncode


def lose(way):
    """Ends without having said which job it is."""
    if way == "killed":
        os.kill(os.getpid(), signal.SIGKILL)
    if way == "hangs":
        time.sleep(3600)
    if way == "says nothing":
        return 0
    print(TIMED_OUT[NAME], file=sys.stderr)
    return 1


def count(what):
    """How often this was called, with this call."""
    with open(FOLDER / f"{what}.count", "a+", encoding="ascii") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        file.seek(0)
        number = int(file.read() or 0) + 1
        file.truncate(0)
        file.write(str(number))
    return number


def note(answer):
    options = dict(word[2:].split("=", 1) for word in sys.argv[1:] if word.startswith("--") and "=" in word)
    submission = json.loads((pathlib.Path(sys.argv[-1]).parent / "submission.json").read_text(encoding="utf-8"))
    line = json.dumps({"job": answer.strip(), "comment": options["comment"], "array": options["array"],
                       "batches": submission["batches"]})
    with open(FOLDER / "submitted.jsonl", "a", encoding="utf-8") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        file.write(line + "\n")


if __name__ == "__main__":
    sys.exit(main())
