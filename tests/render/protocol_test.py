#!/usr/bin/python3
"""Tests of the parts of the worker that need no Blender."""

import json
import os
import pathlib
import sys
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "blender_scripts"
sys.path.insert(0, str(SCRIPTS))
sys.dont_write_bytecode = True

import cpu_kernel  # noqa: E402
from bounded_cache import BoundedCache  # noqa: E402
from protocol import Channel, Done, Failed, ProtocolError, Ready, RenderRequest  # noqa: E402

REQUEST = {"type": "render", "frame": 42, "attempt": 2, "frame_id": "ab", "spec": {"version": 1}, "output": "/x.exr",
           "meshes": {"a": "/a.mesh"}, "textures": {}}


class RenderRequestTest(unittest.TestCase):
    def test_reads_what_the_scheduler_sends(self):
        request = RenderRequest.parse(json.dumps(REQUEST).encode())
        self.assertEqual((request.frame, request.attempt, request.output), (42, 2, "/x.exr"))
        self.assertEqual(request.meshes, {"a": "/a.mesh"})

    def test_ignores_keys_that_it_does_not_know(self):
        RenderRequest.parse(json.dumps({**REQUEST, "later": 1}).encode())

    def test_saves_the_scene_only_where_it_is_asked_to(self):
        self.assertFalse(RenderRequest.parse(json.dumps(REQUEST).encode()).save_scene)
        self.assertTrue(RenderRequest.parse(json.dumps({**REQUEST, "save_scene": True}).encode()).save_scene)

    def test_asks_for_sample_counts_only_where_it_says_so(self):
        self.assertFalse(RenderRequest.parse(json.dumps(REQUEST).encode()).sample_counts)
        self.assertTrue(RenderRequest.parse(json.dumps({**REQUEST, "sample_counts": True}).encode()).sample_counts)

    def test_refuses_anything_else(self):
        for bad in (b"", b"{", b"[]", b'"render"', b'{"type": "stop"}'):
            with self.assertRaises(ProtocolError, msg=bad):
                RenderRequest.parse(bad)
        for key in ("frame", "attempt", "frame_id", "spec", "output", "meshes", "textures"):
            for broken in ({k: v for k, v in REQUEST.items() if k != key}, {**REQUEST, key: None}):
                with self.assertRaisesRegex(ProtocolError, key):
                    RenderRequest.parse(json.dumps(broken).encode())


class ChannelTest(unittest.TestCase):
    def setUp(self):
        self.read_fd, self.far_write = os.pipe()
        self.far_read, self.write_fd = os.pipe()
        self.channel = Channel(self.read_fd, self.write_fd)

    def test_yields_requests_until_the_end(self):
        os.write(self.far_write, (json.dumps(REQUEST) + "\n").encode() * 2)
        os.close(self.far_write)
        self.assertEqual([r.frame for r in self.channel.requests()], [42, 42])

    def test_ignores_half_a_request_of_a_scheduler_that_died(self):
        os.write(self.far_write, json.dumps(REQUEST).encode()[:40])
        os.close(self.far_write)
        self.assertEqual(list(self.channel.requests()), [])

    def test_sends_one_line_for_a_message(self):
        self.channel.send(Ready("3.4.1", "hash", "/config.ocio", "avx2", "avx512", "0123", "glibc 2.36", "cpu", "CPU (a)",
                                "OpenImageDenoise"))
        self.channel.send(Done(42, 2, 0.5, 1.5, 2.5))
        self.channel.send(Failed(42, 2, "two\nlines, \udc80 and µ"))
        ready, done, failed = map(json.loads, os.read(self.far_read, 10000).splitlines())
        self.assertEqual(ready, {"type": "ready", "protocol": 5, "blender": "3.4.1", "build": "hash",
                                 "ocio_config": "/config.ocio", "kernel": "avx2", "embree": "avx512",
                                 "reciprocals": "0123", "libc": "glibc 2.36", "device": "cpu",
                                 "devices": "CPU (a)", "denoisers": "OpenImageDenoise"})
        self.assertEqual(done, {"type": "done", "frame": 42, "attempt": 2, "build_s": 0.5,
                                "render_s": 1.5, "cpu_s": 2.5})
        self.assertEqual(failed["error"], "two\nlines, ? and µ")


    def test_gives_signs_of_life_while_it_does_something_else(self):
        self.channel.send_signs_of_life(0.01)
        for _ in range(3):
            alive = json.loads(os.read(self.far_read, 10000).splitlines()[0])
            self.assertEqual(alive["type"], "alive")
            self.assertGreater(alive["memory_bytes"], 1_000_000)


class CpuKernelTest(unittest.TestCase):
    MODERN = cpu_kernel.capabilities_in("\nCPU device capabilities: SSE2 SSE3 SSE41 AVX AVX2\n")

    def test_takes_the_best_that_the_cpu_has(self):
        self.assertEqual(cpu_kernel.choose(self.MODERN, {}, (3, 4, 1)), "avx2")
        self.assertEqual(cpu_kernel.choose(self.MODERN - {"AVX2"}, {}, (3, 4, 1)), "avx")
        self.assertEqual(cpu_kernel.choose({"SSE2"}, {}, (3, 4, 1)), "sse2")

    def test_forbidding_one_forbids_all_above(self):
        self.assertEqual(cpu_kernel.choose(self.MODERN, {"CYCLES_CPU_NO_AVX2": "1"}, (3, 4, 1)), "avx")
        self.assertEqual(cpu_kernel.choose(self.MODERN, {"CYCLES_CPU_NO_SSE41": ""}, (3, 4, 1)), "sse3")

    def test_blender_4_has_fewer_kernels(self):
        self.assertEqual(cpu_kernel.choose(self.MODERN, {}, (4, 0, 2)), "avx2")
        self.assertEqual(cpu_kernel.choose(self.MODERN - {"AVX2"}, {}, (4, 1, 1)), "sse41")
        self.assertEqual(cpu_kernel.choose({"SSE42", "AVX2"}, {}, (4, 2, 23)), "avx2")
        self.assertEqual(cpu_kernel.choose({"SSE42", "AVX2"}, {"CYCLES_CPU_NO_AVX2": ""}, (4, 2, 23)), "sse42")
        self.assertEqual(cpu_kernel.choose({"SSE42", "AVX2"}, {"CYCLES_CPU_NO_SSE42": ""}, (4, 2, 23)), "generic")

    def test_later_ones_begin_with_sse42_and_do_not_list_it(self):
        for version in ((4, 5, 15), (5, 0, 1), (6, 0, 0)):
            self.assertEqual(cpu_kernel.choose({"AVX2"}, {}, version), "avx2")
            self.assertEqual(cpu_kernel.choose(set(), {}, version), "sse42")
            self.assertEqual(cpu_kernel.choose({"AVX2"}, {"CYCLES_CPU_NO_AVX2": ""}, version), "sse42")


class BoundedCacheTest(unittest.TestCase):
    def setUp(self):
        self.removed = []
        self.cache = BoundedCache(10, self.removed.append)

    def put(self, key, size):
        return self.cache.get(key, lambda: (key.upper(), size))

    def test_makes_a_value_once(self):
        self.assertEqual(self.put("a", 4), "A")
        self.assertEqual(self.cache.get("a", lambda: self.fail("made twice")), "A")

    def test_drops_the_least_recently_used(self):
        for key in "ab":
            self.put(key, 4)
        self.cache.next_frame()
        self.put("a", 4)
        self.put("c", 4)
        self.cache.trim()
        self.assertEqual(self.removed, ["B"])

    def test_never_drops_what_the_frame_uses(self):
        self.put("a", 8)
        self.put("b", 8)
        self.cache.trim()
        self.assertEqual(self.removed, [])
        self.cache.next_frame()
        self.put("b", 8)
        self.cache.trim()
        self.assertEqual(self.removed, ["A"])

    def test_a_failed_make_leaves_nothing(self):
        with self.assertRaises(ValueError):
            self.cache.get("a", lambda: (_ for _ in ()).throw(ValueError()))
        self.assertEqual(self.put("a", 1), "A")


class FakeBlenderTest(unittest.TestCase):
    def test_is_a_pure_function_of_the_spec(self):
        sys.path.insert(0, str(SCRIPTS.parent / "tests" / "fake_blender"))
        import fake_blender
        spec = {"render": {"width": 8, "height": 6, "seed": 7, "depth": True, "normal": False},
                "camera": {"focal_px": [10, 10]}, "world": {"color": [1, 1, 1], "strength": 0.5},
                "materials": [{"base_color": [1, 0, 0]}],
                "instances": [{"id": 3, "materials": [0],
                               "camera_from_object": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -1, 0, 0, 0, 1]}]}
        first = fake_blender.exr_bytes(*fake_blender.draw(spec), "id")
        self.assertEqual(first, fake_blender.exr_bytes(*fake_blender.draw(spec), "id"))
        self.assertEqual(first[:4], b"\x76\x2f\x31\x01")


if __name__ == "__main__":
    unittest.main()
