import builtins
import hashlib
import json
import os
import pathlib
import signal
import subprocess
import sys
import time
import unittest
from unittest import mock

import numpy as np
import support
from support import FAKE_BLENDER, LABELS_ONLY, ProgramTest, is_running, wait_until

import seedframe
from seedframe import Campaign, Error


def pixel_hash(values, kind, channels):
    """As docs/formats/images.md has it."""
    height, width = values.shape[:2]
    head = f"seedframe-pixels-1\n{width} {height} {kind} {channels}\n"
    return hashlib.sha256(head.encode() + np.ascontiguousarray(values).tobytes()).hexdigest()


class ACampaign(ProgramTest):
    def test_arrays_are_the_pixels_that_the_program_hashed(self):
        told = []
        campaign = seedframe.submit(
            self.config, self.folder / "c", blender=FAKE_BLENDER, workers=2, progress=told.append
        )
        self.assertEqual((len(campaign), campaign.total, campaign.categories), (6, 6, ["gear"]))
        self.assertEqual((told[-1].done, told[-1].total, told[-1].failed), (6, 6, 0))
        frames = list(campaign)
        self.assertEqual([frame.number for frame in frames], list(range(6)))
        for frame in frames:
            pixels = frame.manifest["pixels"]
            self.assertEqual(pixel_hash(frame.image, "uint8", "R,G,B"), pixels["image"])
            self.assertEqual(pixel_hash(frame.ids, "uint16", "X"), pixels["index"])
            self.assertEqual(pixel_hash(frame.depth, "float", "Z"), pixels["depth"])
            self.assertEqual(pixel_hash(frame.normal, "float", "X,Y,Z"), pixels["normal"])
            np.testing.assert_array_equal(frame.semantic, frame._semantic_of_ids())
            for mask, each in zip(frame.masks(), frame.labels.visible):
                self.assertEqual(mask.sum(), each.area_px)
                x, y, width, height = each.box
                self.assertEqual(mask[y : y + height, x : x + width].sum(), each.area_px)
            self.assertEqual(frame.spec["render"]["width"], 48)
            self.assertEqual(len(frame.frame_id), 64)

    def test_silhouettes_hold_what_is_seen(self):
        campaign = seedframe.submit(self.config, self.folder / "c", set=LABELS_ONLY)
        for frame in campaign:
            for each in frame.labels.visible:
                whole = frame.amodal_mask(each)
                self.assertEqual(whole.sum(), each.amodal.in_image_px)
                self.assertTrue(np.all(whole[frame.mask(each)]))

    def test_what_is_missing_is_told(self):
        campaign = seedframe.submit(self.config, self.folder / "c", set={**LABELS_ONLY, "render.passes": []}, frames=2)
        self.assertEqual((len(campaign), campaign.total), (2, 6))
        self.assertEqual([frame.number for frame in campaign], [0, 1])
        self.assertEqual([frame.number for frame in campaign[:]], [0, 1])
        self.assertIn(1, campaign)
        self.assertNotIn(4, campaign)
        with self.assertRaisesRegex(IndexError, "seedframe resume"):
            campaign[4]
        with self.assertRaisesRegex(IndexError, "frames 0 to 5"):
            campaign[6]
        with self.assertRaisesRegex(Error, "no depth.exr.*passes: \\[depth\\]"):
            campaign[0].depth
        with self.assertRaisesRegex(Error, "labels: geometry makes none"):
            campaign[0].image
        with self.assertRaisesRegex(Error, "is not made"):
            campaign.frame(4).labels
        whole = seedframe.resume(campaign)
        self.assertEqual(len(whole), 6)
        self.assertEqual(whole[-1].number, 5)

    def test_damaged_files_are_told_by_name(self):
        campaign = seedframe.submit(self.config, self.folder / "c", set=LABELS_ONLY)
        folder = campaign[0].folder
        for name, read in (
            ("labels.json", lambda: campaign[0].labels),
            ("instances.png", lambda: campaign[0].ids),
            ("depth.exr", lambda: campaign[0].depth),
            ("manifest.json", lambda: campaign[0].manifest),
        ):
            data = (folder / name).read_bytes()
            (folder / name).write_bytes(data[: len(data) // 2])
            with self.assertRaisesRegex(Error, name) as caught:
                read()
            self.assertEqual(caught.exception.kind, "corrupt")

    def test_exports(self):
        campaign = seedframe.submit(self.config, self.folder / "c", blender=FAKE_BLENDER)
        folders = seedframe.export(
            campaign, ["coco", "yolo-detect"], self.folder / "out", split={"train": 0.7, "val": 0.3}
        )
        self.assertEqual([folder.name for folder in folders], ["coco", "yolo-detect"])
        self.assertTrue(all(any(folder.iterdir()) for folder in folders))
        self.assertEqual(seedframe.export(campaign, "coco"), [campaign.path / "exports" / "coco"])
        with self.assertRaisesRegex(Error, "cocoo"):
            seedframe.export(campaign, "cocoo")

    def test_check(self):
        found = seedframe.check(self.config)
        self.assertEqual((found["frames"], found["categories"]), (6, ["gear"]))
        with self.assertRaisesRegex(Error, "render.widht: unknown key") as caught:
            seedframe.check(self.config, set={"render.widht": 3})
        self.assertEqual((caught.exception.kind, caught.exception.exit_code), ("input", 2))

    def test_describe(self):
        found = seedframe.describe(self.config)
        self.assertIn("turn", json.dumps(found))

    def test_errors_are_the_programs_own(self):
        with self.assertRaisesRegex(Error, "^cannot read .*nope.yaml: No such file or directory$") as caught:
            seedframe.submit(self.folder / "nope.yaml", self.folder / "c")
        self.assertEqual((caught.exception.kind, caught.exception.exit_code), ("input", 2))
        with self.assertRaisesRegex(Error, "there is no campaign here"):
            Campaign(self.folder)
        self.environment(SEEDFRAME_FAKE=json.dumps({"fail_frames": [1], "fail_attempts": 9}))
        with self.assertRaisesRegex(Error, "1 frames failed") as caught:
            seedframe.submit(self.config, self.folder / "c", blender=FAKE_BLENDER)
        self.assertEqual((caught.exception.kind, caught.exception.exit_code), ("render", 3))
        self.assertEqual(len(Campaign(self.folder / "c")), 5)

    def test_what_progress_raises_ends_the_run(self):
        def fail(progress):
            raise KeyError("mine")

        with self.assertRaisesRegex(KeyError, "mine"):
            seedframe.submit(self.config, self.folder / "c", blender=FAKE_BLENDER, progress=fail)
        self.assertEqual(len(seedframe.resume(self.folder / "c", blender=FAKE_BLENDER)), 6)


class HundredThousandFrames(ProgramTest):
    def test_nothing_is_read_or_listed_that_is_not_asked_for(self):
        program = self.folder / "seedframe"
        program.write_text('#!/bin/sh\necho \'{"frames": 100000, "done": 100000}\'\n')
        program.chmod(0o755)
        self.environment(SEEDFRAME=str(program))
        campaign = Campaign(self.folder)
        begin = time.monotonic()
        forbidden = AssertionError("the disk was looked at")
        with (
            mock.patch.object(builtins, "open", side_effect=forbidden),
            mock.patch.object(os, "stat", side_effect=forbidden),
            mock.patch.object(os, "scandir", side_effect=forbidden),
            mock.patch.object(os, "listdir", side_effect=forbidden),
        ):
            self.assertEqual(sum(1 for _ in campaign), 100_000)
            self.assertEqual(len(campaign), 100_000)
            self.assertEqual(campaign[12345].folder, self.folder / "frames" / "012" / "012345")
        self.assertLess(time.monotonic() - begin, 20)


class ThePrograms(ProgramTest):
    def test_where_it_is_looked_for(self):
        program = self.folder / "bin" / "seedframe"
        program.parent.mkdir()
        program.write_text("#!/bin/sh\n")
        program.chmod(0o755)
        with mock.patch.dict(os.environ, PATH=str(program.parent)):
            os.environ.pop("SEEDFRAME", None)
            self.assertEqual(seedframe.find_program(), program)
            os.environ["SEEDFRAME"] = str(self.folder / "other")
            with self.assertRaisesRegex(Error, "SEEDFRAME is .*other") as caught:
                seedframe.find_program()
            self.assertEqual(caught.exception.kind, "environment")
            os.environ["SEEDFRAME"] = "seedframe"
            self.assertEqual(seedframe.find_program(), program)
        built = support.CHECKOUT / "build/release/seedframe"
        with mock.patch.dict(os.environ, PATH=str(self.folder)):
            os.environ.pop("SEEDFRAME", None)
            if built.exists():
                self.assertEqual(seedframe.find_program(), built)
            else:
                with self.assertRaisesRegex(Error, "neither in PATH nor at"):
                    seedframe.find_program()


class Interrupted(ProgramTest):
    """Runs of another Python, which is stopped in the middle of them."""

    def start(self):
        self.environment(SEEDFRAME_FAKE=json.dumps({"delay_s": 0.5}))
        script = self.script(
            f"seedframe.submit({str(self.config)!r}, {str(self.folder / 'c')!r}, blender={FAKE_BLENDER!r}, workers=1, "
            "set={'scenes': 40})\n"
        )
        python = subprocess.Popen([sys.executable, "-B", str(script)], stderr=subprocess.PIPE, text=True)
        self.addCleanup(python.stderr.close)
        self.addCleanup(python.wait)
        self.addCleanup(python.kill)
        first = self.folder / "c/frames/000/000000/manifest.json"
        self.assertTrue(wait_until(first.exists), "no frame was made")
        (program,) = support.children_of(python.pid)
        return python, program

    def test_ctrl_c_ends_the_run_in_good_order(self):
        python, program = self.start()
        python.send_signal(signal.SIGINT)
        self.assertIn("KeyboardInterrupt", python.communicate(timeout=60)[1])
        self.assertFalse(is_running(program))
        made = len(Campaign(self.folder / "c"))
        self.assertTrue(0 < made < 80, made)
        self.assertEqual(Campaign(self.folder / "c").status()["running"], 0)

    def test_a_killed_python_leaves_no_run(self):
        python, program = self.start()
        workers = support.children_of(program)
        self.assertTrue(workers)
        python.kill()
        for process in (program, *workers):
            self.assertTrue(wait_until(lambda process=process: not is_running(process)))
        self.assertFalse(Campaign(self.folder / "c").status()["active"])

    def test_a_killed_program_is_told(self):
        python, program = self.start()
        os.kill(program, signal.SIGKILL)
        self.assertIn("the program was ended by SIGKILL", python.communicate(timeout=60)[1])


class Pictures(ProgramTest):
    def test_without_pillow_it_is_named(self):
        folder = pathlib.Path(self.folder)
        (folder / "image.jpg").write_bytes(b"x")
        frame = seedframe.Frame(folder, 0)
        with mock.patch.dict(sys.modules, {"PIL": None}), self.assertRaisesRegex(Error, "pip install pillow"):
            frame.image


if __name__ == "__main__":
    unittest.main()
