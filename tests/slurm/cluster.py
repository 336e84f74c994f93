"""A Slurm cluster on this machine for a test, by scripts/slurm-dev.sh, and what breaks in one."""

import contextlib
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time

HOME = pathlib.Path(__file__).resolve().parents[2]
SCRIPT = HOME / "scripts" / "slurm-dev.sh"
PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scancel", "scontrol", "sinfo")
SKIPPED = 77  # the exit code that ctest takes for a test that was left out


def missing_programs():
    path = os.environ.get("PATH", "") + ":/usr/sbin"
    return [program for program in PROGRAMS if not shutil.which(program, path=path)]


class Cluster:
    """Nodes n1, n2, … that are up; SLURM_CONF of this process, and so of what it starts, is theirs."""

    def __init__(self, nodes=3, cpus=2, max_array_size=1001, settings=()):
        # Not where campaigns are: sockets want short names, and slurm.conf simple ones.
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="seedframe-slurm-", dir="/tmp"))
        self.nodes = [f"n{i + 1}" for i in range(nodes)]
        self.cpus = cpus
        command = [SCRIPT, "up", self.folder, "--nodes", str(nodes), "--cpus", str(cpus), "--max-array-size",
                   str(max_array_size)]
        for setting in settings:
            command += ["--set", setting]
        try:
            subprocess.run(command, check=True, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        except BaseException:
            self.down()
            raise
        os.environ["SLURM_CONF"] = str(self.folder / "slurm.conf")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.down()

    def down(self):
        self._script("down")
        shutil.rmtree(self.folder, ignore_errors=True)

    def _script(self, verb, *arguments):
        subprocess.run([SCRIPT, verb, self.folder, *arguments], check=True, stdin=subprocess.DEVNULL,
                       stdout=subprocess.DEVNULL)

    # ---- What there is ----

    def jobs(self):
        """(job or job_index, state, node, comment) of all that is not over; None while nobody answers."""
        asked = ask("squeue", "--noheader", "--array", "--format=%i|%T|%N|%k")
        if asked is None:
            return None
        return [tuple(line.split("|")) for line in asked.splitlines()]

    def node_state(self, node):
        """Such as "idle" or "down*"; empty while nobody answers."""
        # A line for each partition that it is in.
        return (ask("sinfo", "--noheader", "--Node", f"--nodes={node}", "--format=%T") or "").strip().split("\n")[0]

    def arrays(self):
        """Comments of arrays by job, of all that the controller remembers (MinJobAge)."""
        found = {}
        for line in (ask("scontrol", "--oneliner", "show", "jobs") or "").splitlines():
            fields = dict(word.split("=", 1) for word in line.split(" ") if "=" in word)
            if "ArrayJobId" in fields:
                comment = line.partition(" Comment=")[2].partition(" StdErr=")[0].strip()
                found[int(fields["ArrayJobId"])] = comment
        return found

    def fate(self, task):
        """What the controller knows of a task, in a line."""
        words = (ask("scontrol", "--oneliner", "show", "job", task) or "").split()
        wanted = ("JobState", "Reason", "ExitCode", "Restarts", "StartTime", "EndTime", "NodeList")
        return " ".join([task, *(word for word in words if word.split("=")[0] in wanted)])

    # ---- What breaks ----

    def kill_controller(self):
        os.kill(int((self.folder / "slurmctld.pid").read_text(encoding="ascii")), signal.SIGKILL)

    def start_controller(self):
        self._script("start", "slurmctld")

    def kill_daemon(self, node):
        """The node's slurmd alone; its jobs go on."""
        os.kill(int((self.folder / f"slurmd.{node}.pid").read_text(encoding="ascii")), signal.SIGKILL)

    def start_node(self, node):
        self._script("start", node)

    def kill_node(self, node):
        self._script("kill-node", node)

    def stop_node(self, node):
        self._script("stop-node", node)

    def continue_node(self, node):
        self._script("continue-node", node)

    def step_daemons(self):
        """Process ids of slurmstepds, one for each task that runs."""
        marker = f"SLURM_DEV_PART={self.folder}/n".encode()
        found = []
        for folder in pathlib.Path("/proc").iterdir():
            with contextlib.suppress(OSError):
                if folder.name.isdigit() and (folder / "cmdline").read_bytes().startswith(b"slurmstepd: [") and \
                        any(word.startswith(marker) for word in (folder / "environ").read_bytes().split(b"\0")):
                    found.append(int(folder.name))
        return found

    def resume_drained(self):
        """What an administrator does about nodes that Slurm has drained; why it had, one text a node."""
        listed = ask("sinfo", "--noheader", "--Node", "--states=drain", "--format=%N|%E") or ""
        drained = dict(line.split("|", 1) for line in listed.splitlines())
        for node in drained:
            ask("scontrol", "update", f"NodeName={node}", "State=RESUME")
        return [f"{node}: {reason}" for node, reason in drained.items()]

    def heal(self, patience_s=180):
        """Whatever was done to it: all nodes idle, no jobs. Raises TimeoutError if that does not come."""
        if not self._responds():
            with contextlib.suppress(subprocess.CalledProcessError):
                self.start_controller()
        deadline = time.monotonic() + patience_s
        while (jobs := self.jobs()) or jobs is None or any(self.node_state(node) != "idle" for node in self.nodes):
            self.resume_drained()
            if time.monotonic() > deadline:
                states = [self.node_state(node) for node in self.nodes]
                raise TimeoutError(f"the cluster in {self.folder} does not recover: jobs {jobs}, nodes {states}")
            time.sleep(0.2)

    def _responds(self):
        return ask("scontrol", "ping") is not None


def ask(*command, timeout=30):
    """What a program of Slurm prints; None if it fails."""
    try:
        run = subprocess.run(command, check=False, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                             timeout=timeout)
    except subprocess.TimeoutExpired:
        return None
    return run.stdout if run.returncode == 0 else None
