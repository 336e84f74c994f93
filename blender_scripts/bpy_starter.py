"""Runs a script in a Python that has Blender as the module bpy, as Blender itself would run it:

    python -I -B bpy_starter.py --threads T SCRIPT -- ARGUMENTS OF THE SCRIPT

The module begins with factory settings, without windows, and runs no script of a file by itself. As Blender
with --python-exit-code 3, this ends with 3 after an exception.
"""

import argparse
import os
import runpy
import sys
import traceback

import bpy


def main():
    parser = argparse.ArgumentParser(prog="bpy_starter.py")
    parser.add_argument("--threads", type=int, required=True)
    parser.add_argument("script")
    end = sys.argv.index("--") if "--" in sys.argv else len(sys.argv)
    options = parser.parse_args(sys.argv[1:end])
    _limit_threads(options.threads)
    _leave(_run(options.script))


def _run(script):
    """The exit status that the script asks for."""
    try:
        runpy.run_path(script, run_name="__main__")
    except SystemExit as end:
        return end.code if isinstance(end.code, int) else int(end.code is not None)
    except BaseException:
        traceback.print_exc()
        return 3
    return 0


def _leave(status):
    """The module's own way out waits for ever in some versions (4.5: a thread that closes files)."""
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)


def _limit_threads(threads):
    """An executable's --threads holds for every scene; a module knows only what a scene says."""
    @bpy.app.handlers.persistent
    def set_threads(*_):
        for scene in bpy.data.scenes:
            scene.render.threads_mode = "FIXED"
            scene.render.threads = threads

    bpy.app.handlers.load_post.append(set_threads)
    set_threads()


main()
