#!/usr/bin/env python3
"""How many samples are worth their time, to a detector and a classifier that learn from the frames? Makes results/detector/.

The same scenes are rendered with 64 to 1 samples, plain and denoised; a small detector and a small patch classifier learn
from each dataset, and are tested on converged frames of other scenes. Then again with as many frames as can be
rendered in the same CPU time. Runs in venv/torch (scripts/torch_wheels.sh):

    venv/torch/bin/python tests/bench/detector/study.py [--full] [--report DIR] [--work DIR] [--blender BLENDER]

Without --full a short version of one training each, which tells that all works and little more. What a folder --work
holds of an earlier run is not done again.
"""

import argparse
import concurrent.futures
import dataclasses
import multiprocessing
import os
import pathlib
import pickle
import sys
import tempfile

import numpy
import torch

from campaigns import HOME, Campaigns, Setting
from classifier import test_classifier, trained_classifier
from detector import test_detector, trained_detector
from report import write_report
from scores import Outcome, differences, scores_of, spread_of_seeds

TRAIN_SEED, MORE_SEED, TEST_SEED = 101, 102, 103  # of the scenes
STARTUP_FRAMES = 2


@dataclasses.dataclass(frozen=True)
class Study:
    settings: tuple          # the first is what all are compared with
    frames: int              # of each
    budget_frames: int       # so many frames of the first setting cost what each dataset of the same time costs
    budget_settings: tuple
    test: Setting
    test_frames: int
    trainings: int           # with each dataset, of seeds of their own
    detector_steps: int
    classifier_steps: int

    def with_only(self, names, budget_names):
        """Those of the settings that are named, in that order."""
        def chosen(settings, wanted):
            of_names = {setting.name(): setting for setting in settings}
            return tuple(of_names[name] for name in wanted)
        return dataclasses.replace(self, settings=chosen(self.settings, names),
                                   budget_settings=chosen(self.budget_settings, budget_names))


FULL = Study(
    settings=tuple(Setting(samples, denoised) for denoised in (False, True) for samples in (64, 16, 4, 2, 1)),
    frames=80, budget_frames=20,
    budget_settings=(Setting(64), Setting(4), Setting(1), Setting(4, True), Setting(1, True), Setting(16)),
    test=Setting(256, threshold=0.03), test_frames=48, trainings=3, detector_steps=300, classifier_steps=300)
QUICK = Study(
    settings=(Setting(64), Setting(4), Setting(1), Setting(4, True)),
    frames=48, budget_frames=24, budget_settings=(Setting(64), Setting(4), Setting(4, True)),
    test=Setting(128, threshold=0.05), test_frames=32, trainings=1, detector_steps=240, classifier_steps=250)


@dataclasses.dataclass
class Rendered:
    """A dataset, and what it cost."""
    setting: Setting
    frames: int
    cpu_s: float
    dataset: object


class Bench:
    def __init__(self, study, campaigns, report_only):
        self.study = study
        self.report_only = report_only
        self.campaigns = campaigns
        self.test, self.classes = self._test()
        self.startup_s = self._startup_s()

    def _test(self):
        self.campaigns.render("test", self.study.test, TEST_SEED, self.study.test_frames)
        return self.campaigns.load("test")

    def _startup_s(self):
        """CPU seconds of a submission that are not of its frames, from a short and a long one."""
        short = self.campaigns.render("startup", Setting(1), TRAIN_SEED, STARTUP_FRAMES)
        long = self.campaigns.render("1", Setting(1), TRAIN_SEED, self.study.frames)
        return max(0.0, short - STARTUP_FRAMES * (long - short) / (self.study.frames - STARTUP_FRAMES))

    def _rendered(self, name, setting, seed, frames):
        seconds = self.campaigns.render(name, setting, seed, frames) - self.startup_s
        dataset, _ = self.campaigns.load(name)
        return Rendered(setting, frames, seconds, dataset)

    def of_same_frames(self):
        return {setting.name(): self._rendered(setting.name(), setting, TRAIN_SEED, self.study.frames)
                for setting in self.study.settings}

    def of_same_time(self, rendered):
        """As many frames of each setting as cost what budget_frames of the first do: the first of those that there are,
        or all of them and more."""
        def per_frame(setting):
            return rendered[setting.name()].cpu_s / self.study.frames
        budget = self.study.budget_frames * per_frame(self.study.settings[0])
        found = {}
        for setting in self.study.budget_settings:
            there = rendered[setting.name()]
            frames = round(budget / per_frame(setting))
            name = f"more-{setting.name()}"
            if frames <= self.study.frames:
                found[name] = Rendered(setting, frames, frames * per_frame(setting), there.dataset.first(frames))
            else:
                more = self._rendered(name, setting, MORE_SEED, frames - self.study.frames)
                found[name] = Rendered(setting, frames, there.cpu_s + more.cpu_s, there.dataset.joined(more.dataset))
        return found

    def outcome(self, name, dataset, seed):
        """Of one training, or that of an earlier run; None if there is none and none is to be made."""
        file = self.campaigns.folder / f"{name}-trained-{seed}.pickle"
        if not file.exists():
            if self.report_only:
                return None
            classes = len(self.classes)
            detector = trained_detector(dataset, classes, self.study.detector_steps, seed)
            classifier = trained_classifier(dataset, classes, self.study.classifier_steps, seed)
            right = test_classifier(classifier, self.test)
            frames = len(self.test.images)
            outcome = Outcome(test_detector(detector, self.test, classes),
                              numpy.bincount(self.test.patch_frames, right, minlength=frames),
                              numpy.bincount(self.test.patch_frames, minlength=frames))
            file.write_bytes(pickle.dumps(outcome))
            told = ", ".join(f"{metric} {values[0]:.1f}" for metric, values in scores_of([outcome]).items())
            print(f"{name}, training {seed}: {told}", file=sys.stderr, flush=True)
        return pickle.loads(file.read_bytes())

    def outcomes(self, rendered):
        """Of each dataset those of its trainings. As many train at once as there are cores, with a thread each."""
        jobs = [(name, seed) for seed in range(self.study.trainings) for name in rendered]
        torch.set_num_threads(1)
        torch.use_deterministic_algorithms(True)
        fork = multiprocessing.get_context("fork")  # datasets are not copied
        with concurrent.futures.ProcessPoolExecutor(os.cpu_count(), mp_context=fork) as trainers:
            waiting = [trainers.submit(self.outcome, name, rendered[name].dataset, seed) for name, seed in jobs]
            found = {name: [] for name in rendered}
            for (name, _), each in zip(jobs, waiting):
                found[name] += [each.result()] if each.result() else []
        return {name: each for name, each in found.items() if each}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--full", action="store_true", help="the whole study: about an hour on two idle cores")
    parser.add_argument("--report", type=pathlib.Path, help="folder to write tables and charts to")
    parser.add_argument("--work", type=pathlib.Path, help="keep datasets and trainings there (default: a folder that goes)")
    parser.add_argument("--trainings", type=int, help="with each dataset")
    parser.add_argument("--settings", nargs="+", metavar="NAME", help="only these, such as 64 4 4-denoised; all are "
                        "compared with the first")
    parser.add_argument("--same-time", nargs="+", metavar="NAME", help="of these, those with as many frames as the same "
                        "time renders (default: all that are asked for)")
    parser.add_argument("--report-only", action="store_true", help="train nothing: report what --work has of trainings")
    parser.add_argument("--blender", default=f"python:{HOME}/venv/blender-4.5")
    parser.add_argument("--program", type=pathlib.Path, default=HOME / "build/release/seedframe")
    options = parser.parse_args()
    study = FULL if options.full else QUICK
    if options.trainings:
        study = dataclasses.replace(study, trainings=options.trainings)
    names = options.settings or [setting.name() for setting in study.settings]
    study = study.with_only(names, options.same_time or [each.name() for each in study.budget_settings
                                                         if each.name() in names])
    with tempfile.TemporaryDirectory(prefix="seedframe-detector-") as scratch:
        campaigns = Campaigns(options.program, options.blender, options.work or pathlib.Path(scratch))
        bench = Bench(study, campaigns, options.report_only)
        same_frames = bench.of_same_frames()
        rendered = {**same_frames, **bench.of_same_time(same_frames)}
        outcomes = bench.outcomes(rendered)
        rendered = {name: rendered[name] for name in outcomes}
        write_report(options.report, study, campaigns, told(bench, rendered, outcomes),
                     {**{name: each.dataset for name, each in same_frames.items()}, "test": bench.test})


def told(bench, rendered, outcomes):
    """All figures of the study, as JSON may have them."""
    base = bench.study.settings[0].name()
    scores = {name: scores_of(each) for name, each in outcomes.items()}
    spread = spread_of_seeds(list(scores.values()))
    scenes = [name for name in outcomes if not name.startswith("more-")]
    budget = rendered[f"more-{base}"].cpu_s
    # Of settings that were not rendered for all of the time, what is there, if it fits.
    affordable = [name for name in outcomes if name.startswith("more-") or
                  (f"more-{name}" not in outcomes and rendered[name].cpu_s <= budget)]
    against = {"same_scenes": differences({name: outcomes[name] for name in scenes}, base, spread),
               "same_time": differences({name: outcomes[name] for name in affordable}, f"more-{base}", spread)}
    return {
        "startup_cpu_s": bench.startup_s,
        "test": {"frames": len(bench.test.images), "objects": int(sum(map(len, bench.test.boxes)))},
        "spread_of_seeds": spread,
        "datasets": [{"name": name, "samples": each.setting.samples, "denoised": each.setting.denoised,
                      "frames": each.frames, "cpu_s": each.cpu_s,
                      "objects": int(sum(map(len, each.dataset.boxes))), "scores": scores[name],
                      "against": {comparison: of[name] for comparison, of in against.items() if name in of}} for name, each in rendered.items()]}


if __name__ == "__main__":
    main()
