"""A small classifier of patches, in the manner of Hess et al. (2017): 32 × 32 pixels in, one of the classes out."""

import numpy
import torch

from training import as_input, batches, convolution, relit, seeded, train

BATCH = 32
MOST_RATE = 4e-3


class Classifier(torch.nn.Module):
    def __init__(self, classes):
        super().__init__()
        self.layers = torch.nn.Sequential(
            convolution(3, 16), torch.nn.MaxPool2d(2), convolution(16, 32), torch.nn.MaxPool2d(2), convolution(32, 64),
            torch.nn.AdaptiveAvgPool2d(1), torch.nn.Flatten(), torch.nn.Linear(64, classes))

    def forward(self, images):
        return self.layers(images)


def trained_classifier(dataset, classes, steps, seed):
    random = seeded(seed)
    network = Classifier(classes).to(memory_format=torch.channels_last)
    order = batches(len(dataset.patches), BATCH, random)
    categories = torch.from_numpy(dataset.patch_categories)

    def loss():
        chosen = next(order)
        images = dataset.patches[chosen]
        flipped = random.random(len(chosen)) < 0.5
        images = numpy.where(flipped[:, None, None, None], images[:, :, ::-1], images)
        return torch.nn.functional.cross_entropy(network(relit(as_input(images), random)), categories[chosen])

    train(network, loss, steps, MOST_RATE)
    return network


def test_classifier(network, dataset):
    """Of each of the dataset's patches: was its class found?"""
    with torch.no_grad():
        return network(as_input(dataset.patches)).argmax(1).numpy() == dataset.patch_categories
