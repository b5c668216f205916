"""Where corrected samples go: lines of JSON to a stream, a Unix socket, or datagrams.

No reader can hold the service up or end it: what one does not take in time is dropped for it, a
whole line, and counted in `lost`.
"""

import json
import os
import select
import socket
from collections.abc import Iterator
from ipaddress import IPv4Address, IPv6Address, ip_address
from pathlib import Path
from typing import Any, Protocol, TextIO

from ..errors import InFile, MissingLibrary, ZerorateError, os_error_in_words

#: Readers of a socket at once: the service keeps descriptors for its bus and its file.
MOST_READERS = 100
_HIGHEST_PORT = 65535
#: Entry of a line -> (metric, what it is).
_VECTORS = {
    "rate_dps": ("zerorate_rate_dps", "Rate without bias."),
    "bias_dps": ("zerorate_bias_dps", "Bias that is subtracted."),
    "accel_g": ("zerorate_acceleration_g", "Specific force."),
}
_TEMPERATURE = ("zerorate_temperature_degc", "Temperature of the chip.")


class Sink(Protocol):
    """Takes lines. lost: how many of them did not go, for one reader or another."""

    lost: int

    def put(self, line: bytes) -> None:
        """One line of JSON, ended."""

    def close(self) -> None:
        """No more come."""


class Lines:
    """Lines on a stream with a descriptor, standard output as a rule.

    A pipe that nobody reads any more raises BrokenPipeError: the service was for that reader.
    """

    def __init__(self, stream: TextIO) -> None:
        stream.flush()
        self._descriptor = stream.fileno()
        self._left = b""
        self.lost = 0

    def put(self, line: bytes) -> None:
        """Write; where there is no room a line is lost whole, and one that was begun is ended."""
        self._left = self._left[self._sent(self._left) :]
        sent = 0 if self._left else self._sent(line)
        if sent:
            self._left = line[sent:]
        else:
            self.lost += 1

    def _sent(self, text: bytes) -> int:
        """How many bytes went, without waiting for a reader of a pipe."""
        try:
            # a pipe that is writable takes a page, and a line is less than that
            if select.select([], [self._descriptor], [], 0)[1]:
                return os.write(self._descriptor, text)
        except BrokenPipeError:
            raise
        except OSError:
            pass
        return 0

    def close(self) -> None:
        """The stream is its owner's."""


def address_of(flag: str, text: str, remote: bool) -> tuple[IPv4Address | IPv6Address, int]:
    """Address and port of ADDRESS:PORT. Raises ZerorateError; for another machine's, but remote."""
    host, _, port = text.rpartition(":")
    try:
        address, number = ip_address(host.strip("[]")), int(port)
        if not 0 < number <= _HIGHEST_PORT:
            raise ValueError(port)
    except ValueError:
        do = f"write ADDRESS:PORT, as 127.0.0.1:9750, the port 1..{_HIGHEST_PORT}"
        raise ZerorateError(f"{flag} {text}: {do}") from None
    if not remote and not address.is_loopback:
        do = "add --remote if everybody on that network may read and forge them"
        raise ZerorateError(f"{flag} {text} leaves this machine; {do}")
    return address, number


class Datagrams:
    """A line a datagram to HOST:PORT, loopback unless remote. Raises ZerorateError."""

    def __init__(self, address: str, remote: bool = False) -> None:
        target, number = address_of("--udp", address, remote)
        family = socket.AF_INET6 if isinstance(target, IPv6Address) else socket.AF_INET
        self._target = (str(target), number)
        self._socket = socket.socket(family, socket.SOCK_DGRAM)
        self._socket.setblocking(False)
        self.lost = 0

    def put(self, line: bytes) -> None:
        """Send; a datagram that cannot go is lost, as datagrams are."""
        try:
            self._socket.sendto(line, self._target)
        except OSError:
            self.lost += 1

    def close(self) -> None:
        self._socket.close()


class UnixSocket:
    """A stream socket at path that up to MOST_READERS connect to: `nc -U path`.

    refused: how many came beyond that. Raises InFile where the path cannot be had.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self.lost = self.refused = 0
        self._readers: dict[socket.socket, bytes] = {}
        if not path.parent.is_dir():
            raise InFile(path.parent, "no such folder", do="make it, or name another socket")
        if path.is_socket():
            if _answers(path):
                raise InFile(path, "a service answers there", do="end it, or name another socket")
            path.unlink(missing_ok=True)  # of a service that was killed
        elif path.exists():
            raise InFile(path, "is no socket", do="name another")
        self._server = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        try:
            self._server.bind(os.fspath(path))
        except OSError as error:
            self._server.close()
            raise InFile(path, os_error_in_words(error), do="name another socket") from error
        self._server.listen()
        self._server.setblocking(False)

    def put(self, line: bytes) -> None:
        """Send to every reader; one that has not taken its last line whole misses this one."""
        self._accept()
        for reader, left in list(self._readers.items()):
            try:
                text = left or line
                self.lost += bool(left)
                self._readers[reader] = text[reader.send(text) :]
            except BlockingIOError:
                self.lost += not left
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
                if len(self._readers) >= MOST_READERS:
                    self.refused += 1
                    reader.close()
                    continue
                reader.setblocking(False)
                self._readers[reader] = b""
        except BlockingIOError:
            pass
        except OSError:  # no descriptor is left: who waits is asked in when there is one
            self.refused += 1


def _answers(path: Path) -> bool:
    """Whether a service listens on the socket, be it too busy to take one more."""
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as caller:
        caller.setblocking(False)
        try:
            caller.connect(os.fspath(path))
        except (ConnectionRefusedError, FileNotFoundError):  # it may end just now
            return False
        except BlockingIOError:
            pass
    return True


class Metrics:
    """http://HOST:PORT/metrics, loopback unless remote. A line is read when somebody asks.

    Raises ZerorateError for an address that cannot be had, and MissingLibrary.
    """

    lost = 0

    def __init__(self, address: str, remote: bool = False) -> None:
        try:
            from prometheus_client import CollectorRegistry, start_http_server
        except ModuleNotFoundError as error:
            raise MissingLibrary("prometheus_client") from error
        host, port = address_of("--metrics", address, remote)
        registry = CollectorRegistry()
        registry.register(self)
        self._line = b""
        self._lines = 0
        try:
            self._server, self._thread = start_http_server(port, str(host), registry)
        except OSError as error:
            why = f"{os_error_in_words(error)}; name another port"
            raise ZerorateError(f"--metrics {address}: {why}") from error

    def put(self, line: bytes) -> None:
        """Keep it until the next one."""
        self._line = line
        self._lines += 1

    def collect(self) -> Iterator[Any]:
        """The metrics of the newest line; samples alone before the first."""
        from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily

        line = json.loads(self._line or b"{}")
        yield CounterMetricFamily("zerorate_samples", "Samples published.", self._lines)
        for entry, (name, what) in _VECTORS.items():
            metric = GaugeMetricFamily(name, what, labels=["axis"])
            for axis, value in zip("xyz", line.get(entry, ())):
                metric.add_metric([axis], value)
            yield metric
        if "temp_degc" in line:
            yield GaugeMetricFamily(*_TEMPERATURE, value=line["temp_degc"])

    def close(self) -> None:
        """Answer nobody any more."""
        self._server.shutdown()
        self._server.server_close()
        self._thread.join()
