"""Rows of what was tried and what was found, as a table in Markdown; and the options of all scripts."""

import argparse
import collections
import dataclasses
import os
import pathlib
import sys
import time

import judge

HOME = pathlib.Path(__file__).resolve().parents[2]


@dataclasses.dataclass
class Row:
    """One line of a report."""
    what: str
    number: int = 0
    notes: collections.Counter = dataclasses.field(default_factory=collections.Counter)
    complaints: collections.Counter = dataclasses.field(default_factory=collections.Counter)

    def blame(self, complaints, where, reproduce=""):
        for complaint in complaints:
            print(f"FAILED {self.what}, {where}: {complaint.kind}: {complaint.text}", file=sys.stderr)
            self.complaints[complaint.kind] += 1
        if complaints and reproduce:
            print(f"       {reproduce}", file=sys.stderr, flush=True)


def parser_of(docstring):
    parser = argparse.ArgumentParser(description=docstring.splitlines()[0])
    build = HOME / "build" / "release"
    parser.add_argument("--build", type=pathlib.Path, default=build, help="its program is tested")
    parser.add_argument("--report", type=pathlib.Path, help="write the table there too")
    # SIGKILL loses nothing that was written, so waiting for a disk would prove nothing.
    memory = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
    parser.add_argument("--scratch", default=memory, help="where to put campaigns (default: in memory)")
    return parser


def finish(options, title, text, rows, begin):
    """Prints the table, writes it, and returns the exit code."""
    table = "\n".join(["# " + title, "", *text, "", *table_of(rows), "", *legend(), "",
                       f"Took {time.monotonic() - begin:.0f} s.", ""])
    print(table)
    if options.report:
        options.report.parent.mkdir(parents=True, exist_ok=True)
        options.report.write_text(table, encoding="utf-8")
    return 1 if any(row.complaints for row in rows) else 0


def table_of(rows):
    kinds = list(judge.KINDS_OF_COMPLAINT)
    yield f"| what | number | {' | '.join(kinds)} | notes |"
    yield "|---|---:|" + "---:|" * len(kinds) + "---|"
    for row in rows:
        counts = " | ".join(str(row.complaints[kind]) for kind in kinds)
        notes = "; ".join(f"{count:,} {note}" for note, count in row.notes.items())
        yield f"| {row.what} | {row.number:,} | {counts} | {notes} |"


def legend():
    yield "The columns count faults found, so 0 is right: " + "; ".join(
        f"*{kind}*: {meaning}" for kind, meaning in judge.KINDS_OF_COMPLAINT.items()) + "."
