"""python -m host_tests.golden: renew what firmware and tools are held to, where that is meant."""

from host_tests.firmware import swung
from host_tests.firmware.trace_on_host import GOLDEN, renew_golden
from host_tests.golden import known

renew_golden()
swung.renew_golden()
known.renew()
print(f"{GOLDEN.name}, {swung.GOLDEN.name} and {known.FILE.name} are renewed: commit them with the")
print("reason why there are other numbers")
