"""What a tool prints, whoever reads it: `head` closes the pipe when it has read enough. The work goes on, and its status counts."""
import os
import sys


def say(text):
    try:
        print(text, flush=True)
    except BrokenPipeError:
        nowhere = os.open(os.devnull, os.O_WRONLY)      # for what is still in the buffer, and what is said later
        os.dup2(nowhere, sys.stdout.fileno())
        os.close(nowhere)
