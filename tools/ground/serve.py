#!/usr/bin/env python3
"""serve.py DIRECTORY PORT: the files of a directory, on this machine only."""
import argparse
import functools
import http.server
import sys
from pathlib import Path


def serve(directory, port):
    handler = functools.partial(http.server.SimpleHTTPRequestHandler, directory=directory)
    with http.server.ThreadingHTTPServer(("127.0.0.1", port), handler) as server:
        print(f"http://localhost:{server.server_port}", flush=True)
        try:
            server.serve_forever()
        except KeyboardInterrupt:
            pass


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("directory", metavar="DIRECTORY")
    parser.add_argument("port", metavar="PORT", type=int, help="0: any that is free")
    options = parser.parse_args()
    if not Path(options.directory).is_dir():
        parser.error(f"{options.directory}: no directory")
    try:
        serve(options.directory, options.port)
    except (OSError, OverflowError) as error:
        print(f"serve.py: port {options.port}: {getattr(error, 'strerror', None) or error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
