"""MPU-6050 family over any I2C bus that has readfrom_mem_into and writeto_mem."""
