"""Flights by the hundred: one process per flight, in batches, through Dask."""
import contextlib
import hashlib
import itertools
import json
import os
import re
import shlex
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BATCH = 1                       # every flight is kept when it ends
AHEAD = 8                       # tasks per processor that wait at the scheduler
FLIGHT_LIMIT_S = 120            # of processor time: a busy machine is no reason to give a campaign up
WALL_LIMIT_S = 3600             # a flight that waits for something that never comes
WORKERS_LIMIT_S = 30


class Broken(Exception):
    """The program did not fly; the text says why."""


def limited(words):
    """The same command, which the kernel ends after FLIGHT_LIMIT_S of processor time."""
    return ["/bin/sh", "-c", f'ulimit -S -t {FLIGHT_LIMIT_S}; exec "$@"', "plomada", *map(str, words)]


def reason_of(done):
    """Why this one did not fly."""
    if done.returncode == -signal.SIGXCPU:
        return f"took more than {FLIGHT_LIMIT_S} s of processor time"
    return done.stderr.strip() or f"ended with status {done.returncode}"


def fly(program, arguments, scenario=None):
    """The figures of one flight, as `plomada fly --json` gives them. scenario: the text of its file, which then stands before the
    arguments: it need not be on the machine that flies."""
    with tempfile.TemporaryDirectory(prefix="plomada-") as scratch:
        path = Path(scratch, "flight.json")
        if scenario is not None:
            own = Path(scratch, "own.scenario")
            own.write_text(scenario, encoding="utf-8")
            arguments = [str(own), *arguments]
        try:
            done = subprocess.run(limited([program, "fly", *arguments, "--json", path]), stdin=subprocess.DEVNULL,
                                  stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False,
                                  timeout=WALL_LIMIT_S)
            if done.returncode in (0, 1):
                return json.loads(path.read_text(encoding="utf-8"))
            reason = reason_of(done)
        except (OSError, ValueError, subprocess.TimeoutExpired) as error:
            reason = str(error)
    raise Broken(f"{program} fly {' '.join(arguments)}: {reason}")


def fly_batch(program, flights):
    """One task. flights: [(key, arguments)] or [(key, arguments, scenario)]; gives [(key, figures)]."""
    return [(key, fly(program, *flight)) for key, *flight in flights]


def version():
    """Of the sources beside these tools."""
    header = ROOT / "firmware/version.h"
    found = re.search(r'VERSION\w*\s+"([^"]+)"', header.read_text(encoding="utf-8") if header.exists() else "")
    return found.group(1) if found else ""


def provenance(program):
    """What a result tells of its program: the version of the sources, and the program's own sum."""
    return {"version": version(), "program": digest(program)[:12]}


def command(program, arguments):
    """What flies this flight again, for a shell."""
    return shlex.join([program, "fly", *arguments])


def write_whole(path, text):
    """All of it, or, on a full disk, the file as it was. What is no file (a pipe, a device) is written as it is."""
    path = Path(path)
    if path.exists() and not path.is_file():
        path.write_text(text, encoding="utf-8")
        return
    fresh = path.with_name(f"{path.name}.{os.getpid()}.new")
    try:
        fresh.write_text(text, encoding="utf-8")
        fresh.replace(path)
    finally:
        fresh.unlink(missing_ok=True)


def digest(program):
    return hashlib.sha256(Path(program).read_bytes()).hexdigest()


def key(program_digest, arguments):
    """Names a flight: the same program with the same arguments, and files of the same content, gives the same figures."""
    files = [digest(word) for word in arguments if ("." in word or "/" in word) and Path(word).is_file()]
    return hashlib.sha256(json.dumps([program_digest, *arguments, *files]).encode()).hexdigest()[:24]


@contextlib.contextmanager
def fleet(scheduler=None):
    """A Dask client: of the cluster at that address, else of this machine with a thread per processor, each of which
    waits for the process of its flight. What fails is told by Broken alone, without Dask's traceback. A cluster's workers need the program at the same path."""
    from distributed import Client, LocalCluster

    if scheduler:
        with Client(scheduler) as client:
            client.wait_for_workers(1, timeout=WORKERS_LIMIT_S)
            client.upload_file(__file__)
            yield client
        return
    with LocalCluster(n_workers=1, threads_per_worker=len(os.sched_getaffinity(0)), processes=False,
                      dashboard_address="127.0.0.1:0", silence_logs="CRITICAL") as cluster, Client(cluster) as client:
        yield client


def fly_all(client, program, flights, batch=BATCH):
    """Yields (key, figures) of fly_batch()'s flights as they come, in any order. Raises Broken with the first flight that
    could not be flown."""
    from distributed import as_completed

    flights = list(flights)
    batches = (flights[at:at + batch] for at in range(0, len(flights), batch))
    ahead = AHEAD * max(sum(client.nthreads().values()), 1)

    def submit(few):
        return [client.submit(fly_batch, program, some, pure=False) for some in few]

    waiting = as_completed(submit(itertools.islice(batches, ahead)), with_results=True)
    try:
        for _, results in waiting:
            waiting.update(submit(itertools.islice(batches, 1)))
            yield from results
    finally:
        client.cancel(list(waiting.futures))


class Store:
    """Results as JSON lines, one per flight, appended as they come. A line torn by an interruption is flown again."""

    def __init__(self, path):
        self.path = Path(path)
        self.known = {}
        self.labels = []            # of each flight that was kept before
        if self.path.exists():
            for line in self.path.read_text(encoding="utf-8").splitlines():
                with contextlib.suppress(ValueError, KeyError, TypeError):
                    record = json.loads(line)
                    self.known[record["key"]] = record.pop("figures")
                    self.labels.append(record)

    def __enter__(self):
        self.path.parent.mkdir(parents=True, exist_ok=True)
        torn = self.path.exists() and not self.path.read_bytes().endswith(b"\n") and self.path.stat().st_size > 0
        self.file = self.path.open("a", encoding="utf-8", buffering=1)
        if torn:
            self.file.write("\n")
        return self

    def __exit__(self, failed, *_):
        """What failed before anything was kept leaves nothing."""
        self.file.close()
        if failed and self.path.stat().st_size == 0:
            self.path.unlink()
            with contextlib.suppress(OSError):      # there is more in it
                self.path.parent.rmdir()

    def tell_of_another(self, program, wanted):
        """Says so when some of the flights {key: label} are kept, but by another program."""
        own = digest(program)[:12]
        missing = {json.dumps(label) for key, label in wanted.items() if key not in self.known}
        names = next(iter(wanted.values()), {})
        theirs = {json.dumps({name: record.get(name) for name in names}) for record in self.labels if record.get("program", own) != own}
        if missing & theirs:
            print(f"the program is another one than that of {len(missing & theirs)} kept flights: they are flown again", flush=True)

    def add(self, flight_key, label, figures):
        """label: what a reader wants to know of the flight (law, set, run)."""
        self.known[flight_key] = figures
        self.file.write(json.dumps({"key": flight_key, **label, "figures": figures}) + "\n")


class Progress:
    """Flights (or whatever is counted) done and the time that remains, on stderr: in place on a terminal, else a line every 5 s."""

    def __init__(self, total, out=None, what="flights"):
        self.out = sys.stderr if out is None else out
        self.what = what
        self.total, self.done = total, 0
        self.start = self.shown = time.monotonic()
        self.every_s = 0.2 if self.out.isatty() else 5.0

    def step(self):
        self.done += 1
        now = time.monotonic()
        if now - self.shown >= self.every_s:
            self.shown = now
            self.show(now)

    def show(self, now):
        left = (now - self.start) / self.done * (self.total - self.done)
        end = "\r" if self.out.isatty() else "\n"
        self.out.write(f"{self.done} of {self.total} {self.what}, {left:.0f} s remain   {end}")
        self.out.flush()
