"""What is shown is run: the page and the notebook."""

import contextlib
import io
import json
import os
import re
import unittest

import support
from support import ProgramTest


class Examples(ProgramTest):
    def setUp(self):
        super().setUp()
        (self.folder / "configs").symlink_to(support.CHECKOUT / "configs")
        before = os.getcwd()
        os.chdir(self.folder)
        self.addCleanup(os.chdir, before)

    def run_all(self, sources, name):
        """One after another in one place, as a reader would. What is in it at the end, and what was printed."""
        space = {"__name__": name}
        printed = io.StringIO()
        for number, source in enumerate(sources):
            with contextlib.redirect_stdout(printed):
                exec(compile(source, f"{name}[{number}]", "exec"), space)
        return space, printed.getvalue()

    def test_the_page(self):
        page = (support.CHECKOUT / "docs/python.md").read_text()
        blocks = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
        self.assertGreater(len(blocks), 5)
        space, printed = self.run_all(blocks, "python.md")
        self.assertIn("6/6 frames", printed)
        self.assertIn("input 2 --set render.widht=64: render.widht: unknown key", printed)
        self.assertIn("did you mean 'reach'?", printed)
        self.assertEqual(printed.count("(8, 128, 128, 3) (8, 128, 128) 8\n"), 2)
        self.assertTrue((self.folder / "results/small/exports/coco").is_dir())
        self.assertEqual(space["pose"].shape, (4, 4))

    def test_the_notebook(self):
        notebook = json.loads((support.CHECKOUT / "python/examples/on_the_fly.ipynb").read_text())
        cells = ["".join(cell["source"]) for cell in notebook["cells"] if cell["cell_type"] == "code"]
        self.assertTrue(all(not cell.get("outputs") for cell in notebook["cells"]), "it is committed without outputs")
        space, printed = self.run_all(cells, "on_the_fly.ipynb")
        self.assertIn("['gear', 'bracket', 'mug']", printed)
        self.assertGreater(space["accuracy"], 0.75, printed)


if __name__ == "__main__":
    unittest.main()
