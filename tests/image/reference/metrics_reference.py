#!/usr/bin/python3
"""Values of image metrics by other programs, which the tests of scheduler/image/ hold ours against.

Prints what is pinned in tests/image/ssim_test.cpp, flip_test.cpp and rendering_error_test.cpp. The pictures come from
a formula in whole numbers, the same as in tests/image/metric_pictures.h. Makes itself an environment with the versions
below under venv/metrics when it first runs.
"""

import os
import pathlib
import subprocess
import sys

PACKAGES = ["flip-evaluator==1.7", "numpy==1.26.4", "scikit-image==0.24.0"]
VENV = pathlib.Path(__file__).resolve().parents[3] / "venv" / "metrics"

if pathlib.Path(sys.prefix).resolve() != VENV.resolve():
    if not (VENV / "bin" / "python").exists():
        subprocess.run([sys.executable, "-m", "venv", str(VENV)], check=True)
    subprocess.run([str(VENV / "bin" / "python"), "-m", "pip", "install", "--quiet", *PACKAGES], check=True)
    os.execv(VENV / "bin" / "python", [str(VENV / "bin" / "python"), __file__])

import flip_evaluator
import numpy
from skimage.metrics import peak_signal_noise_ratio, structural_similarity


def reference_picture(width, height):
    """Blocks with a slope in each, of other colours side by side."""
    row, column, channel = numpy.mgrid[0:height, 0:width, 0:3]
    block = (row // 12 + column // 16) % 2
    return (90 * block + (2 * row + column + 50 * channel) % 120 + 20).astype(numpy.uint8)


def noisy_picture(width, height, amplitude):
    """With noise of up to `amplitude` codes either way, of a hash of the place."""
    row, column, channel = numpy.mgrid[0:height, 0:width, 0:3].astype(numpy.uint64)
    key = row * 73856093 ^ column * 19349663 ^ channel * 83492791
    hashed = key * 2654435761 % 2**32
    noise = (hashed >> 16).astype(numpy.int64) % (2 * amplitude + 1) - amplitude
    return numpy.clip(reference_picture(width, height) + noise, 0, 255).astype(numpy.uint8)


def linear_of(display):
    """Without rounding."""
    return (display / 64.0) ** 2


def ssim(reference, picture):
    return structural_similarity(reference, picture, gaussian_weights=True, sigma=1.5, use_sample_covariance=False,
                                 data_range=255, channel_axis=2)


def flip(reference, picture, pixels_per_degree):
    parameters = {} if pixels_per_degree is None else {"ppd": pixels_per_degree}
    error_map, mean, _ = flip_evaluator.evaluate(
        reference.astype(numpy.float32) / 255, picture.astype(numpy.float32) / 255, "LDR", inputsRGB=True,
        applyMagma=False, computeMeanError=True, parameters=parameters)
    return numpy.asarray(error_map).squeeze(), mean


for width, height, amplitude in [(64, 48, 8), (160, 120, 60), (23, 11, 3)]:
    reference = reference_picture(width, height)
    picture = noisy_picture(width, height, amplitude)
    error_map, mean = flip(reference, picture, None)
    _, mean_at_20 = flip(reference, picture, 20.0)
    x, r = linear_of(picture), linear_of(reference)
    gray = numpy.mean(r, axis=2, keepdims=True)
    print(f"{width} x {height}, amplitude {amplitude}")
    print(f"  psnr    {peak_signal_noise_ratio(reference, picture, data_range=255):.9f}")
    print(f"  ssim    {ssim(reference, picture):.9f}")
    print(f"  flip    {mean:.7f}, at row 5, column 7: {error_map[5, 7]:.6f}, in the corner: {error_map[0, 0]:.6f}")
    print(f"  flip at 20 pixels per degree {mean_at_20:.7f}")
    print(f"  mse     {numpy.mean((x - r)**2):.10f}")
    print(f"  rel_mse {numpy.mean((x - r)**2 / (r**2 + 0.01)):.10f}")
    print(f"  mrse    {numpy.mean((x - r)**2 / (gray + 0.01)**2):.10f}")
    print(f"  flip of the colours exchanged {flip(reference, reference[:, :, ::-1], None)[1]:.7f}")
