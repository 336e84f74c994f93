#!/usr/bin/env python3
"""Holds CMakeLists.txt's list of modules against what the sources include, and the sources against the house's limits.

A module may include what is named behind it, headers only what is behind PUBLIC, and nothing may be named there that
no file needs. No module has more than 40 files, no file of ours more than 400 lines. Exits with 1 and a line for each
finding.
"""

import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
MOST_FILES = 40
MOST_LINES = 400
KINDS = ("PUBLIC", "PRIVATE", "LIBRARIES", "PRIVATE_LIBRARIES")


def declared_modules():
    """Name -> {"PUBLIC": set, "PRIVATE": set}, as CMakeLists.txt has them."""
    modules = {}
    for call in re.findall(r"^seedframe_module\(([^)]*)\)", (ROOT / "CMakeLists.txt").read_text(), re.M):
        words = call.split()
        uses = {kind: set() for kind in KINDS}
        kind = None
        for word in words[1:]:
            if word in KINDS:
                kind = word
            else:
                uses[kind].add(word)
        modules[words[0]] = uses
    return modules


def included_modules(file):
    return set(re.findall(r'^#include "([a-z_]+)/', file.read_text(), re.M))


def edge_faults(name, uses, files):
    needed = {"PUBLIC": set(), "PRIVATE": set()}
    for file in files:
        needed["PUBLIC" if file.suffix == ".h" else "PRIVATE"] |= included_modules(file) - {name}
    for module in sorted(needed["PUBLIC"] - uses["PUBLIC"]):
        yield f"CMakeLists.txt: headers of {name} include {module}, which is not PUBLIC there"
    for module in sorted(needed["PRIVATE"] - uses["PUBLIC"] - uses["PRIVATE"]):
        yield f"CMakeLists.txt: sources of {name} include {module}, which is not named there"
    for module in sorted(uses["PUBLIC"] - needed["PUBLIC"]):
        yield f"CMakeLists.txt: {name} names {module} as PUBLIC, and none of its headers needs it"
    for module in sorted(uses["PRIVATE"] - needed["PRIVATE"]):
        yield f"CMakeLists.txt: {name} names {module}, and none of its files needs it"


def tracked_files(*patterns):
    listed = subprocess.run(["git", "ls-files", *patterns], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    return [ROOT / line for line in listed.splitlines() if (ROOT / line).exists()]


def faults():
    modules = declared_modules()
    folders = {path.name for path in (ROOT / "scheduler").iterdir() if path.is_dir()}
    for name in sorted(folders - set(modules) - {"cli"}):
        yield f"CMakeLists.txt: there is no seedframe_module for scheduler/{name}"
    for name, uses in modules.items():
        files = sorted((ROOT / "scheduler" / name).glob("*.*"))
        yield from edge_faults(name, uses, files)
    for name in sorted(folders):
        count = len(list((ROOT / "scheduler" / name).glob("*.*")))
        if count > MOST_FILES:
            yield f"scheduler/{name} has {count} files: part it, {MOST_FILES} are the most"
    for file in tracked_files("*.cpp", "*.h", "*.py"):
        lines = file.read_text().count("\n")
        if lines > MOST_LINES:
            yield f"{file.relative_to(ROOT)} has {lines} lines: part it, {MOST_LINES} are the most"


if __name__ == "__main__":
    found = list(faults())
    print("\n".join(found))
    sys.exit(1 if found else 0)
