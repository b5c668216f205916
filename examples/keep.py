"""Four wires: what is learned is kept in a file that survives a power cut."""

import gc
from array import array

gc.threshold(1024)  # a small heap stays in one piece while what follows is loaded

# each is made before the next is loaded: what only its making needs is gone by then
from zerorate_i2c.board import setup

imu = setup(scl=5, sda=4)
print("found:", imu.part)
del setup  # its heap, too
from zerorate import Corrector, Sensor

learner = Corrector(Sensor(*imu.scales))
from zerorate.checked import CheckedCorrector

corrector = CheckedCorrector(learner)
from zerorate.storage.learned_store import LearnedStore
from zerorate.storage.places import FileStorage
from zerorate.storage.save_schedule import SaveSchedule
from zerorate_i2c.fifo import EMPTY, Fifo

store = LearnedStore(FileStorage("learned.bin"), imu.binding, learner)
print(store.in_words(store.load()))
corrector.keep()  # what was read is right
schedule = SaveSchedule(store, 3, tolerance=round(imu.gyro_lsb_per_dps / 10), corrector=learner)
sample = array("i", [0] * 7)
bias_lsb = array("i", [0] * 3)
fifo = Fifo(imu)
while True:
    try:
        status = fifo.read(sample)
    except OSError as error:  # the bus has failed for good: forget what came since the last check
        print("bus:", error)
        corrector.take_back()
        imu.clock.sleep_ms(1000)
        continue
    if status == EMPTY:
        imu.clock.sleep_ms(10)
        continue
    if corrector.update(sample, fifo.dt_us, status):
        pass  # sample[4], sample[5] and sample[6] are the rates without their bias: use them here
    if learner.learned:  # and not of this rest alone
        for axis in range(3):
            bias_lsb[axis] = round(learner.bias_lsb(axis))
    saves = schedule.saves
    if schedule.offer(learner.state, bias_lsb, int(fifo.frames / imu.odr_hz)):
        print("kept")
    elif schedule.saves > saves:
        print("learned.bin: cannot be written; is there room?")
