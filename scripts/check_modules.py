#!/usr/bin/env python3
"""Holds the lists of modules and of tests in CMake against what the sources include, and the sources against the
house's limits.

A module may include what is named behind it, headers only what is behind PUBLIC, and nothing may be named there that
no file needs. A test may include its module, what that has behind PUBLIC, and what is named behind the test. No two
types have one name, which linkers would take for one type. No module has more than 40 files, no file of ours more than
400 lines. Exits with 1 and a line for each finding.
"""

import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
MOST_FILES = 40
MOST_LINES = 400
MODULE_KINDS = ("PUBLIC", "PRIVATE", "LIBRARIES", "PRIVATE_LIBRARIES")
TEST_KINDS = ("USES", "BLENDER_USES", "LIBRARIES")


def declared(file, function, kinds):
    """The calls of a CMake function: name -> {kind: set of words}."""
    found = {}
    for call in re.findall(rf"^{function}\(([^)]*)\)", (ROOT / file).read_text(), re.M):
        words = call.split()
        uses = {kind: set() for kind in kinds}
        kind = None
        for word in words[1:]:
            if word in kinds:
                kind = word
            else:
                uses[kind].add(word)
        found[words[0]] = uses
    return found


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


def public_modules(module, modules):
    """The module, and what its headers lead to."""
    found = {module} & set(modules)
    for used in modules.get(module, {"PUBLIC": ()})["PUBLIC"]:
        found |= public_modules(used, modules)
    return found


def included_with_fixtures(files):
    """The modules that these files of tests include, and the headers of tests that they include."""
    found, seen, waiting = set(), set(), list(files)
    while waiting:
        file = waiting.pop()
        if file not in seen:
            seen.add(file)
            found |= included_modules(file)
            waiting += [ROOT / header for header in re.findall(r'^#include "(tests/[^"]+)"', file.read_text(), re.M)]
    return found


def test_faults(name, uses, modules):
    for kind, folder in (("USES", ROOT / "tests" / name), ("BLENDER_USES", ROOT / "tests" / name / "blender")):
        needed = included_with_fixtures(folder.glob("*.cpp")) & set(modules)
        for module in sorted(needed - set().union(*(public_modules(used, modules) for used in {name} | uses[kind]))):
            yield f"tests/CMakeLists.txt: {folder.relative_to(ROOT)} includes {module}, which is not behind {kind}"
        for module in sorted(uses[kind] - needed):
            yield f"tests/CMakeLists.txt: {name} has {module} behind {kind}, and no test needs it"


def tracked_files(*patterns):
    listed = subprocess.run(["git", "ls-files", *patterns], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    return [ROOT / line for line in listed.splitlines() if (ROOT / line).exists()]


def shared_types(file):
    """Names of the types that a file defines outside of functions, types and unnamed namespaces."""
    text = re.sub(r"^namespace \{\n.*?^\}  // namespace\n", "", file.read_text(), flags=re.M | re.S)
    return re.findall(r"^(?:struct|class|enum class|enum) (?:\w+ )?(\w+)(?: final)?(?: :[^;]*?)?\s*\{", text, re.M)


def type_faults(files):
    places = {}
    for file in files:
        for name in shared_types(file):
            places.setdefault(name, []).append(str(file.relative_to(ROOT)))
    for name, where in sorted(places.items()):
        if len(where) > 1:
            yield f"there are several types {name}: {', '.join(where)}"


def faults():
    modules = declared("CMakeLists.txt", "seedframe_module", MODULE_KINDS)
    tests = declared("tests/CMakeLists.txt", "seedframe_test", TEST_KINDS)
    folders = {path.name for path in (ROOT / "scheduler").iterdir() if path.is_dir()}
    for name in sorted(folders - set(modules) - {"cli"}):
        yield f"CMakeLists.txt: there is no seedframe_module for scheduler/{name}"
    for name, uses in modules.items():
        files = sorted((ROOT / "scheduler" / name).glob("*.*"))
        yield from edge_faults(name, uses, files)
    tested = {path.parent.name for path in (ROOT / "tests").glob("*/*_test.cpp")}
    for name in sorted(tested - set(tests)):
        yield f"tests/CMakeLists.txt: there is no seedframe_test for tests/{name}"
    for name, uses in tests.items():
        yield from test_faults(name, uses, modules)
    for name in sorted(folders):
        count = len(list((ROOT / "scheduler" / name).glob("*.*")))
        if count > MOST_FILES:
            yield f"scheduler/{name} has {count} files: part it, {MOST_FILES} are the most"
    yield from type_faults(tracked_files("scheduler/*.h", "scheduler/*.cpp"))
    for file in tracked_files("*.cpp", "*.h", "*.py"):
        lines = file.read_text().count("\n")
        if lines > MOST_LINES:
            yield f"{file.relative_to(ROOT)} has {lines} lines: part it, {MOST_LINES} are the most"


if __name__ == "__main__":
    found = list(faults())
    for line in found:
        print(line)
    sys.exit(1 if found else 0)
