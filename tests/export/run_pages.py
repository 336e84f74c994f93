#!/usr/bin/python3
"""Runs what the pages of the export formats tell users to write.

    run_pages.py EXPORTS_DIR

Every block marked "python tested" in docs/formats/*.md is run with OUT replaced by the folder, unless the export that it
reads is not there. Prints a line for each; exits with 1 if any fails, or yields nothing.
"""

import pathlib
import re
import sys

PRELUDE = "import glob, json, tarfile\nimport xml.etree.ElementTree\nimport numpy\nimport PIL.Image\n"
PAGES = pathlib.Path(__file__).resolve().parents[2] / "docs" / "formats"


def main():
    folder = sys.argv[1]
    failed = ran = 0
    for page in sorted(PAGES.glob("*.md")):
        for code in re.findall(r"^```python tested\n(.*?)^```", page.read_text(encoding="utf-8"), re.S | re.M):
            export = re.search(r"OUT/([a-z-]+)", code).group(1)
            if not (pathlib.Path(folder) / export).exists():
                continue
            ran += 1
            names = {}
            exec(PRELUDE, names)
            known = set(names)
            try:
                exec(code.replace("OUT/", f"{folder}/"), names)
                found = [names[name] for name in names if name not in known]
                empty = any(len(value) == 0 for value in found)
                print(f"{page.name}: {export}: {'nothing was read' if empty else 'ok'}")
                failed += empty
            except Exception as error:
                print(f"{page.name}: {export}: {type(error).__name__}: {error}")
                failed += 1
    return failed > 0 or ran == 0


if __name__ == "__main__":
    sys.exit(main())
