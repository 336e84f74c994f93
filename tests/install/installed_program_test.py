"""The program where `cmake --install` puts it: it works from anywhere, and its manual is about it.

    installed_program_test.py BUILD_FOLDER
"""

import gzip
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import completions

CHECKOUT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(sys.argv.pop(1)).resolve() if len(sys.argv) > 1 else CHECKOUT / "build/release"


def install(prefix, environment=None):
    subprocess.run(["cmake", "--install", BUILD, "--prefix", prefix], check=True, stdout=subprocess.DEVNULL,
                   env={**os.environ, **(environment or {})})


class InstalledProgram(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        os.chmod(scratch.name, 0o755)
        # Installed in one place and moved to another: nothing may hang on where it was put.
        root = pathlib.Path(scratch.name).resolve()
        install(root / "first")
        cls.prefix = root / "moved here"
        (root / "first").rename(cls.prefix)
        cls.home = cls.prefix / "share/seedframe"
        cls.elsewhere = root / "elsewhere"
        cls.elsewhere.mkdir()

    def run_program(self, *arguments, exit_code=0, program=None, **environment):
        kept = {name: value for name, value in os.environ.items() if not name.startswith("SEEDFRAME_")}
        done = subprocess.run([program or self.prefix / "bin/seedframe", *map(str, arguments)], cwd=self.elsewhere,
                              env={**kept, "SEEDFRAME_CACHE": "off", **environment}, capture_output=True, text=True)
        self.assertEqual(done.returncode, exit_code, done.stdout + done.stderr)
        return done.stderr if exit_code else done.stdout

    def test_everything_is_where_it_is_looked_for(self):
        for file in ["bin/seedframe", "lib/seedframe/seedframe_worker_cpu.so",
                     "lib/seedframe/seedframe_image_module.so",
                     "share/seedframe/blender_scripts/render_worker.py", "share/seedframe/assets/gear/asset.json",
                     "share/seedframe/materials/library.yaml", "share/seedframe/configs/parts.yaml",
                     "share/doc/seedframe/README.md", "share/doc/seedframe/docs/README.md",
                     "share/doc/seedframe/LICENSE", "share/doc/seedframe/copyright",
                     "share/man/man1/seedframe.1.gz", "share/bash-completion/completions/seedframe",
                     "share/zsh/site-functions/_seedframe",
                     "share/zsh/vendor-completions/_seedframe", "share/fish/vendor_completions.d/seedframe.fish"]:
            self.assertTrue((self.prefix / file).is_file(), file)
        strangers = [file for file in self.prefix.rglob("*") if file.name in ("__pycache__", "campaign.sqlite")]
        self.assertEqual(strangers, [])

    def test_finds_its_files_in_the_place_where_it_is(self):
        findings = {finding["what"]: finding for finding in json.loads(self.run_program("doctor", "--json"))}
        self.assertEqual(findings["home"], {"what": "home", "good": True, "found": str(self.home)})
        self.assertEqual(findings["preload"]["found"], str(self.prefix / "lib/seedframe/seedframe_worker_cpu.so"))

    def test_labels_a_campaign_from_another_folder(self):
        self.run_program("submit", self.home / "configs/parts.yaml", "--set", "labels=geometry", "--frames", 1,
                         "--quiet")
        labels = json.loads((self.elsewhere / "results/parts/frames/000/000000/labels.json").read_text())
        self.assertGreater(len(labels["instances"]), 5)
        self.run_program("export", "results/parts", "--format", "coco", "--partial")
        self.assertTrue((self.elsewhere / "results/parts/exports/coco/annotations").is_dir())

    def test_shipped_configs_find_what_they_build_on(self):
        for name in ["tyol_multi_8_target", "robocup_fig2", "parts_study"]:  # a base, a sweep, textures
            self.run_program("check", self.home / f"configs/{name}.yaml", "--set", "scenes=2")

    def test_runs_through_a_link(self):
        link = self.elsewhere / "seedframe"
        link.symlink_to(self.prefix / "bin/seedframe")
        self.run_program("check", self.home / "configs/bench_small.yaml", program=link)
        link.unlink()

    def test_says_where_it_looked_when_its_files_are_gone(self):
        (self.prefix / "share/seedframe").rename(self.prefix / "share/hidden")
        try:
            said = self.run_program("check", CHECKOUT / "configs/parts.yaml", exit_code=4)
            self.assertIn(str(self.home), said)
            self.assertIn("SEEDFRAME_HOME", said)
            # The checkout that it was built from is none of an installed program's business.
            self.assertNotIn(f"in {CHECKOUT}", said)
            self.run_program("check", self.prefix / "share/hidden/configs/bench_small.yaml",
                             SEEDFRAME_HOME=str(self.prefix / "share/hidden"))
        finally:
            (self.prefix / "share/hidden").rename(self.home)

    def test_refuses_a_home_that_is_none(self):
        said = self.run_program("check", self.home / "configs/parts.yaml", exit_code=4,
                                SEEDFRAME_HOME=str(self.elsewhere))
        self.assertIn(f"SEEDFRAME_HOME is '{self.elsewhere}'", said)

    def test_keeps_users_from_the_built_in_assets(self):
        (self.elsewhere / "part.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        before = sorted((self.home / "assets").iterdir())
        self.run_program("asset", "import", "part.obj", XDG_DATA_HOME=str(self.elsewhere / "data"))
        self.assertEqual(sorted((self.home / "assets").iterdir()), before)
        self.assertTrue((self.elsewhere / "data/seedframe/assets/part/asset.json").is_file())

    def test_installs_below_destdir(self):
        with tempfile.TemporaryDirectory() as stage:
            install("/usr", {"DESTDIR": stage})
            self.assertTrue((pathlib.Path(stage) / "usr/bin/seedframe").is_file())
            self.assertEqual([entry.name for entry in pathlib.Path(stage).iterdir()], ["usr"])

    def test_links_of_the_installed_pages_lead_somewhere(self):
        pages = self.prefix / "share/doc/seedframe"
        for page in [pages / "README.md", pages / "CONTRIBUTING.md", *(pages / "docs").rglob("*.md")]:
            text = re.sub(r"```.*?```", "", page.read_text(), flags=re.S)
            for link in re.findall(r"\]\(([^)#\s]+)[^)]*\)", text):
                if "://" in link:
                    continue
                self.assertTrue((page.parent / link).exists(), f"{page.relative_to(pages)}: {link}")


class Manual(unittest.TestCase):
    """The installed manual against what --help says."""

    @classmethod
    def setUpClass(cls):
        cls.program = BUILD / "seedframe"
        cls.bash = str(BUILD / "manual/seedframe")
        cls.zsh = str(BUILD / "manual/_seedframe")
        cls.fish = str(BUILD / "manual/seedframe.fish")
        cls.verbs = cls.verbs_below()

    @classmethod
    def help_of(cls, path):
        return subprocess.run([cls.program, *path, "--help"], check=True, capture_output=True, text=True).stdout

    @classmethod
    def verbs_below(cls, path=()):
        """Path of each verb -> its options, from what --help prints."""
        text = cls.help_of(path)
        verbs = {path: re.findall(r"(?<=[ ,])--[a-z][a-z-]+(?=[ ,\n])", text.partition("Options:")[2].partition(
            "Subcommands:")[0])}
        for name in re.findall(r"^  ([a-z]+) ", text.partition("Subcommands:")[2], re.M):
            verbs.update(cls.verbs_below((*path, name)))
        return verbs

    def test_help_was_understood(self):
        self.assertGreater(len(self.verbs), 15)
        self.assertIn("--sandbox", self.verbs[("submit",)])
        self.assertIn("--mirror", self.verbs[("asset", "keypoints")])

    def test_bash_offers_every_verb_and_option(self):
        for path, options in self.verbs.items():
            below = [verb[-1] for verb in self.verbs if verb[:-1] == path and verb]
            self.assertEqual(set(below) - set(completions.bash(self.bash, "seedframe", *path, "")), set())
            self.assertEqual(set(options) - set(completions.bash(self.bash, "seedframe", *path, "--")), set(), path)

    def test_fish_offers_every_verb_and_option(self):
        for path, options in self.verbs.items():
            line = " ".join(("seedframe", *path))
            below = [verb[-1] for verb in self.verbs if verb[:-1] == path and verb]
            self.assertEqual(set(below) - set(completions.fish(self.fish, line + " ")), set())
            self.assertEqual(set(options) - set(completions.fish(self.fish, line + " --")), set(), path)

    def test_zsh_offers_every_verb_and_option(self):
        zsh = completions.Zsh(self.zsh, CHECKOUT)
        try:
            for path, options in self.verbs.items():
                line = " ".join(("seedframe", *path))
                below = [verb[-1] for verb in self.verbs if verb[:-1] == path and verb]
                if below:
                    self.assertEqual(set(below) - zsh.offers(line + " "), set())
                self.assertEqual(set(options) - zsh.offers(line + " --"), set(), path)
        finally:
            zsh.close()

    def test_the_man_page_has_every_verb_and_option(self):
        page = gzip.open(BUILD / "manual/seedframe.1.gz", "rt").read().replace("\\-", "-")
        sections = {name: text for name, text in re.findall(r"^\.SS (.*)\n((?:(?!\.S[SH] ).*\n)*)", page, re.M)}
        for path, options in self.verbs.items():
            text = sections[" ".join(path)] if path else page
            for option in options:
                self.assertIn(f"\\fB{option}\\fR", text, path)

    def test_man_formats_the_page_without_a_warning(self):
        said = subprocess.run(["man", "--warnings=all", "-l", BUILD / "manual/seedframe.1.gz"], capture_output=True,
                              text=True, env={**os.environ, "MANPAGER": "cat", "MANWIDTH": "100"}, check=True)
        self.assertEqual(said.stderr, "")
        self.assertIn("--split", said.stdout)

    def test_bash_offers_what_fits(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            (folder / "my campaign").mkdir()
            (folder / "my_scene.yaml").touch()
            (folder / "my_notes.txt").touch()

            def offers(*words):
                return completions.bash(self.bash, "seedframe", *words, cwd=folder)

            self.assertEqual(offers("sub"), ["submit"])
            self.assertEqual(offers("asset", "imp"), ["import"])
            self.assertEqual(offers("export", "my campaign", "--format", "yolo-s"), ["yolo-segment"])
            self.assertEqual(offers("export", "x", "--polygon", "=", "s"), ["simplified"])
            self.assertEqual(offers("audit", "x", "--vary", "thr"), ["threads"])
            self.assertEqual(offers("status", "m"), ["my campaign"])
            self.assertEqual(sorted(offers("submit", "my")), ["my campaign", "my_scene.yaml"])
            self.assertEqual(offers("submit", "c.yaml", "-o", "m"), ["my campaign"])
            self.assertEqual(offers("submit", "c.yaml", "--frames", ""), [])

    def test_fish_offers_what_fits(self):
        offers = completions.fish(self.fish, "seedframe export x --format yolo-", cwd=CHECKOUT)
        self.assertEqual(sorted(offers), ["yolo-detect", "yolo-obb", "yolo-pose", "yolo-segment"])
        self.assertIn("configs/parts.yaml", completions.fish(self.fish, "seedframe submit configs/pa", cwd=CHECKOUT))

    def test_each_format_and_condition_is_offered(self):
        formats = re.findall(r"^ +([a-z0-9-]+): ", self.help_of(["export"]), re.M)
        self.assertGreater(len(formats), 10)
        self.assertEqual(set(completions.bash(self.bash, "seedframe", "export", "--format", "")), set(formats))


class LinkToTheProgram(unittest.TestCase):
    """scripts/link_program.sh"""

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.root = pathlib.Path(scratch.name).resolve()
        self.bin = self.root / "bin"
        self.program = self.make_program("checkout/seedframe")

    def make_program(self, name):
        program = self.root / name
        program.parent.mkdir(parents=True, exist_ok=True)
        program.write_text("#!/bin/sh\n")
        program.chmod(0o755)
        return program

    def link(self, *path):
        return subprocess.run([CHECKOUT / "scripts/link_program.sh", self.program, self.bin], check=True, text=True,
                              capture_output=True, env={**os.environ, "PATH": ":".join(("/usr/bin", "/bin", *path))}
                              ).stdout

    def test_is_made_and_found_again(self):
        self.assertIn(f"linked {self.bin}/seedframe", self.link(str(self.bin)))
        self.assertEqual((self.bin / "seedframe").resolve(), self.program)
        self.assertIn("which is this one", self.link(str(self.bin)))

    def test_says_when_the_folder_is_not_in_path(self):
        self.assertIn("not in PATH", self.link())
        self.assertIn("not in PATH", self.link())

    def test_leaves_another_program_alone(self):
        other = self.make_program("elsewhere/seedframe")
        self.assertIn("another program", self.link(str(other.parent)))
        self.assertFalse(self.bin.exists())
        mine = self.make_program("bin/seedframe")
        self.assertIn("another program", self.link())
        self.assertFalse(mine.is_symlink())

    def test_replaces_a_link_that_leads_nowhere(self):
        self.bin.mkdir()
        (self.bin / "seedframe").symlink_to(self.root / "gone")
        self.link(str(self.bin))
        self.assertEqual((self.bin / "seedframe").resolve(), self.program)


if __name__ == "__main__":
    unittest.main(verbosity=2)
