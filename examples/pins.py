from zerorate_i2c.board import setup

imu = setup(scl=22, sda=21)
