// An MPU-6050 on rp2040js' I2C: registers, FIFO, data-ready pulses, and its power taken away.

const ADDRESS = 0x68;
const BIT_NS = 2500; // 400 kHz
const SMPLRT_DIV = 0x19, CONFIG = 0x1a, FIFO_EN = 0x23, INT_ENABLE = 0x38, INT_STATUS = 0x3a;
const DATA = 0x3b, USER_CTRL = 0x6a, POWER = 0x6b, COUNT_H = 0x72, COUNT_L = 0x73, FIFO_RW = 0x74;
const WHO_AM_I = 0x75;
const FIFO_BYTES = 1024, PULSE_NS = 50_000, START_NS = 30_000_000;

/** Triangular noise within +-most, the same every run. */
export function makeNoise() {
  let a = 1, b = 2;
  return (most) => {
    a = (a * 75 + 74) % 65537;
    b = (b * 389 + 17) % 65521;
    return (((a - b) >> 1) * most) >> 15;
  };
}

/** A device at rest: words of sample n, its bias in LSB. */
export function resting(bias) {
  const noise = makeNoise();
  return (n) => [
    noise(40), noise(40), 16384 + noise(40), -3000 + noise(10),
    ...bias.map((lsb) => lsb + noise(12)),
  ];
}

export class Chip {
  constructor(clock, i2c, pin, source) {
    Object.assign(this, { clock, pin, source, samples: 0, dead: false, fifo: [] });
    this.next = clock.createAlarm(() => this.sample());
    this.fall = clock.createAlarm(() => pin.setInputValue(false));
    this.data = new Uint8Array(14);
    this.reset();
    this.attach(i2c);
  }

  /** As after its power was away: every register at its default, asleep. */
  reset() {
    this.registers = new Uint8Array(128);
    this.registers[POWER] = 0x40;
    this.registers[WHO_AM_I] = ADDRESS;
    this.fifo.length = 0;
    this.overflow = false;
    this.next.cancel();
    this.pin.setInputValue(false);
  }

  get periodNs() {
    const filter = this.registers[CONFIG] & 7;
    return (filter % 7 ? 1_000_000 : 125_000) * (1 + this.registers[SMPLRT_DIV]);
  }

  sample() {
    this.next.schedule(this.periodNs);
    const r = this.registers;
    this.source(this.samples++).forEach((word, i) => {
      r[DATA + 2 * i] = word >> 8;
      r[DATA + 2 * i + 1] = word;
    });
    if (r[USER_CTRL] & 0x40 && r[FIFO_EN] === 0xf8) {
      this.fifo.push(...r.subarray(DATA, DATA + 14));
      const over = this.fifo.length - FIFO_BYTES;
      if (over > 0) {
        this.fifo.splice(0, over);
        this.overflow = true;
      }
    }
    r[INT_STATUS] |= 1;
    if (r[INT_ENABLE] & 1) {
      this.pin.setInputValue(true);
      this.fall.schedule(PULSE_NS);
    }
  }

  read(at) {
    const r = this.registers;
    if (at === FIFO_RW) return this.fifo.shift() ?? 0xff;
    if (at === COUNT_H) return this.fifo.length >> 8;
    if (at === COUNT_L) return this.fifo.length & 255;
    if (at >= DATA && at < DATA + 14) return this.data[at - DATA];
    if (at !== INT_STATUS) return r[at];
    const status = r[at] | (this.overflow ? 0x10 : 0);
    r[at] = 0;
    this.overflow = false;
    return status;
  }

  write(at, value) {
    const r = this.registers;
    if (at === POWER && value & 0x80) return this.reset();
    if (at === USER_CTRL && value & 4) this.fifo.length = 0;
    const wakes = at === POWER && r[POWER] & 0x40 && !(value & 0x40);
    r[at] = at === USER_CTRL ? value & 0xf0 : value;
    if (wakes) this.next.schedule(START_NS + this.periodNs);
    else if (at === POWER && value & 0x40) this.next.cancel();
  }

  attach(i2c) {
    let at = 0, isPointer = true;
    const after = (bits, done) => this.clock.createAlarm(done).schedule(bits * BIT_NS);
    const step = () => {
      if (at !== FIFO_RW) at = (at + 1) & 127;
    };
    i2c.onStart = () => after(1, () => i2c.completeStart());
    i2c.onConnect = (address, mode) =>
      after(9, () => {
        isPointer = mode === 0;
        // what a burst reads is of one sample
        if (!isPointer) this.data.set(this.registers.subarray(DATA, DATA + 14));
        i2c.completeConnect(address === ADDRESS && !this.dead);
      });
    i2c.onWriteByte = (value) =>
      after(9, () => {
        if (isPointer) at = value & 127;
        else {
          this.write(at, value);
          step();
        }
        isPointer = false;
        i2c.completeWrite(true);
      });
    i2c.onReadByte = () =>
      after(9, () => {
        const value = this.read(at);
        step();
        i2c.completeRead(value);
      });
    i2c.onStop = () => after(1, () => i2c.completeStop());
  }
}
