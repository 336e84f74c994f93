"""What three shells offer, asked of the shells themselves."""

import os
import pty
import re
import select
import subprocess
import time

BASH = r"""
source "$1"; shift
COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); COMP_LINE="$*"; COMP_POINT=${#COMP_LINE}
_seedframe
[ ${#COMPREPLY[@]} = 0 ] || printf '%s\n' "${COMPREPLY[@]}"
"""


def bash(script, *words, cwd=None):
    """The words that bash offers for the last of `words`, the first of which is the program."""
    shell = subprocess.run(["bash", "--norc", "-c", BASH, "bash", script, *words], capture_output=True, text=True,
                           check=True, cwd=cwd)
    assert shell.stderr == "", shell.stderr
    return shell.stdout.splitlines()


def fish(script, line, cwd=None):
    """The words that fish offers at the end of a line."""
    command = 'source $argv[1]; complete -C "$argv[2]"'
    shell = subprocess.run(["fish", "--no-config", "-c", command, script, line], capture_output=True, text=True,
                           check=True, cwd=cwd)
    assert shell.stderr == "", shell.stderr
    return [offer.split("\t")[0] for offer in shell.stdout.splitlines()]


class Zsh:
    """An interactive zsh that somebody types into: it tells what it offers to nobody else."""

    def __init__(self, script, cwd):
        self.process, self.terminal = pty.fork()
        if self.process == 0:
            os.chdir(cwd)
            os.execvpe("zsh", ["zsh", "-f", "-i"], {**os.environ, "TERM": "dumb", "COLUMNS": "200", "LINES": "200"})
        self.unread = ""
        folder = os.path.dirname(script)
        self.type(f"PS1='rea''dy> '; fpath=({folder} $fpath); autoload -Uz compinit; compinit -D -u; LISTMAX=1000; "
                  "unset zle_bracketed_paste; stty cols 200 rows 200\n")
        self.read_until("ready> ")

    def type(self, text):
        os.write(self.terminal, text.encode())

    def read_until(self, text, longest_s=60):
        """Everything up to `text`; AssertionError if it does not come."""
        end = time.monotonic() + longest_s
        while text not in self.unread:
            ready, _, _ = select.select([self.terminal], [], [], max(0, end - time.monotonic()))
            assert ready, f"zsh does not say {text!r}: {self.unread!r}"
            self.unread += os.read(self.terminal, 65536).decode(errors="replace")
        output, _, self.unread = self.unread.partition(text)
        return output

    def offers(self, line):
        """The words of the list that the key ^D shows at the end of a line; the line is taken away again."""
        self.type(f"{line}\x04\x15echo en'd'-of-list\n")
        output = self.read_until("end-of-list") + self.read_until("ready> ")
        return set(re.findall(r"[^\s]+", output))

    def close(self):
        os.close(self.terminal)
        os.waitpid(self.process, 0)
