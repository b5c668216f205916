// An MPU-6050 on Wire: once a second the yaw in degrees, with zerorate and without.
#include <Wire.h>
#include <zerorate.h>

static const uint8_t CHIP = 0x68;
static zerorate_t bias;
static float with_deg, without_deg;
static uint32_t last_us, printed_ms;

static void set(uint8_t reg, uint8_t value) {
    Wire.beginTransmission(CHIP);
    Wire.write(reg);
    Wire.write(value);
    Wire.endTransmission();
}

static bool fetch(int32_t sample[7]) {
    Wire.beginTransmission(CHIP);
    Wire.write((uint8_t)0x3b);
    if (Wire.endTransmission(false) != 0) return false;
    if (Wire.requestFrom(CHIP, (uint8_t)14) != 14) return false;
    for (int i = 0; i < 7; i++) {
        uint8_t high = (uint8_t)Wire.read();
        sample[i] = (int16_t)(high << 8 | (uint8_t)Wire.read());
    }
    return true;
}

void setup() {
    Serial.begin(115200);
    Wire.begin();
    Wire.setClock(400000);
    set(0x6b, 0x01);                                  // awake, on the gyroscope's clock
    set(0x1a, 0x03);                                  // a filter of 42 Hz
    set(0x19, (uint8_t)(1000.0f / ZERORATE_ODR_HZ - 0.5f));
    zerorate_begin(&bias);
    last_us = micros();
}

void loop() {
    uint32_t now_us = micros();
    int32_t sample[7];
    if (now_us - last_us < (uint32_t)(1e6f / ZERORATE_ODR_HZ)) return;
    int32_t dt_us = (int32_t)(now_us - last_us);
    last_us = now_us;
    if (!fetch(sample)) {
        Serial.println("no answer at 0x68: are SDA, SCL and 3V3 wired?");
        delay(1000);
        return;
    }
    float lsb_to_deg = (float)dt_us * 1e-6f / ZERORATE_GYRO_LSB_PER_DPS;
    without_deg += (float)sample[6] * lsb_to_deg;
    zerorate_update(&bias, sample, dt_us);
    with_deg += (float)sample[6] * lsb_to_deg;
    if (millis() - printed_ms < 1000) return;
    printed_ms = millis();
    Serial.print("yaw without ");
    Serial.print(without_deg, 2);
    Serial.print("  with ");
    Serial.print(with_deg, 2);
    Serial.println(zerorate_learned(&bias) ? " deg" : " deg (lie still: nothing is learned yet)");
}
