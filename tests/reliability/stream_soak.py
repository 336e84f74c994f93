#!/usr/bin/python3
"""A stream that is asked for very many frames by clients that come and go, watched from outside: does anything grow?

    tests/reliability/stream_soak.py [--requests N] [--preview N] [--hours H] [--report FILE]

N requests at fidelity labels, then N at preview, each to a program of its own, of small frames. Clients
of several processes connect, ask, and hang up: most in good order, some map arrays, some leave without reading what they
asked for, some send what is wrong, cancel, and come too late. Resident memory, open files and threads are from /proc.

Exits with 1 if memory grows by more than a twentieth from the second fifth of the requests to the last, if the line
through the last four fifths rises by more than 16 bytes a request (of more than 100,000), if files or threads become more, or
if an answer is not as it should be. --hours H: each fidelity is over after so long, however many were answered.
"""

import dataclasses
import json
import multiprocessing
import os
import pathlib
import random
import socket
import subprocess
import sys
import tempfile
import time

import report

HOME = pathlib.Path(__file__).resolve().parents[2]
CONFIGS = {"labels": "bench_small", "preview": "parts"}  # the first so small that a million take minutes
SIZE = (64, 48)
CLIENTS = 3
DAY = 86_400
SAMPLES = 200  # of memory over a run
MOST_GROWTH = 1.05
MOST_SLOPE = 16.0  # bytes a request: 16 MB over a million
ENOUGH_FOR_SLOPE = 100_000
WINDOW = 24  # requests of a client that are open at once


def main():
    parser = report.parser_of(__doc__)
    parser.add_argument("--requests", type=int, default=1_000_000, help="at fidelity labels")
    parser.add_argument("--preview", type=int, default=DAY, help="at fidelity preview (default: one a second for a day)")
    parser.add_argument("--hours", type=float, default=24.0)
    options = parser.parse_args()
    runs = [soak(options, fidelity, count)
            for fidelity, count in (("labels", options.requests), ("preview", options.preview)) if count > 0]
    text = "\n".join(text_of(runs))
    print(text)
    if options.report:
        options.report.parent.mkdir(parents=True, exist_ok=True)
        options.report.write_text(text, encoding="utf-8")
    return 0 if all(run.good() for run in runs) else 1


@dataclasses.dataclass
class Sample:
    answered: int
    memory: int  # bytes
    files: int
    threads: int


class Soak:
    """What was seen of one program."""

    def __init__(self, fidelity):
        self.fidelity = fidelity
        self.samples = []
        self.answered = self.clients = self.errors = self.wrong = 0
        self.wall = 0.0
        self.ended_well = False

    def part(self, first, last):
        """Samples of these fifths of the answers."""
        return [each for each in self.samples if first * self.answered <= 5 * each.answered <= last * self.answered]

    def mean(self, first, last):
        part = self.part(first, last)
        return sum(each.memory for each in part) / max(1, len(part))

    def growth(self):
        return self.mean(4, 5) / max(1.0, self.mean(1, 2))

    def slope(self):
        """Bytes a request, of the line through the last four fifths that is nearest to them."""
        part = self.part(1, 5)
        if len(part) < 2:
            return 0.0
        mean_x = sum(each.answered for each in part) / len(part)
        mean_y = sum(each.memory for each in part) / len(part)
        spread = sum((each.answered - mean_x) ** 2 for each in part)
        return sum((each.answered - mean_x) * (each.memory - mean_y) for each in part) / max(1.0, spread)

    def most(self, what, first, last):
        return max((getattr(each, what) for each in self.part(first, last)), default=0)

    def verdicts(self):
        """(what, measured, target, whether it is met)"""
        yield "answers that are not as they should be", f"{self.wrong:,}", "0", self.wrong == 0
        growth = self.growth()
        yield (f"resident memory, from the second fifth of the requests to the last ({mib(self.mean(1, 2))} to {mib(self.mean(4, 5))} MiB)",
               f"× {growth:.3f}", f"≤ {MOST_GROWTH}", growth <= MOST_GROWTH)
        if self.answered > ENOUGH_FOR_SLOPE:
            slope = self.slope()
            yield "slope of it over the last four fifths, bytes a request", f"{slope:.2f}", f"≤ {MOST_SLOPE:g}", slope <= MOST_SLOPE
        # Of clients that are there at once, and their arrays.
        for what, name in (("files", "open files"), ("threads", "threads")):
            before, after = self.most(what, 0, 2), self.most(what, 4, 5)
            yield f"most {name}, in the first two fifths and in the last", f"{before} and {after}", "not many more", after <= 1.5 * before + 8
        yield "ended in good order, and left nothing behind", told_yes(self.ended_well), "yes", self.ended_well

    def good(self):
        return all(met for *_, met in self.verdicts())


def soak(options, fidelity, count):
    run = Soak(fidelity)
    with tempfile.TemporaryDirectory(prefix="seedframe-stream-") as folder:
        folder = pathlib.Path(folder)
        path = folder / "socket"
        process = subprocess.Popen(
            [str(options.build.resolve() / "seedframe"), "stream", str(HOME / "configs" / f"{CONFIGS[fidelity]}.yaml"), "--socket",
             str(path), "--set", f"render.width={SIZE[0]}", "--set", f"render.height={SIZE[1]}"],
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
            env={**os.environ, "SEEDFRAME_HOME": str(HOME), "TMPDIR": str(folder)})
        counts = multiprocessing.Array("q", 4)  # answered, errors that were asked for, wrong answers, clients
        begin = time.monotonic()
        clients = [multiprocessing.Process(target=come_and_go, args=(str(path), fidelity, count, counts, seed), daemon=True)
                   for seed in range(CLIENTS)]
        for client in clients:
            client.start()
        watch(process, clients, count, counts, begin + 3600 * options.hours, run)
        for client in clients:
            client.terminate()
            client.join()
        run.wall = time.monotonic() - begin
        run.answered, run.errors, run.wrong, run.clients = counts
        process.terminate()
        code = process.wait(120)
        run.ended_well = code == 0 and not path.exists() and not any(folder.glob("seedframe-*/task-*"))
        if code != 0:
            print(f"the stream ended with {code}: {process.stderr.read()}", file=sys.stderr)
    return run


def watch(process, clients, count, counts, deadline, run):
    step, next_sample = max(1, count // SAMPLES), 0
    while process.poll() is None and counts[0] < count and time.monotonic() < deadline and any(each.is_alive() for each in clients):
        if counts[0] >= next_sample:
            run.samples.append(look(process.pid, counts[0]))
            next_sample = counts[0] + step
        time.sleep(0.05)
    if process.poll() is None:
        run.samples.append(look(process.pid, counts[0]))


def look(pid, answered):
    status = pathlib.Path(f"/proc/{pid}")
    pages = int((status / "statm").read_text(encoding="ascii").split()[1])
    return Sample(answered, pages * os.sysconf("SC_PAGE_SIZE"), len(os.listdir(status / "fd")), len(os.listdir(status / "task")))


# ---- Clients ----


def come_and_go(path, fidelity, count, counts, seed):
    rng = random.Random(seed)
    kinds = [(plain, 70), (with_arrays, 15), (rude, 10), (wrong, 5)]
    while counts[0] < count:
        client = connect(path)
        with client, client.makefile("rwb") as lines:
            lines.readline()
            (kind,) = rng.choices([each for each, _ in kinds], [weight for _, weight in kinds])
            kind(lines, fidelity, rng, counts)
        add(counts, 3)


def connect(path):
    while True:
        client = socket.socket(socket.AF_UNIX)
        try:
            client.connect(path)
            return client
        except OSError:
            client.close()
            time.sleep(0.05)


def add(counts, index, more=1):
    with counts.get_lock():
        counts[index] += more


def request(number, fidelity, rng, **more):
    return json.dumps({"id": number, "fidelity": fidelity, "scene": rng.randrange(2**31), **more}).encode() + b"\n"


def plain(lines, fidelity, rng, counts):
    """Asks in a window, reads everything, releases pictures unread, and hangs up."""
    total = rng.randrange(50, 800)
    want = {} if fidelity == "labels" else {"want": ["labels", "image"]}
    sent = answered = 0
    while answered < total:
        while sent < total and sent - answered < WINDOW:
            lines.write(request(sent, fidelity, rng, **want))
            sent += 1
        lines.flush()
        line = lines.readline()
        if b'"alive"' in line[:10]:
            continue
        answered += 1
        good = b'"frame_id"' in line and (answered % 500 != 1 or bool(json.loads(line)["labels"]["instances"]))
        if want and good:
            answer = json.loads(line)
            good = answer["arrays"]["image"]["shape"] == [SIZE[1], SIZE[0], 3]
            lines.write(json.dumps({"release": answer["id"]}).encode() + b"\n")
        judge(good, counts, line)


def judge(good, counts, line, index=0):
    add(counts, index if good else 2)
    if not good:
        print(f"not as it should be: {str(line)[:400]}", file=sys.stderr)


def with_arrays(lines, fidelity, rng, counts):
    want = ["ids", "depth"] + (["image"] if fidelity == "preview" else [])
    for number in range(rng.randrange(20, 200)):
        lines.write(request(number, fidelity, rng, want=want))
        lines.flush()
        answer = read_answer(lines)
        arrays = answer.get("arrays", {})
        try:
            read = pathlib.Path(arrays["path"]).read_bytes()
            good = len(read) == arrays["bytes"] and arrays["ids"]["shape"] == [SIZE[1], SIZE[0]]
        except (OSError, KeyError):
            good = False
        judge(good, counts, answer)
        if rng.random() < 0.9:  # what is kept goes with the client
            lines.write(json.dumps({"release": number}).encode() + b"\n")


def read_answer(lines):
    while True:
        answer = json.loads(lines.readline())
        if "alive" not in answer:
            return answer


def rude(lines, fidelity, rng, counts):
    """Leaves without having read what it asked for."""
    for number in range(40):
        lines.write(request(number, fidelity, rng, want=["labels", "ids"]))
    lines.flush()
    for _ in range(rng.randrange(10)):
        lines.readline()
        add(counts, 0)


def wrong(lines, fidelity, rng, counts):
    """Each of these is answered by an error, but what is cancelled may have been made before."""
    bad = [b"nonsense\n", b"[]\n", b'{"id": 1, "values": {"no such variable": 1}}\n', request(2, "best", rng), request(3, fidelity, rng, scene=-1),
           request(4, fidelity, rng, deadline_s=1e-9), request(5, "labels", rng, samples=3)]
    for line in bad:
        lines.write(line)
    lines.flush()
    for _ in bad:
        answer = read_answer(lines)
        judge("error" in answer, counts, answer, 1)
    for number in range(20):
        lines.write(request(number, fidelity, rng))
    for number in range(20):
        lines.write(json.dumps({"cancel": number}).encode() + b"\n")
    lines.flush()
    for _ in range(20):
        add(counts, 1 if "error" in read_answer(lines) else 0)


# ---- The report ----


def text_of(runs):
    yield "# A stream that is asked for very many frames"
    yield ""
    yield "Made by `tests/reliability/stream_soak.py` (`scripts/soak.sh stream`): `seedframe stream` with frames of"
    yield f"{SIZE[0]} × {SIZE[1]} pixels, asked by {CLIENTS} processes whose clients come and go. Watched from outside."
    for run in runs:
        yield from ["", f"## Fidelity {run.fidelity}: {run.answered:,} frames of `configs/{CONFIGS[run.fidelity]}.yaml`", ""]
        per_day = f", as many as one a second asks for in {run.answered / DAY:.1f} days" if run.answered >= DAY else ""
        yield (f"In {run.wall:.0f} s ({run.answered / max(run.wall, 1e-9):.0f} a second{per_day}), for {run.clients:,} clients, besides {run.errors:,} requests "
               "that were wrong, too late or cancelled.")
        yield from ["", "| | measured | target | |", "|---|---:|---:|---|"]
        for what, measured, target, met in run.verdicts():
            yield f"| {what} | {measured} | {target} | {'met' if met else 'missed'} |"
        yield from ["", "| frames answered | resident memory, MiB | open files | threads |", "|---:|---:|---:|---:|"]
        for each in spread(run.samples, 11):
            yield f"| {each.answered:,} | {mib(each.memory)} | {each.files} | {each.threads} |"
    yield ""


def spread(samples, most):
    count = min(most, len(samples))
    return [samples[round(i * (len(samples) - 1) / max(1, count - 1))] for i in range(count)]


def mib(count):
    return f"{count / 2**20:.1f}"


def told_yes(yes):
    return "yes" if yes else "no"


if __name__ == "__main__":
    sys.exit(main())
