"""The newest line of the service as metrics of Prometheus, asked for over HTTP."""

import json
from collections.abc import Iterator
from typing import Any

from ..errors import MissingLibrary, ZerorateError
from .publish import address_of

#: Entry of a line -> (metric, what it is).
_VECTORS = {
    "rate_dps": ("zerorate_rate_dps", "Rate without bias."),
    "bias_dps": ("zerorate_bias_dps", "Bias that is subtracted."),
    "accel_g": ("zerorate_acceleration_g", "Specific force."),
}
_TEMPERATURE = ("zerorate_temperature_degc", "Temperature of the chip.")


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
            do = "name another port"
            raise ZerorateError(f"--metrics {address}: {error.strerror or error}; {do}") from error

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
