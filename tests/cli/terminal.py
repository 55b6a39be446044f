"""Types into a shell on a terminal and returns the command line that it made of the keys.

    terminal.py bash|zsh SETUP... <QUESTIONS >ANSWERS

SETUP are commands that the shell runs first. A question is a line of keys, with <TAB> for the key Tab and <ALL> for
inserting all completions (bash); the answer is the command line after these keys.
"""

import os
import pty
import select
import sys
import time

SHELLS = {
    "bash": (["bash", "--norc", "--noprofile", "-i"],
             ["bind 'set bell-style none'", "bind 'set completion-query-items 0'",
              """bind -x '"\\C-t": printf "%s\\n" "$READLINE_LINE" >>answers'"""]),
    "zsh": (["zsh", "-f", "-i"],
            ["unsetopt beep", "autoload -Uz compinit && compinit -u -D",
             "answer() { print -r -- $BUFFER >>answers; BUFFER= }", "zle -N answer", "bindkey '^T' answer"]),
}
KEYS = {"<TAB>": "\t", "<ALL>": "\x1b*"}
PATIENCE = 60  # s

shell = sys.argv[1]
program, first = SHELLS[shell]
open("answers", "w").close()
child, terminal = pty.fork()
if child == 0:
    os.environ.update(TERM="dumb", PS1="", HOME=os.getcwd(), ZDOTDIR=os.getcwd(), LC_ALL="C.UTF-8")
    os.execvp(program[0], program)


def drain():
    while select.select([terminal], [], [], 0)[0]:
        try:
            os.read(terminal, 65536)
        except OSError:
            return


def type_and_wait(keys, answers):
    """Types until the file has this many answers; a shell that has not drawn its prompt yet may miss keys."""
    os.write(terminal, keys.encode())
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        drain()
        with open("answers") as file:
            lines = file.read().splitlines()
        if len(lines) >= answers:
            return lines[answers - 1]
        time.sleep(0.01)
    sys.exit(f"{shell} did not answer to {keys!r}")


# The setup answers, too, so that no key comes too early.
type_and_wait("\n".join(first + sys.argv[2:]) + "\necho ready >>answers\n", 1)
for number, question in enumerate(sys.stdin.read().splitlines()):
    for name, key in KEYS.items():
        question = question.replace(name, key)
    print(type_and_wait(question + "\x14" + ("\x15" if shell == "bash" else ""), number + 2))
os.write(terminal, b"exit\n")
