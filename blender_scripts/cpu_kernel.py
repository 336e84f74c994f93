"""Which of its CPU kernels Cycles runs: images differ in their last bits between them."""

import os

_AVX2 = {"avx2", "fma", "f16c", "bmi1", "bmi2"}
# Best first, with the CPU flags that a kernel needs and the variable that forbids it.
_KERNELS = (
    ("avx2", _AVX2, "CYCLES_CPU_NO_AVX2"),
    ("avx", {"avx"}, "CYCLES_CPU_NO_AVX"),
    ("sse41", {"sse4_1"}, "CYCLES_CPU_NO_SSE41"),
    ("sse3", {"pni", "ssse3"}, "CYCLES_CPU_NO_SSE3"),
    ("sse2", {"sse2"}, "CYCLES_CPU_NO_SSE2"),
)
_REMOVED_IN_4_0 = {"avx", "sse3"}


def choose(flags, environment, blender_version):
    """The kernel for a CPU with these flags. Cycles uses one only if all lesser ones are allowed."""
    best = "generic"
    for name, needed, forbidding in reversed(_KERNELS):
        if forbidding in environment or not needed <= flags:
            break
        if blender_version < (4, 0, 0) or name not in _REMOVED_IN_4_0:
            best = name
    return best


def current(blender_version):
    return choose(_cpu_flags(), os.environ, blender_version)


def _cpu_flags():
    try:
        with open("/proc/cpuinfo", encoding="ascii", errors="replace") as lines:
            for line in lines:
                key, _, value = line.partition(":")
                if key.strip() == "flags":
                    return set(value.split())
    except OSError:
        pass
    return set()
