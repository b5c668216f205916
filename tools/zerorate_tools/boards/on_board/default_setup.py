from machine import I2C
from zerorate_i2c.mpu6050 import MPU6050

imu = MPU6050(I2C(0, freq=400000))
