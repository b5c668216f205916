"""python -m host_tests.golden: renew what the firmware is held to, after a change on purpose."""

from host_tests.firmware.trace_on_host import GOLDEN, renew_golden

renew_golden()
print(f"{GOLDEN.name} is renewed: commit it with the reason why the firmware gives other numbers")
