"""A small detector of objects: a network of a quarter of a million weights that says what targets() of boxes.py says."""

import numpy
import torch

from average_precision import match
from boxes import STRIDE, boxes_of, mirrored, moved, targets
from training import as_input, batches, convolution, relit, seeded, train

BATCH = 8
MOST_RATE = 4e-3
MOST_MOVE_PX = 8


class Detector(torch.nn.Module):
    """A pyramid down to a stride of 16 and up again to STRIDE."""

    def __init__(self, classes):
        super().__init__()
        self.at_4 = torch.nn.Sequential(convolution(3, 16, 2), convolution(16, 32, 2), convolution(32, 32))
        self.at_8 = torch.nn.Sequential(convolution(32, 64, 2), convolution(64, 64))
        self.at_16 = torch.nn.Sequential(convolution(64, 96, 2), convolution(96, 96))
        self.up_8, self.side_8 = convolution(96, 48, size=1), convolution(64, 48, size=1)
        self.up_4, self.side_4 = convolution(48, 32), convolution(32, 32, size=1)
        self.head = convolution(32, 48)
        self.heat, self.sides = torch.nn.Conv2d(48, classes, 1), torch.nn.Conv2d(48, 4, 1)
        torch.nn.init.constant_(self.heat.bias, -4)  # few cells are the middle of something

    def forward(self, images):
        """Logits of heat [n, classes, rows, columns], and sides [n, 4, rows, columns] in pixels."""
        at_4 = self.at_4(images)
        at_8 = self.at_8(at_4)
        up = self.side_8(at_8) + torch.nn.functional.interpolate(self.up_8(self.at_16(at_8)), scale_factor=2)
        up = self.head(self.side_4(at_4) + torch.nn.functional.interpolate(self.up_4(up), scale_factor=2))
        return self.heat(up), torch.exp(self.sides(up).clamp(-4, 3)) * 2 * STRIDE


def heat_loss(logits, heat):
    """CenterNet's focal loss, a sum."""
    sure = torch.sigmoid(logits).clamp(1e-4, 1 - 1e-4)
    middle = heat == 1
    missed = -((1 - sure) ** 2 * torch.log(sure))[middle].sum()
    invented = -((1 - heat) ** 4 * sure ** 2 * torch.log(1 - sure))[~middle].sum()
    return missed + invented


def sides_loss(found, true, weights):
    """1 − generalised IoU (Rezatofighi et al. 2019) of the boxes in each cell, a weighted sum."""
    def area(sides):
        return (sides[:, 0] + sides[:, 2]) * (sides[:, 1] + sides[:, 3])
    inner, outer = torch.minimum(found, true), torch.maximum(found, true)
    both = (inner[:, 0] + inner[:, 2]).clamp(min=0) * (inner[:, 1] + inner[:, 3]).clamp(min=0)
    union = area(found) + area(true) - both + 1e-6
    around = area(outer) + 1e-6
    return ((1 - both / union + (around - union) / around) * weights).sum()


def example(dataset, index, classes, random):
    """A picture, perhaps mirrored and moved, and its targets."""
    image, boxes = dataset.images[index], dataset.boxes[index]
    height, width, _ = image.shape
    if random.random() < 0.5:
        image, boxes = image[:, ::-1], mirrored(boxes, width)
    dx, dy = random.integers(-MOST_MOVE_PX, MOST_MOVE_PX + 1, 2)
    framed = numpy.pad(image, ((MOST_MOVE_PX, MOST_MOVE_PX), (MOST_MOVE_PX, MOST_MOVE_PX), (0, 0)), mode="edge")
    image = framed[MOST_MOVE_PX - dy:MOST_MOVE_PX - dy + height, MOST_MOVE_PX - dx:MOST_MOVE_PX - dx + width]
    boxes, kept = moved(boxes, dx, dy, width, height)
    return image, *targets(boxes[kept], dataset.categories[index][kept], classes, width, height)


def trained_detector(dataset, classes, steps, seed):
    random = seeded(seed)
    network = Detector(classes).to(memory_format=torch.channels_last)
    order = batches(len(dataset.images), BATCH, random)

    def loss():
        images, heat, sides, weights = (numpy.stack(each) for each in zip(
            *(example(dataset, index, classes, random) for index in next(order))))
        found_heat, found_sides = network(relit(as_input(images), random))
        objects = max(1, weights.sum())
        return (heat_loss(found_heat, torch.from_numpy(heat)) +
                5 * sides_loss(found_sides, torch.from_numpy(sides), torch.from_numpy(weights))) / objects

    train(network, loss, steps, MOST_RATE)
    return network


def test_detector(network, dataset, classes):
    """The match of each of the dataset's pictures."""
    with torch.no_grad():
        heat, sides = network(as_input(dataset.images))
    matches = []
    for index, (answer, around) in enumerate(zip(torch.sigmoid(heat).numpy(), sides.numpy())):
        found = boxes_of(answer, around)
        matches.append(match(*found, dataset.boxes[index], dataset.categories[index], classes))
    return matches
