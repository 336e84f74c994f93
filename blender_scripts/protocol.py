"""The worker's side of docs/formats/worker-protocol.md. Needs no Blender, so it is tested without one."""

import dataclasses
import json
import os
import threading
import time

PROTOCOL = 5
SPEC_VERSIONS = (5, 6, 7)


class ProtocolError(Exception):
    """The scheduler sent something that this worker does not understand."""


@dataclasses.dataclass(frozen=True)
class RenderRequest:
    frame: int
    attempt: int
    frame_id: str
    spec: dict
    output: str
    meshes: dict
    textures: dict
    sample_counts: bool
    save_scene: bool

    @staticmethod
    def parse(line):
        try:
            message = json.loads(line)
        except ValueError as error:
            raise ProtocolError(f"a request is no JSON ({error}): {line[:200]!r}") from None
        if not isinstance(message, dict) or message.get("type") != "render":
            raise ProtocolError(f"expected a 'render' request, got {line[:200]!r}")
        for wish in ("sample_counts", "save_scene"):
            message.setdefault(wish, False)
        kinds = {field.name: field.type for field in dataclasses.fields(RenderRequest)}
        for key, kind in kinds.items():
            if not isinstance(message.get(key), kind):
                raise ProtocolError(f"'{key}' of a render request is missing or no {kind.__name__}")
        return RenderRequest(**{key: message[key] for key in kinds})


@dataclasses.dataclass(frozen=True)
class Ready:
    blender: str
    build: str
    ocio_config: str
    kernel: str
    embree: str
    reciprocals: str
    libc: str
    device: str
    devices: str
    denoisers: str
    protocol: int = PROTOCOL
    type: str = "ready"


@dataclasses.dataclass(frozen=True)
class Alive:
    memory_bytes: int
    type: str = "alive"


@dataclasses.dataclass(frozen=True)
class Done:
    frame: int
    attempt: int
    build_s: float
    render_s: float
    cpu_s: float
    type: str = "done"


@dataclasses.dataclass(frozen=True)
class Failed:
    frame: int
    attempt: int
    error: str
    type: str = "failed"


class Channel:
    """Messages over two file descriptors, which may be the same one."""

    def __init__(self, read_fd, write_fd):
        # Whatever Blender starts must not keep the channel open.
        os.set_inheritable(read_fd, False)
        os.set_inheritable(write_fd, False)
        self._reader = os.fdopen(read_fd, "rb", buffering=1 << 16, closefd=False)
        self._write_fd = write_fd
        self._lock = threading.Lock()  # lines of several threads

    def send(self, message):
        line = json.dumps(dataclasses.asdict(message), ensure_ascii=False) + "\n"
        data = line.encode("utf-8", errors="replace")
        with self._lock:
            while data:
                data = data[os.write(self._write_fd, data):]

    def send_signs_of_life(self, interval_s):
        """Sends `Alive` for ever, from a thread of its own."""
        def send():
            while True:
                self.send(Alive(resident_bytes()))
                time.sleep(interval_s)

        threading.Thread(target=send, daemon=True).start()

    def requests(self):
        """Yields requests until the scheduler closes its end."""
        for line in self._reader:
            if line.endswith(b"\n"):  # half a line means that the scheduler died while writing
                yield RenderRequest.parse(line)


def resident_bytes():
    """Of this process (proc(5), statm)."""
    with open("/proc/self/statm", encoding="ascii") as counts:
        return int(counts.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")
