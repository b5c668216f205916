"""python -m host_tests.golden: renew what the firmware is held to, after a change on purpose."""

from host_tests.firmware import swung
from host_tests.firmware.trace_on_host import GOLDEN, renew_golden

renew_golden()
swung.renew_golden()
print(f"{GOLDEN.name} and {swung.GOLDEN.name} are renewed: commit them with the reason why the")
print("firmware gives other numbers")
