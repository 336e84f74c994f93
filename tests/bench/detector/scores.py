"""How accurate trainings are, and by how much such figures are wrong.

Two noises are told apart. Trainings that differ in nothing but their seed differ in their scores; that spread is taken
from all datasets together, as there are few seeds. And the test pictures are a sample of what could have been tested on:
they are drawn again, with replacement, for all datasets alike, since a hard picture is hard for all.
"""

import dataclasses
import math

import numpy

from average_precision import average_precision

METRICS = ("ap", "ap50", "top1")
RESAMPLES = 200


@dataclasses.dataclass
class Outcome:
    """One training of each of the two networks, tested."""
    matches: list          # of each test picture, the detector's
    right: numpy.ndarray   # [pictures]: patches whose class was found
    patches: numpy.ndarray  # [pictures]: patches that there are

    def scores(self, pictures):
        """In percent, over these test pictures; a picture may come more than once."""
        precision = average_precision([self.matches[each] for each in pictures])
        return {"ap": 100 * precision.mean(), "ap50": 100 * precision[0],
                "top1": 100 * self.right[pictures].sum() / self.patches[pictures].sum()}


def scores_of(outcomes):
    """Of each metric the scores of the seeds, over all test pictures."""
    each = [outcome.scores(numpy.arange(len(outcome.matches))) for outcome in outcomes]
    return {metric: [float(one[metric]) for one in each] for metric in METRICS}


def spread_of_seeds(scores):
    """Of each metric: the standard deviation between trainings, from the scores_of() all datasets; 0 where none has two."""
    spread = {}
    for metric in METRICS:
        several = [each[metric] for each in scores if len(each[metric]) > 1]
        squares = sum(len(each) * numpy.var(each) for each in several)
        spread[metric] = math.sqrt(squares / max(1, sum(len(each) - 1 for each in several)))
    return spread


def resampled(outcomes, random):
    """Of each metric the means over seeds [RESAMPLES], each over another sample of the test pictures."""
    pictures = len(outcomes[0].matches)
    found = {metric: [] for metric in METRICS}
    for _ in range(RESAMPLES):
        sample = random.integers(0, pictures, pictures)
        each = [outcome.scores(sample) for outcome in outcomes]
        for metric in METRICS:
            found[metric].append(numpy.mean([one[metric] for one in each]))
    return {metric: numpy.array(values) for metric, values in found.items()}


def differences(outcomes, base, spread):
    """Of each dataset and metric: by how much it scores more than the dataset `base`, and the standard error of that
    for both noises. `outcomes`: of each dataset its trainings'; `spread`: the spread_of_seeds() of all."""
    scores = {name: scores_of(each) for name, each in outcomes.items()}
    drawn = {name: resampled(each, numpy.random.default_rng(1)) for name, each in outcomes.items()}
    return {name: {metric: (float(numpy.mean(scores[name][metric]) - numpy.mean(scores[base][metric])),
                            math.sqrt(spread[metric] ** 2 * (1 / len(outcomes[name]) + 1 / len(outcomes[base])) +
                                      numpy.var(drawn[name][metric] - drawn[base][metric], ddof=1)))
                   for metric in METRICS} for name in outcomes}
