#!/usr/bin/python3
"""SIGKILL of the scheduler at random moments, again and again.

A campaign is submitted and killed at a moment drawn evenly from the duration of an undisturbed run (so also
while it starts and while it ends), resumed and killed again, until a run gets to its end; then the next
campaign, until there were enough kills. After each kill no worker may survive and nothing may be called done
that is not; each finished campaign must be the undisturbed one.

    tests/reliability/kill_scheduler.py [--kills N] [--blender fake|real] [--seed S] [--report FILE]
"""

import random
import signal
import sys
import time

import campaigns
import judge
import report

MOST_KILLS = 20  # of one campaign
SCENES = {"fake": 20, "real": 4, "labels": 40}


def main():
    parser = report.parser_of(__doc__)
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--blender", choices=sorted(SCENES), default="fake")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    begin = time.monotonic()
    with campaigns.program_of(options) as program:
        bench = campaigns.Bench(program, campaigns.KINDS[options.blender], SCENES[options.blender], workers=2)
        row = Killer(bench, random.Random(options.seed)).kill(options.kills)
    command = f"tests/reliability/kill_scheduler.py --blender {options.blender} --seed {options.seed}"
    text = [f"Made by `{command}`, which says how: *number* is how often the scheduler was killed.",
            f"Campaigns of {bench.frames} frames by 2 workers, {bench.seconds:.1f} s when undisturbed."]
    return report.finish(options, f"SIGKILL of the scheduler, {options.blender}", text, [row], begin)


class Killer:
    def __init__(self, bench, rng):
        self.bench = bench
        self.rng = rng
        self.row = report.Row(f"{bench.kind.name}, {bench.frames} frames")
        self.stretch = 1.0  # of the time until a kill: on a busy machine nothing would be done by then

    def kill(self, kills):
        while self.row.number < kills:
            self.bench.clear()
            # On a busy machine a run may take so long that none would ever get to its end.
            self._one_campaign(min(self.row.number + MOST_KILLS, kills))
            self.row.notes["campaigns"] += 1
            if self.row.number % 50 < 3:
                print(self.row, file=sys.stderr, flush=True)
        return self.row

    def _one_campaign(self, kills):
        """Runs until one gets to its end, as the first does after so many kills in all."""
        bench, program = self.bench, self.bench.program
        done = {}
        while True:
            store = judge.Store.read(bench.campaign, program.folder)
            exists = store is not None and len(store.frames) == bench.frames
            if not exists and bench.campaign.exists():
                how, complaints = bench.recover()
                self.row.notes[f"killed before it was a campaign, {how}"] += 1
                return self.row.blame(complaints, "a campaign that is not one yet")
            process = program.start(*(bench.resume() if exists else bench.submit()))
            moment = self.rng.uniform(0, bench.seconds * self.stretch)
            if self.row.number < kills:
                time.sleep(moment)
                process.send_signal(signal.SIGKILL)  # nothing happens if it has ended
            run = program.end(process)
            where = f"after {moment:.3f} s of {'resume' if exists else 'submit'}, kill {self.row.number}"
            if run.code != -signal.SIGKILL:
                self.row.notes["runs to the end"] += 1
                return self.row.blame(run.conduct(0) + bench.judge() + self._lost_since(done), where)
            self.row.number += 1
            store, complaints = bench.judge_now()
            self.row.blame(complaints + judge.survivors(program.folder) + self._lost_since(done), where)
            now = store.done() if store else {}
            if len(now) == len(done):
                self.stretch = min(4.0, 1.2 * self.stretch)
            done = now
            self.row.notes["frames found done after kills"] += len(done)

    def _lost_since(self, done):
        return judge.lost_since(done, judge.Store.read(self.bench.campaign, self.bench.program.folder))


if __name__ == "__main__":
    sys.exit(main())
