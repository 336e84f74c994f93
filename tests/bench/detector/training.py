"""What both networks are trained with."""

import numpy
import torch

MEAN, SPREAD = 0.45, 0.25  # of pictures, about


def as_input(images):
    """Pictures [n, height, width, 3] of 8 bits as the networks take them [n, 3, height, width]."""
    tensor = torch.from_numpy(numpy.ascontiguousarray(images)).permute(0, 3, 1, 2)
    return ((tensor.float() / 255 - MEAN) / SPREAD).contiguous(memory_format=torch.channels_last)


def relit(images, random):
    """The inputs, each brighter or darker and with more or less contrast by up to a fifth."""
    count = len(images)
    gain = torch.from_numpy(random.uniform(0.8, 1.2, (count, 1, 1, 1)).astype(numpy.float32))
    shift = torch.from_numpy(random.uniform(-0.2, 0.2, (count, 1, 1, 1)).astype(numpy.float32))
    return images * gain + shift


def convolution(inputs, outputs, stride=1, size=3):
    return torch.nn.Sequential(torch.nn.Conv2d(inputs, outputs, size, stride, size // 2, bias=False),
                               torch.nn.BatchNorm2d(outputs), torch.nn.ReLU(inplace=True))


def train(network, loss_of, steps, most_rate):
    """Takes `steps` steps down what loss_of() returns: one rise and fall of the rate (Smith's one-cycle), AdamW."""
    network.train()
    optimizer = torch.optim.AdamW(network.parameters(), lr=most_rate, weight_decay=1e-2)
    rates = torch.optim.lr_scheduler.OneCycleLR(optimizer, most_rate, total_steps=steps, pct_start=0.2)
    for _ in range(steps):
        optimizer.zero_grad()
        loss_of().backward()
        torch.nn.utils.clip_grad_norm_(network.parameters(), 10)
        optimizer.step()
        rates.step()
    network.eval()


def batches(count, size, random):
    """Endless: `size` indices each time, all of 0 … count − 1 before any comes again."""
    waiting = numpy.zeros(0, int)
    while True:
        while len(waiting) < size:
            waiting = numpy.concatenate([waiting, random.permutation(count)])
        yield waiting[:size]
        waiting = waiting[size:]


def seeded(seed):
    """Weights and batches of this training all follow from its seed."""
    torch.manual_seed(seed)
    return numpy.random.default_rng(seed)
