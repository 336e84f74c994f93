#!/usr/bin/python3
"""What is preloaded into a worker, in a process that has loaded Embree for one module alone, as the module
bpy does: run with LD_PRELOAD naming seedframe_worker_cpu.so.

    preload_test.py EMBREE
"""

import ctypes
import os
import sys
import unittest

EMBREE = sys.argv.pop(1)
NATIVE_RAY8, NATIVE_RAY16 = 33, 34  # RTC_DEVICE_PROPERTY_NATIVE_RAY…_SUPPORTED

preloaded = ctypes.CDLL(None)


def function(library, name, result, *arguments):
    found = getattr(library, name)
    found.restype, found.argtypes = result, arguments
    return found


new_device = function(preloaded, "rtcNewDevice", ctypes.c_void_p, ctypes.c_char_p)
embree_isa = function(preloaded, "seedframe_embree_isa", ctypes.c_char_p)


class PreloadTest(unittest.TestCase):
    def test_1_says_so_when_there_is_no_embree(self):
        self.assertIsNone(new_device(None))

    def test_2_finds_an_embree_that_nobody_else_sees(self):
        embree = ctypes.CDLL(EMBREE, mode=os.RTLD_LOCAL | os.RTLD_NOW)
        with self.assertRaises(AttributeError):
            preloaded.rtcGetDeviceProperty  # as it is: not in sight
        get_property = function(embree, "rtcGetDeviceProperty", ctypes.c_ssize_t, ctypes.c_void_p, ctypes.c_int)
        device = new_device(None)
        self.assertIsNotNone(device)
        isa = embree_isa().decode()
        self.assertEqual(get_property(device, NATIVE_RAY16) != 0, isa == "avx512")
        self.assertEqual(get_property(device, NATIVE_RAY8) != 0, isa in ("avx512", "avx2", "avx"))

        os.environ["SEEDFRAME_EMBREE_ISA"] = "sse2"
        pinned = new_device(b"verbose=0")
        self.assertIsNotNone(pinned)
        self.assertEqual(embree_isa(), b"sse2")
        self.assertEqual(get_property(pinned, NATIVE_RAY8), 0)


unittest.main()
