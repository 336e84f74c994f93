#!/usr/bin/python3
"""SIGKILL at every call that changes a file: before it, in the middle of what it writes, and after it.

For a submit, a resume of a half-finished campaign, and an export, the calls of an undisturbed run are counted
(faulty_io.so). Then the verb is run again for each of them, killed there, and the campaign is brought back as
a user would: with `resume`. What comes of it must be the undisturbed campaign, byte for byte.

    tests/reliability/kill_at_every_call.py [--kinds labels,fake] [--every K] [--report FILE]

--every K takes every Kth call only, another one for each way of killing.
"""

import signal
import sys
import time

import campaigns
import cases
import report

WAYS = ("kill", "kill-within", "kill-after")


def main():
    parser = report.parser_of(__doc__)
    parser.add_argument("--kinds", default="labels,fake")
    parser.add_argument("--every", type=int, default=1)
    options = parser.parse_args()
    begin = time.monotonic()
    rows = []
    with campaigns.program_of(options, preload=True) as program:
        for name in options.kinds.split(","):
            bench = campaigns.Bench(program, campaigns.KINDS[name], scenes=1)
            rows.append(sweep(cases.Submit(bench), options.every))
            rows.append(sweep(cases.Resume(bench), options.every))
        rows.append(sweep(cases.Export(bench), options.every))
    text = ["Made by `tests/reliability/kill_at_every_call.py`, which says how: *number* is how often the",
            "program was killed. Every call of a verb that changes a file below the campaign's folder",
            "counts, three times: killed before it, after half of what it writes, and after it" +
            (f"; here every {options.every}th." if options.every > 1 else ".")]
    return report.finish(options, "SIGKILL at every call", text, rows, begin)


def sweep(case, every):
    """Kills at each call; a Row."""
    program, bench = case.bench.program, case.bench
    row = report.Row(f"{case.name}, {bench.kind.name}")
    log = program.folder / "calls.txt"
    calls = case.count(log)
    row.notes["calls"] = calls
    for number in range(1, calls + 1):
        for phase, way in enumerate(WAYS):
            if (number + phase * every // len(WAYS)) % every != 0:
                continue
            case.prepare()
            log.unlink(missing_ok=True)
            faults = {"under": bench.campaign, "log": log, "at": number, "do": way}
            run = program.run(*case.command(), faults=faults)
            if run.code != -signal.SIGKILL:
                row.notes["ended before (threads)"] += 1
            row.number += run.code == -signal.SIGKILL
            complaints = run.conduct(0, -signal.SIGKILL) + case.bring_back(row)
            row.blame(complaints, f"{way} at call {cases.line_of(log, number)}",
                      program.reproduce({**faults, "log": "calls.txt"}, *case.command()))
    return row


if __name__ == "__main__":
    sys.exit(main())
