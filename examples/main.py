from array import array

from machine import I2C, Pin
from zerorate import Corrector, Sensor
from zerorate.checked import CheckedCorrector
from zerorate_i2c.data_ready import DataReady
from zerorate_i2c.mpu6050 import MPU6050

imu = MPU6050(I2C(0, scl=Pin(5), sda=Pin(4), freq=400_000))
ready = DataReady(imu, Pin(6, Pin.IN))
corrector = CheckedCorrector(Corrector(Sensor(*imu.scales)))
sample = array("i", [0] * 7)
while ready.wait(1000):
    if corrector.update(sample, ready.dt_us, imu.read(sample)):
        print(sample[4], sample[5], sample[6])  # rates in LSB, their bias taken off
