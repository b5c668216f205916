// As much of Arduino as the exported sketch uses: time that each look moves on, an MPU-6050 on Wire.
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

static uint32_t now_us;
static inline uint32_t micros() { return now_us += 200; }
static inline uint32_t millis() { return now_us / 1000; }
static inline void delay(uint32_t ms) { now_us += 1000 * ms; }

struct {
    void begin(int) {}
    void print(const char *text) { printf("%s", text); }
    void print(float value, int digits) { printf("%.*f", digits, (double)value); }
    void println(const char *text) { printf("%s\n", text); }
} Serial;

struct {
    int at;
    void begin() {}
    void setClock(long) {}
    void beginTransmission(uint8_t) {}
    void write(uint8_t) {}
    int endTransmission(bool = true) { return 0; }
    int requestFrom(uint8_t, uint8_t count) {
        at = 0;
        return count;
    }
    int read() {
        static const int means[7] = {0, 0, 16384, -3000, 300, -200, 262};
        static int word;
        if (at % 2 == 0) word = means[at / 2] + rand() % 13 - 6;
        return at++ % 2 == 0 ? word >> 8 & 0xff : word & 0xff;
    }
} Wire;

void setup();
void loop();

int main() {
    setup();
    while (now_us < 61000000) loop();
}
