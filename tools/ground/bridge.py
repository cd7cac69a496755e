#!/usr/bin/env python3
"""bridge.py PORT COMMAND...: a flight in a program of its own, its radio offered to the page as a WebSocket on this machine.

    bridge.py 8124 build/plomada fly hover-60s --realtime

COMMAND is run with `--xbee pty` behind it; its first line names the pseudo-terminal of its radio. The first line here is the address with its key.
A page of this machine and a program that is no browser need no key; any other page does, or it is answered 403. What is said while nobody is
connected is dropped, so that a late client gets nothing stale; a second client is answered 503. Ends with the command, or ends it.
"""
import asyncio
import os
import secrets
import signal
import sys
import tty
from http import HTTPStatus
from urllib.parse import urlsplit

from websockets.asyncio.server import broadcast, serve
from websockets.exceptions import ConnectionClosed

LOCAL = ("localhost", "127.0.0.1", "::1")


def is_local(origin):
    """Whether an Origin (RFC 6454) is a page of this machine. That of a page from a disk is `null`, which is anybody's."""
    try:
        parts = urlsplit(origin)
        return parts.hostname in LOCAL and (parts.port is None or parts.port >= 0)
    except ValueError:      # no port is a number: localhost:80.strange.example
        return False


class Bridge:
    def __init__(self, terminal):
        self.terminal, self.client = terminal, None
        self.key = secrets.token_hex(8)     # 64 bits, which no page can try out

    def admit(self, connection, request):
        """Every browser tells from where a page came, and every page that it shows can reach this machine's ports."""
        origin = request.headers.get("Origin")
        if request.path != f"/{self.key}" and origin is not None and not is_local(origin):
            return connection.respond(HTTPStatus.FORBIDDEN, "the address with its key is what the program printed\n")
        return connection.respond(HTTPStatus.SERVICE_UNAVAILABLE, "another page has it\n") if self.client else None

    async def talk(self, client):
        if self.client:     # two that came at once
            await client.close(1013)
            return
        self.client = client
        try:
            async for said in client:
                os.write(self.terminal, said.encode() if isinstance(said, str) else said)
        except (ConnectionClosed, OSError):
            pass
        finally:
            self.client = None

    def heard(self):
        try:
            octets = os.read(self.terminal, 1024)
        except OSError:     # the program is gone, and its end of the line
            octets = b""
        if not octets:
            asyncio.get_running_loop().remove_reader(self.terminal)
        elif self.client:
            broadcast([self.client], octets)


async def run(port, command):
    loop = asyncio.get_running_loop()
    flight = await asyncio.create_subprocess_exec(*command, "--xbee", "pty", stdout=asyncio.subprocess.PIPE)

    def stop():
        if flight.returncode is None:       # Ctrl-C reaches the flight by itself
            flight.terminate()

    for number in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(number, stop)
    try:
        said = (await flight.stdout.readline()).decode()
        if not said.startswith("xbee: "):
            print(f"bridge.py: {command[0]} offers no radio", file=sys.stderr)
            return 2
        terminal = os.open(said.split()[1], os.O_RDWR | os.O_NOCTTY)
        tty.setraw(terminal)
        bridge = Bridge(terminal)
        async with serve(bridge.talk, "127.0.0.1", port, process_request=bridge.admit, compression=None):
            print(f"xbee: ws://localhost:{port}/{bridge.key}", flush=True)
            loop.add_reader(terminal, bridge.heard)
            while line := await flight.stdout.readline():
                sys.stdout.write(line.decode())
            await flight.wait()
            loop.remove_reader(terminal)
        return flight.returncode
    finally:
        stop()
        await flight.wait()


def main():
    if len(sys.argv) < 3 or not sys.argv[1].isdigit() or not 0 < int(sys.argv[1]) < 65536:
        print(__doc__, file=sys.stderr)
        return 2
    try:
        return asyncio.run(run(int(sys.argv[1]), sys.argv[2:]))
    except OSError as error:
        print(f"bridge.py: {error.strerror or error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
