"""Where corrected samples go: lines of JSON to a stream, a Unix socket, or datagrams.

No reader can hold the service up: what one does not take in time is dropped for it, a whole line.
"""

import os
import socket
from ipaddress import ip_address
from pathlib import Path
from typing import Protocol, TextIO

from ..errors import ZerorateError


class Sink(Protocol):
    """Takes lines."""

    def put(self, line: bytes) -> None:
        """One line of JSON, ended."""

    def close(self) -> None:
        """No more come."""


class Lines:
    """Lines on a text stream, standard output as a rule."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    def put(self, line: bytes) -> None:
        self._stream.write(line.decode())
        self._stream.flush()

    def close(self) -> None:
        """The stream is its owner's."""


class Datagrams:
    """A line a datagram to HOST:PORT, loopback unless remote. Raises ZerorateError."""

    def __init__(self, address: str, remote: bool = False) -> None:
        host, _, port = address.rpartition(":")
        try:
            target, number = ip_address(host.strip("[]")), int(port)
        except ValueError:
            raise ZerorateError(f"--udp {address}: write ADDRESS:PORT, as 127.0.0.1:9750") from None
        if not remote and not target.is_loopback:
            do = "add --remote if everybody on that network may read and forge them"
            raise ZerorateError(f"--udp {address} leaves this machine; {do}")
        family = socket.AF_INET6 if target.version == 6 else socket.AF_INET
        self._target = (str(target), number)
        self._socket = socket.socket(family, socket.SOCK_DGRAM)
        self._socket.setblocking(False)

    def put(self, line: bytes) -> None:
        """Send; a datagram that cannot go is lost, as datagrams are."""
        try:
            self._socket.sendto(line, self._target)
        except OSError:
            pass

    def close(self) -> None:
        self._socket.close()


class UnixSocket:
    """A stream socket at path that any number of readers connect to: `nc -U path`."""

    def __init__(self, path: Path) -> None:
        self._path = path
        if path.is_socket():
            path.unlink()  # of a service that was killed
        self._server = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self._server.bind(os.fspath(path))
        self._server.listen()
        self._server.setblocking(False)
        self._readers: dict[socket.socket, bytes] = {}

    def put(self, line: bytes) -> None:
        """Send to every reader; one that has not taken its last line whole misses this one."""
        self._accept()
        for reader, left in list(self._readers.items()):
            try:
                text = left or line
                self._readers[reader] = text[reader.send(text) :]
            except BlockingIOError:
                pass
            except OSError:
                reader.close()
                del self._readers[reader]

    def close(self) -> None:
        """Close everything and take the socket away."""
        for one in (self._server, *self._readers):
            one.close()
        self._path.unlink(missing_ok=True)

    def _accept(self) -> None:
        try:
            while True:
                reader, _ = self._server.accept()
                reader.setblocking(False)
                self._readers[reader] = b""
        except BlockingIOError:
            pass
