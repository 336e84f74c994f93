#!/usr/bin/python3
"""Files of a finished campaign are cut off at every length, and overwritten with zeros in blocks of 64 bytes.

After each damage come `status`, `export`, and `resume --verify`. None may end by a signal or an internal
error. An export that succeeds is that of the undisturbed campaign. A resume either says what is wrong and
names the file, or leaves the undisturbed campaign behind, every file of the dataset byte for byte.

Lengths below 512 all count, of longer ones every 64th. The log of SQLite (campaign.sqlite-wal) is that of a
killed scheduler.

    tests/reliability/damage_files.py [--every K] [--report FILE]
"""

import pathlib
import shutil
import signal
import sys
import time

import campaigns
import judge
import report

DENSE, STEP = 512, 64
INPUT, ENVIRONMENT, CORRUPT = 2, 4, 5  # exit codes
FRAME = pathlib.Path("frames/000/000001")
FILES = {
    campaigns.LABELS: ("campaign.sqlite", "campaign.yaml", "provenance.json", *(
        str(FRAME / name)
        for name in ("manifest.json", "labels.json", "frame.json", "instances.png", "depth.exr"))),
    campaigns.FAKE: tuple(str(FRAME / name) for name in ("passes.exr", "image.png")),
}


def main():
    parser = report.parser_of(__doc__)
    parser.add_argument("--every", type=int, default=1, help="only every Kth damage")
    options = parser.parse_args()
    begin = time.monotonic()
    rows = []
    with campaigns.program_of(options) as program:
        for kind, files in FILES.items():
            bench = campaigns.Bench(program, kind, scenes=1)
            damager = Damager(bench, bench.undisturbed)
            # A picture costs a fake Blender to make again.
            every = options.every * (1 if kind is campaigns.LABELS else 8)
            rows += [damager.damage(name, every) for name in files]
            if kind is campaigns.LABELS and program.can_fail:
                rows.append(Damager(bench, killed_while_running(bench)).damage("campaign.sqlite-wal", every))
    text = ["Made by `tests/reliability/damage_files.py`, which says how: *number* is how many damages were "
            "tried" + (f", every {options.every}th." if options.every > 1 else ".")]
    return report.finish(options, "Damaged files", text, rows, begin)


def killed_while_running(bench):
    """A campaign whose store's changes are mostly in its log."""
    frames = bench.campaign / "frames"
    last_rename = {"under": frames, "calls": "rename", "at": bench.frames, "do": "kill-after"}
    bench.clear()
    run = bench.program.run(*bench.submit(), faults=last_rename)
    if run.code != -signal.SIGKILL:
        sys.exit(f"the campaign that should have been killed ended with {run.code}")
    folder = bench.program.folder / "killed"
    shutil.move(bench.campaign, folder)
    return folder


class Damager:
    def __init__(self, bench, original):
        self.bench = bench
        self.original = original
        bench.copy_undisturbed()
        self._export()
        self.export = judge.contents(bench.campaign / "exports")
        self.dataset = dataset_of(bench.undisturbed)

    def damage(self, name, every):
        data = (self.original / name).read_bytes()
        row = report.Row(f"{name}, {self.bench.kind.name}")
        row.notes["bytes"] = len(data)
        for how, damaged in list(damages(data))[::every]:
            self.bench.clear()
            shutil.copytree(self.original, self.bench.campaign)
            (self.bench.campaign / name).write_bytes(damaged)
            row.number += 1
            row.blame(self._try(name, row), how)
        return row

    def _try(self, name, row):
        bench = self.bench
        complaints = bench.program.run("status", bench.campaign).conduct(0, INPUT, ENVIRONMENT, CORRUPT)
        run = self._export()
        complaints += run.conduct(0, INPUT, ENVIRONMENT, CORRUPT)
        if run.code == 0 and judge.contents(bench.campaign / "exports") != self.export:
            complaints.append(judge.Complaint("wrong done", "the export is another one"))
        run = bench.program.run(*bench.resume("--verify"))
        complaints += run.conduct(0, INPUT, ENVIRONMENT, CORRUPT)
        if run.code == 0:
            row.notes["mended"] += 1
            return complaints + bench.judge(repaired=True) + self._differences()
        row.notes[f"refused ({run.code})"] += 1
        named = [name, pathlib.Path(name).name, "campaign.sqlite"][:3 if "sqlite" in name else 2]
        if not any(each in run.errors for each in named):
            complaints.append(judge.Complaint("conduct", f"{name} is not named in {run.errors!r}"))
        return complaints

    def _export(self):
        return self.bench.program.run("export", self.bench.campaign, "--format", "coco")

    def _differences(self):
        now = dataset_of(self.bench.campaign)
        names = sorted(name for name in {*now, *self.dataset} if now.get(name) != self.dataset.get(name))
        return [judge.Complaint("torn", f"not as in the undisturbed campaign: {names}")] if names else []


def damages(data):
    """(description, damaged bytes) of a file."""
    last = len(data.rstrip(b"\n"))  # a text without its last line feed means the same
    for length in range(last):
        if length < DENSE or length % STEP == 0:
            yield f"cut off at {length}", data[:length]
    for start in range(0, len(data), STEP):
        end = min(start + STEP, len(data))
        zeroed = data[:start] + bytes(end - start) + data[end:]
        if zeroed != data:
            yield f"zeros from {start}", zeroed


def dataset_of(campaign):
    """What docs/formats/campaign.md calls dataset, exports apart."""
    files = [campaign / "campaign.yaml", campaign / "provenance.json", *campaign.glob("frames/*/*/*")]
    return {path.relative_to(campaign).as_posix(): judge.read_or_none(path) for path in files}


if __name__ == "__main__":
    sys.exit(main())
