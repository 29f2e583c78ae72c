#!/usr/bin/env python3
"""A VR client in Python: a visitor who walks a slow circle, and prints what the column does.

    python3 visitor.py --url ws://127.0.0.1:7878 --seconds 10

Needs Python 3.9 or newer and the package `websockets` (10 or newer): python3 -m pip install websockets
Positions are in the `ros` convention: the room's own axes, metres, +z up.
"""

import argparse
import asyncio
import json
import math
import os
import ssl
import sys
import time

try:
    from websockets.asyncio.client import connect
    from websockets.exceptions import ConnectionClosed, InvalidHandshake
except ImportError:
    try:  # before 13
        from websockets import connect
        from websockets.exceptions import ConnectionClosed, InvalidHandshake
    except ImportError:
        sys.exit("visitor.py: the package `websockets` is missing; install it with: python3 -m pip install websockets")

RATE_HZ = 90


def micros():
    """The client's clock: whole microseconds from any start."""
    return time.monotonic_ns() // 1000


def head_pose(sequence, secs):
    """Half a metre about the middle of a room of four metres, once in twelve seconds, looking ahead."""
    angle = 2 * math.pi * secs / 12
    yaw = angle + math.pi / 2
    return {
        "type": "pose", "person": "visitor", "sequence": sequence, "client_time_micros": micros(),
        "position": [2 + 0.5 * math.cos(angle), 2 + 0.5 * math.sin(angle), 1.65],
        "orientation": [0, 0, math.sin(yaw / 2), math.cos(yaw / 2)], "tracked": True, "worn": True,
    }


async def walk(socket, seconds):
    """Poses at an even rate; the next deadline by addition, so that no delay adds up."""
    start = time.monotonic()
    for sequence in range(1, int(seconds * RATE_HZ) + 1):
        due = start + sequence / RATE_HZ
        await asyncio.sleep(max(0, due - time.monotonic()))
        await socket.send(json.dumps(head_pose(sequence, sequence / RATE_HZ)))


async def ping(socket, pongs):
    """One ping a second; each says when the pong before it came, which gives the server both clocks."""
    number = 0
    while True:
        number += 1
        message = {"type": "clock_ping", "id": number, "client_time_micros": micros()}
        if pongs:
            message["previous"] = pongs[-1]
        await socket.send(json.dumps(message))
        await asyncio.sleep(1)


async def listen(socket, heard, pongs):
    """Take in everything; print what is news."""
    async for text in socket:
        message = json.loads(text)
        kind = message["type"]
        heard[kind] = heard.get(kind, 0) + 1
        if kind == "clock_pong":
            pongs.append({"id": message["id"], "received_client_time_micros": micros()})
        elif kind == "welcome":
            print(f"welcome from CoVR {message['server_version']}", flush=True)
        elif kind == "column" and heard[kind] % 30 == 1:
            x, y, _ = message["position"]
            print(f"column at {x:.2f}, {y:.2f} m, {message['mode']}", flush=True)
        elif kind == "stop":
            print(f"stopped: {message['reason']}" if message["stopped"] else "not stopped", flush=True)
        elif kind == "error":
            print(f"refused: {message['message']}", flush=True)


async def visit(url, seconds, token, authority):
    heard, pongs = {}, []
    hello = {"type": "hello", "name": "example script", "convention": "ros"}
    if token:
        hello["token"] = token
    secure = {"ssl": ssl.create_default_context(cafile=authority)} if url.startswith("wss://") else {}
    async with connect(f"{url.rstrip('/')}/ws/v1/client", subprotocols=["covr.v1.json"], **secure) as socket:
        await socket.send(json.dumps(hello))
        await socket.send(json.dumps({"type": "enter", "person": "visitor"}))
        others = [asyncio.create_task(listen(socket, heard, pongs)), asyncio.create_task(ping(socket, pongs))]
        await walk(socket, seconds)
        await socket.send(json.dumps({"type": "leave", "person": "visitor"}))
        for task in others:
            task.cancel()
    print("heard " + ", ".join(f"{count} {kind}" for kind, count in sorted(heard.items())))
    return 0 if heard.get("column") and not heard.get("error") else 1


def main():
    about, _, usage = __doc__.partition("\n\n")
    parser = argparse.ArgumentParser(description=about, epilog=usage, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--url", default="ws://127.0.0.1:7878", help="the server (default: %(default)s)")
    parser.add_argument("--seconds", type=float, default=10, help="how long to walk (default: %(default)s)")
    parser.add_argument("--token", default=os.environ.get("COVR_TOKEN"), help="where the server has tokens (default: the variable COVR_TOKEN)")
    parser.add_argument("--authority", help="the authority of the server's certificate (PEM), for wss")
    options = parser.parse_args()
    try:
        return asyncio.run(visit(options.url, options.seconds, options.token, options.authority))
    except (OSError, InvalidHandshake, ConnectionClosed) as why:
        print(f"visitor.py: {options.url}: {why}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
