import concurrent.futures
import gc
import json
import os
import pathlib
import pickle
import signal
import subprocess
import sys
import threading
import time
import unittest

import numpy as np
from support import FAKE_BLENDER, LABELS_ONLY, ProgramTest, children_of, is_running, wait_until

import seedframe
from seedframe import Error, Request, Stream


def descriptors():
    return len(os.listdir("/proc/self/fd"))


class Streams(ProgramTest):
    def test_frames_come_in_order(self):
        with Stream(self.config, want=["labels", "ids", "depth"]) as stream:
            turn = stream.variables["turn"]
            self.assertEqual((turn["type"], turn["unit"], turn["per_copy"]), ("number", "deg", False))
            self.assertEqual((stream.ready["width"], stream.ready["categories"]), (48, ["gear"]))
            turns = [3.0 * k for k in range(100)]
            one_by_one = [stream.submit({"turn": turn}, scene=k).result() for k, turn in enumerate(turns)]
            frames = list(stream.render({"turn": turn} for turn in turns))
        self.assertEqual([frame.frame_id for frame in frames], [frame.frame_id for frame in one_by_one])
        self.assertEqual(len({frame.frame_id for frame in frames}), 100)
        frame = frames[0]
        self.assertEqual((frame.ids.dtype, frame.ids.shape), (np.uint16, (32, 48)))
        self.assertEqual((frame.depth.dtype, frame.depth.shape), (np.float32, (32, 48)))
        for mask, each in zip(frame.masks(), frame.labels.visible):
            self.assertEqual(mask.sum(), each.area_px)

    def test_it_is_the_campaign_of_these_values(self):
        values = [{"turn": 10, "height": 0.3}, {"turn": 80}, {}]
        graphs = self.folder / "values.jsonl"
        graphs.write_text("".join(json.dumps(each) + "\n" for each in values))
        for fidelity, more in (("labels", LABELS_ONLY), ("render", {})):
            campaign = seedframe.submit(
                self.config,
                self.folder / fidelity,
                set={"graphs": str(graphs), "frames_per_scene": 1, **more},
                blender=FAKE_BLENDER,
            )
            want = ["labels", "ids", "depth"] + (["image"] if fidelity == "render" else [])
            with Stream(self.config, fidelity, 2, set=more, blender=FAKE_BLENDER, want=want) as stream:
                frames = list(stream.render(values))
            self.assertEqual([frame.frame_id for frame in frames], [frame.frame_id for frame in campaign])
            for made, stored in zip(frames, campaign):
                self.assertEqual(made.pixel_hashes["index"], stored.manifest["pixels"]["index"])
                self.assertEqual(made.labels.raw, stored.labels.raw)
                np.testing.assert_array_equal(made.ids, stored.ids)
                np.testing.assert_array_equal(made.depth, stored.depth)
                np.testing.assert_array_equal(made.semantic, stored.semantic)
                if fidelity == "render":
                    np.testing.assert_array_equal(made.image, stored.image)

    def test_what_is_rendered_is_kept_if_it_is_to_be(self):
        folder = self.folder / "kept"
        with Stream(self.config, "render", 2, blender=FAKE_BLENDER, keep=folder) as stream:
            frames = list(stream.render([{"turn": 10}, {"turn": 20}, Request({"turn": 30}, denoise=True, samples=3)]))
            self.assertEqual({frame.kept for frame in frames}, {0, 1, 2})
            self.assertIsNone(stream.submit({}, fidelity="labels").result().kept)
            again = stream.submit({"turn": 20}, scene=1).result()
            self.assertEqual(again.kept, frames[1].kept)
        campaign = seedframe.Campaign(folder)
        self.assertEqual((len(campaign), campaign.total), (3, 3))
        for frame in frames:
            stored = campaign[frame.kept]
            self.assertEqual(stored.frame_id, frame.frame_id)
            np.testing.assert_array_equal(stored.image, frame.image)
        self.assertEqual(campaign[frames[2].kept].spec["render"]["denoise"], "oidn")
        self.assertEqual(campaign[frames[2].kept].spec["render"]["samples"], 3)
        seedframe.resume(folder, blender=FAKE_BLENDER)
        with self.assertRaises(Error) as refused:
            Stream(self.config, set={"seed": 5}, keep=folder)
        self.assertEqual(refused.exception.kind, "input")

    def test_numpy_values_and_requests(self):
        with Stream(self.config) as stream:
            plain = stream.submit({"turn": 30, "height": 0.25}).result()
            by_numpy = stream.submit({"turn": np.float32(30), "height": np.array(0.25)}).result()
            self.assertEqual(plain.frame_id, by_numpy.frame_id)
            self.assertEqual(stream.submit(Request({"turn": 30, "height": 0.25}, 0)).result().frame_id, plain.frame_id)
            other = stream.submit(Request({"turn": 30}, scene=0), scene=1).result()
            self.assertNotEqual(other.frame_id, stream.submit({"turn": 30}).result().frame_id)

    def test_errors_are_of_one_request(self):
        with Stream(self.config) as stream:
            for bad, told in (
                (Request({"trun": 3}), "did you mean 'turn'"),
                (Request({"turn": "red"}), "turn"),
                (Request({"turn": float("nan")}), "JSON"),
                (Request({"turn": object()}), "JSON"),
                (Request({}, want=["image"]), "fidelity labels has no image"),
                (Request({}, fidelity="perfect"), "fidelity"),
                (Request({}, scene=-1), "scene"),
            ):
                with self.assertRaisesRegex(Error, told) as caught:
                    stream.submit(bad).result()
                self.assertEqual((caught.exception.kind, caught.exception.exit_code), ("input", None))
            self.assertTrue(stream.submit({"turn": 3}).result().frame_id)
            mixed = list(stream.render([{"turn": 1}, {"trun": 2}, {"turn": 3}], return_errors=True))
            self.assertEqual([isinstance(each, Error) for each in mixed], [False, True, False])
            with self.assertRaisesRegex(Error, "trun"):
                list(stream.render([{"turn": 1}, {"trun": 2}, {"turn": 3}]))
            with self.assertRaisesRegex(Error, "not asked for its ids.*want"):
                stream.submit({}).result().ids

    def test_a_wrong_config_is_told_at_once(self):
        before = descriptors()
        for _ in range(3):
            with self.assertRaisesRegex(Error, "render.widht: unknown key") as caught:
                Stream(self.config, set={"render.widht": 3})
            self.assertEqual((caught.exception.kind, caught.exception.exit_code), ("input", 2))
        gc.collect()
        self.assertEqual(descriptors(), before)

    def test_futures_work_with_those_of_others(self):
        with Stream(self.config) as stream:
            futures = {stream.submit({"turn": turn}): turn for turn in range(20)}
            done = {futures[future]: future.result() for future in seedframe.as_completed(futures)}
            self.assertEqual(sorted(done), list(range(20)))
            called = threading.Event()
            stream.submit({}).add_done_callback(lambda future: called.set())
            self.assertTrue(called.wait(30))

    def test_submit_waits_while_too_many_are_open(self):
        self.environment(SEEDFRAME_FAKE=json.dumps({"delay_s": 0.05}))
        with Stream(self.config, "render", 1, blender=FAKE_BLENDER, options=["--most-open", "4"]) as stream:
            most = 0
            futures = []
            for turn in range(12):
                futures.append(stream.submit({"turn": turn}))
                most = max(most, sum(not future.done() for future in futures))
            self.assertEqual(len({future.result().frame_id for future in futures}), 12)
            self.assertLessEqual(most, 5)  # one may be just about to be told

    def test_cancelling(self):
        self.environment(SEEDFRAME_FAKE=json.dumps({"delay_s": 0.2}))
        with Stream(self.config, "render", 1, blender=FAKE_BLENDER) as stream:
            futures = [stream.submit({"turn": turn}) for turn in range(30)]
            self.assertTrue(futures[0].result().frame_id)
            begin = time.monotonic()
            self.assertTrue(all(future.cancel() for future in futures[5:]))
            concurrent.futures.wait(futures)
            self.assertTrue(all(future.cancelled() for future in futures[5:]))
            self.assertTrue(stream.submit({"turn": 77}).result().frame_id)
            self.assertLess(time.monotonic() - begin, 60)
            frames = stream.render({"turn": turn} for turn in range(1000))
            next(frames)
            frames.close()  # cancels what it has asked for

    def test_a_deadline(self):
        self.environment(SEEDFRAME_FAKE=json.dumps({"delay_s": 0.5}))
        with Stream(self.config, "render", 1, blender=FAKE_BLENDER) as stream:
            first = stream.submit({"turn": 1})
            late = [stream.submit({"turn": turn}, deadline_s=0.01) for turn in range(4)]
            self.assertTrue(first.result().frame_id)
            with self.assertRaises(Error) as caught:
                late[-1].result()
            self.assertEqual(caught.exception.kind, "input")

    def test_long_lines_do_not_lock_both_sides(self):
        with Stream(self.config) as stream:
            threads = [
                threading.Thread(target=lambda: [stream.submit({"x" * 300_000: 1}).exception() for _ in range(6)])
                for _ in range(8)
            ]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join(120)
                self.assertFalse(thread.is_alive())
            self.assertTrue(stream.submit({}).result().frame_id)

    def test_it_belongs_to_its_process(self):
        with Stream(self.config) as stream:
            with self.assertRaisesRegex(TypeError, "of one process"):
                pickle.dumps(stream)
            child = os.fork()
            if child == 0:
                try:
                    stream.submit({})
                except Error as error:
                    os._exit(7 if "has forked" in str(error) else 1)
                os._exit(2)
            self.assertEqual(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), 7)
            self.assertTrue(stream.submit({}).result().frame_id)

    def test_errors_survive_pickling(self):
        error = pickle.loads(pickle.dumps(Error("a", "render", 3)))
        self.assertEqual((error.message, error.kind, error.exit_code), ("a", "render", 3))


class Arrays(ProgramTest):
    def test_they_live_as_long_as_they_are_used_and_no_longer(self):
        with Stream(self.config, want=["ids"]) as stream:
            before = descriptors()
            ids = [frame.ids for frame in stream.render({"turn": k % 90} for k in range(1500))]
            self.assertLessEqual(descriptors(), before + 1)  # a mapping holds none
            maps = pathlib.Path("/proc/self/maps").read_text().count("memfd:seedframe")
            self.assertGreater(maps, 1000)
        self.assertTrue(all(each.max() <= 2 for each in ids))  # also after the end
        ids.clear()
        gc.collect()
        self.assertEqual(pathlib.Path("/proc/self/maps").read_text().count("memfd:seedframe"), 0)

    def test_batches_are_the_frames_memory(self):
        with Stream(self.config, "render", 2, blender=FAKE_BLENDER, want=["labels", "image", "ids", "depth"]) as stream:
            values = [{"turn": 9 * k} for k in range(10)]
            batches = list(stream.render_batches(values, 4))
            frames = list(stream.render(values))
            self.assertEqual([len(batch) for batch in stream.render_batches(values, 4, drop_last=True)], [4, 4])
            self.assertEqual(list(stream.render_batches([], 4)), [])
        self.assertEqual([batch.image.shape for batch in batches], [(4, 32, 48, 3), (4, 32, 48, 3), (2, 32, 48, 3)])
        for k, frame in enumerate(frames):
            batch = batches[k // 4]
            for name in ("image", "ids", "depth"):
                one, all_of_it = getattr(batch.frames[k % 4], name), getattr(batch, name)[k % 4]
                self.assertEqual(one.ctypes.data, all_of_it.ctypes.data)
                np.testing.assert_array_equal(all_of_it, getattr(frame, name))
            self.assertEqual(batch.labels[k % 4].raw, frame.labels.raw)
        batches[0].image[0] = 7  # is the reader's own
        self.assertTrue(np.all(batches[0].frames[0].image == 7))

    def test_a_batch_needs_arrays_of_one_shape(self):
        with Stream(self.config, want=["ids"]) as stream:
            with self.assertRaisesRegex(Error, "same want"):
                list(stream.render_batches([Request({}), Request({}, want=["ids", "depth"])], 2))
            with self.assertRaisesRegex(Error, "'depth' in want"):
                next(stream.render_batches([{}], 1)).depth
            with self.assertRaisesRegex(ValueError, "at least one frame"):
                next(stream.render_batches([{}], 0))


class Ends(ProgramTest):
    def processes(self, stream):
        program = stream.ready["process"]
        return [program, *children_of(program)]

    def all_ended(self, processes):
        return wait_until(lambda: not any(is_running(process) for process in processes))

    def test_what_is_open_is_made_at_the_end(self):
        with Stream(self.config, "render", 2, blender=FAKE_BLENDER) as stream:
            futures = [stream.submit({"turn": turn}) for turn in range(8)]
        self.assertEqual(len({future.result().frame_id for future in futures}), 8)
        with self.assertRaisesRegex(Error, "closed|ended"):
            stream.submit({})
        stream.close()

    def test_an_exception_drops_what_is_open(self):
        self.environment(SEEDFRAME_FAKE=json.dumps({"delay_s": 0.5}))
        with self.assertRaises(ZeroDivisionError), Stream(self.config, "render", 1, blender=FAKE_BLENDER) as stream:
            futures = [stream.submit({"turn": turn}) for turn in range(60)]
            futures[0].result()
            processes = self.processes(stream)
            begin = time.monotonic()
            raise ZeroDivisionError
        self.assertLess(time.monotonic() - begin, 20)
        self.assertTrue(self.all_ended(processes))
        for future in futures:
            self.assertTrue(future.done())
        self.assertIsInstance(futures[-1].exception(), Error)

    def test_a_stream_that_is_forgotten_ends(self):
        stream = Stream(self.config)
        processes = self.processes(stream)
        del stream
        gc.collect()
        self.assertTrue(self.all_ended(processes))

    def test_a_killed_program_is_an_error_of_every_request(self):
        self.environment(SEEDFRAME_FAKE=json.dumps({"delay_s": 2}))
        stream = Stream(self.config, "render", 2, blender=FAKE_BLENDER)
        futures = [stream.submit({"turn": turn}) for turn in range(60)]
        concurrent.futures.wait(futures, return_when=concurrent.futures.FIRST_COMPLETED)
        processes = self.processes(stream)
        self.assertGreater(len(processes), 1)
        os.kill(processes[0], signal.SIGKILL)
        done, waiting = concurrent.futures.wait(futures, 60)
        self.assertEqual(len(waiting), 0)
        errors = [future.exception() for future in done if future.exception() is not None]
        self.assertGreater(len(errors), 2)
        for error in errors:
            self.assertRegex(str(error), "ended by SIGKILL")
            self.assertEqual((error.kind, error.exit_code), ("environment", -9))
        with self.assertRaisesRegex(Error, "ended by SIGKILL"):
            stream.submit({})
        self.assertTrue(self.all_ended(processes))
        stream.close()

    def test_a_program_that_says_nonsense_is_an_error(self):
        for line in ("nonsense", '{"ready": {"protocol": 99, "variables": {}}}', '{"id": 77}'):
            program = self.folder / "seedframe"
            program.write_text(f"#!/bin/sh\necho '{line}'\nexec sleep 1000\n")
            program.chmod(0o755)
            self.environment(SEEDFRAME=str(program))
            with self.assertRaisesRegex(Error, "not understood") as caught:
                Stream(self.config)
            self.assertEqual(caught.exception.kind, "internal")

    def start_python(self, text):
        python = subprocess.Popen([sys.executable, "-B", str(self.script(text))], stdout=subprocess.PIPE, text=True)
        self.addCleanup(python.stdout.close)
        self.addCleanup(python.wait)
        self.addCleanup(python.kill)
        program = int(python.stdout.readline())
        return python, [program, *children_of(program)]

    OPEN = """
stream = seedframe.Stream({config!r}, "render", 2, blender={blender!r})
futures = [stream.submit({{"turn": turn}}) for turn in range(60)]
futures[0].result()
"""

    def open(self):
        self.environment(SEEDFRAME_FAKE=json.dumps({"delay_s": 0.3}))
        return self.OPEN.format(config=str(self.config), blender=FAKE_BLENDER)

    def test_a_killed_python_leaves_nothing(self):
        python, processes = self.start_python(
            self.open() + "print(stream.ready['process'], flush=True)\nimport time\ntime.sleep(1000)\n"
        )
        self.assertGreater(len(processes), 1)
        python.kill()
        self.assertTrue(self.all_ended(processes))

    def test_a_killed_python_whose_fork_lives_leaves_nothing(self):
        python, processes = self.start_python(
            self.open()
            + "import os, time\nif os.fork() == 0:\n    time.sleep(60)\n    os._exit(0)\n"
            + "print(stream.ready['process'], flush=True)\ntime.sleep(1000)\n"
        )
        (fork,) = [each for each in children_of(python.pid) if each not in processes]
        python.kill()
        try:
            self.assertTrue(self.all_ended(processes))
        finally:
            os.kill(fork, signal.SIGKILL)

    def test_a_python_that_ends_without_closing_leaves_nothing(self):
        python, processes = self.start_python(self.open() + "print(stream.ready['process'], flush=True)\n")
        python.wait(60)
        self.assertTrue(self.all_ended(processes))

    def test_ctrl_c_is_pythons(self):
        python, processes = self.start_python(
            self.open()
            + "print(stream.ready['process'], flush=True)\n"
            + "import time\ntry:\n    time.sleep(1000)\nexcept KeyboardInterrupt:\n    pass\n"
            + "print('frames', sum(bool(future.result()) for future in futures[:5]), flush=True)\n"
        )
        python.send_signal(signal.SIGINT)
        self.assertEqual(python.stdout.readline().strip(), "frames 5")
        python.wait(60)
        self.assertTrue(self.all_ended(processes))

    def test_closing_ends_nothing_else(self):
        with Stream(self.config) as other:
            with Stream(self.config) as stream:
                stream.submit({}).result()
            self.assertTrue(other.submit({}).result().frame_id)


if __name__ == "__main__":
    unittest.main()
