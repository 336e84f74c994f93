import asyncio
import json
import unittest

import support  # noqa: F401, so that the package is found
from support import FAKE_BLENDER, ProgramTest, children_of, is_running, wait_until

from seedframe import AsyncStream, Error, Stream


class Async(ProgramTest):
    def expected(self, count):
        with Stream(self.config) as stream:
            return [frame.frame_id for frame in stream.render({"turn": turn} for turn in range(count))]

    def test_frames_come_in_order(self):
        async def work():
            async with AsyncStream(self.config) as stream:
                self.assertIn("turn", stream.variables)

                async def later():
                    for turn in range(80):
                        await asyncio.sleep(0)
                        yield {"turn": turn}

                plain = [frame.frame_id async for frame in stream.render({"turn": turn} for turn in range(80))]
                other = [frame.frame_id async for frame in stream.render(later())]
                return plain, other

        plain, other = asyncio.run(work())
        expected = self.expected(80)
        self.assertEqual(plain, expected)
        self.assertEqual(other, expected)

    def test_frames_are_kept(self):
        async def work():
            async with AsyncStream(self.config, "render", blender=FAKE_BLENDER, keep=self.folder / "kept") as stream:
                return (await stream.frame({"turn": 3})).kept

        self.assertEqual(asyncio.run(work()), 0)

    def test_as_they_are_made(self):
        async def work():
            async with AsyncStream(self.config) as stream:
                return {
                    k: frame.frame_id async for k, frame in stream.as_completed([{"turn": turn} for turn in range(40)])
                }

        made = asyncio.run(work())
        self.assertEqual([made[k] for k in range(40)], self.expected(40))

    def test_the_loop_goes_on_while_there_is_no_room(self):
        self.environment(SEEDFRAME_FAKE=json.dumps({"delay_s": 0.2}))

        async def work():
            options = ["--most-open", "2"]
            async with AsyncStream(self.config, "render", 1, blender=FAKE_BLENDER, options=options) as stream:
                ticks = 0

                async def tick():
                    nonlocal ticks
                    while True:
                        await asyncio.sleep(0.01)
                        ticks += 1

                ticking = asyncio.create_task(tick())
                frames = await asyncio.gather(*[stream.frame({"turn": turn}) for turn in range(6)])
                ticking.cancel()
                return ticks, len({frame.frame_id for frame in frames})

        ticks, count = asyncio.run(work())
        self.assertEqual(count, 6)
        self.assertGreater(ticks, 10)

    def test_errors_and_cancelling(self):
        self.environment(SEEDFRAME_FAKE=json.dumps({"delay_s": 0.3}))

        async def work():
            async with AsyncStream(self.config, "render", 1, blender=FAKE_BLENDER) as stream:
                with self.assertRaisesRegex(Error, "did you mean 'turn'"):
                    await stream.frame({"trun": 1})
                futures = [await stream.submit({"turn": turn}) for turn in range(20)]
                await futures[0]
                for future in futures[3:]:
                    future.cancel()
                with self.assertRaises(asyncio.CancelledError):
                    await futures[-1]
                self.assertTrue((await stream.frame({"turn": 55})).frame_id)

        asyncio.run(work())

    def test_a_cancelled_task_leaves_nothing(self):
        self.environment(SEEDFRAME_FAKE=json.dumps({"delay_s": 0.3}))
        processes = []

        async def work():
            async with AsyncStream(self.config, "render", 1, blender=FAKE_BLENDER) as stream:
                async for _ in stream.render({"turn": turn} for turn in range(1000)):
                    program = stream.ready["process"]
                    processes.extend([program, *children_of(program)])
                    asyncio.current_task().cancel()

        with self.assertRaises(asyncio.CancelledError):
            asyncio.run(work())
        self.assertTrue(processes)
        self.assertTrue(wait_until(lambda: not any(is_running(process) for process in processes)))

    def test_a_wrong_config(self):
        async def work():
            async with AsyncStream(self.folder / "nope.yaml"):
                pass

        with self.assertRaisesRegex(Error, "cannot read"):
            asyncio.run(work())
        with self.assertRaisesRegex(RuntimeError, "async with"):
            AsyncStream(self.config).variables


if __name__ == "__main__":
    unittest.main()
