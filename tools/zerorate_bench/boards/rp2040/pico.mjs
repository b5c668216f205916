// node pico.mjs OPTIONS(JSON): an RP2040 with MicroPython and an MPU-6050 on I2C0, INT on GPIO 6.
// Its USB serial port is standard input and output; a descriptor takes commands, a line of JSON
// each, and answers each with a line. Idle time is skipped: a day at rest takes no longer than what
// the processor does in it.
//
// options: rp2040js, bootrom: modules; firmware: image; bias: LSB of the chip's gyroscope; control:
// the number of that descriptor.
//
// A window to the host at 0x40070000: +0 cycles; +4 marks, 1 then 0, between which cycles are
// counted; +8 a length; +12 an address to which so many bytes of the host's deck are put; +16 one
// from which so many are taken to its pile.

import fs from 'node:fs';
import net from 'node:net';

import { Chip, resting } from './chip.mjs';

const options = JSON.parse(process.argv[2]);
const { RP2040, USBCDC, BasePeripheral } = await import(options.rp2040js);
const { bootromB1 } = await import(options.bootrom);

console.info = console.warn = console.log = () => {}; // standard output is the serial port

const CYCLE_NS = 8; // 125 MHz
const ROM_END = 0x4000, FLASH = 0x10000000, WINDOW = 0x40070;
const ERASE_NS = 45e6, PROGRAM_NS = 0.4e6; // of 4096 bytes, of 256
const SLICE_MS = 20, NO_ALARM = 8; // steps without one: it waits for the host

const flash = new Uint8Array(16 << 20).fill(0xff); // outlives a power cut
flash.set(fs.readFileSync(options.firmware));
const counts = { erases: 0, programs: 0, boots: 0, cuts: 0 };
let cutAfter = -1; // flash operations that still end before the power goes
let deck = Buffer.alloc(0), pile = [];
let input = [];
let pico;

class Window extends BasePeripheral {
  constructor(mcu) {
    super(mcu, 'WINDOW');
    this.length = this.started = 0;
    this.spans = [];
  }
  readUint32() {
    return this.rp2040.core.cycles % 0x40000000;
  }
  writeUint32(offset, value) {
    const { core, sram } = this.rp2040;
    const at = value & 0xffffff; // of RAM, which begins at 0x20000000
    if (offset === 4 && value) this.started = core.cycles;
    else if (offset === 4) this.spans.push(core.cycles - this.started);
    else if (offset === 8) this.length = value;
    else if (offset === 12) {
      sram.set(deck.subarray(0, this.length), at);
      deck = deck.subarray(this.length);
    } else if (offset === 16) pile.push(Buffer.from(sram.slice(at, at + this.length)));
  }
}

class Pico {
  constructor() {
    counts.boots++;
    const mcu = (this.mcu = new RP2040());
    const silent = () => {};
    mcu.logger = { debug: silent, info: silent, warn: silent, error: silent };
    mcu.loadBootrom(bootromB1);
    mcu.flash.set(flash);
    this.off = false;
    this.busyCycles = 0;
    this.window = mcu.peripherals[WINDOW] = new Window(mcu);
    mcu.peripherals[0x40058].onWatchdogTrigger = () => (this.off = true);
    this.rom = this.flashRoutines();
    this.serial();
    this.chip = new Chip(mcu.clock, mcu.i2c[0], mcu.gpio[6], resting(options.bias));
    mcu.gpio[4].setInputValue(true);
    mcu.gpio[5].setInputValue(true);
    mcu.core.PC = FLASH;
  }

  serial() {
    const { mcu } = this;
    const usb = new USBCDC(mcu.usbCtrl);
    let room = 0;
    this.deliver = () => {
      if (!room || !input.length) return;
      const bytes = input.splice(0, room);
      room = 0;
      mcu.usbCtrl.endpointReadDone(usb.outEndpoint, Uint8Array.from(bytes));
    };
    mcu.usbCtrl.onEndpointRead = (endpoint, size) => {
      if (endpoint !== usb.outEndpoint) return;
      room = size;
      this.deliver();
    };
    usb.onSerialData = (bytes) => process.stdout.write(Buffer.from(bytes));
  }

  // The boot ROM's own routines would program a flash chip that is not there.
  flashRoutines() {
    const { core, clock } = this.mcu;
    const rom = this.mcu.bootrom.buffer, table = new DataView(rom);
    const routines = new Map(), actions = new Map();
    for (let at = table.getUint16(0x14, true); table.getUint16(at, true); at += 4) {
      const code = String.fromCharCode(table.getUint8(at), table.getUint8(at + 1));
      routines.set(code, table.getUint16(at + 2, true) & ~1);
    }
    const on = (code, act) =>
      actions.set(routines.get(code), () => {
        act(...core.registers);
        core.PC = core.LR & ~1;
      });
    for (const code of ['IF', 'EX', 'FC', 'CX']) on(code, () => {});
    const write = (at, bytes, ns) => {
      const isCut = cutAfter >= 0 && cutAfter-- === 0;
      const done = isCut ? bytes.subarray(0, bytes.length >> 1) : bytes;
      flash.set(done, at);
      this.mcu.flash.set(done, at);
      if (isCut) {
        counts.cuts++;
        this.off = true;
        return;
      }
      clock.tick(ns);
      core.cycles += ns / CYCLE_NS;
    };
    on('RE', (at, length) => {
      counts.erases++;
      write(at, new Uint8Array(length).fill(0xff), (ERASE_NS * length) / 4096);
    });
    on('RP', (at, from, length) => {
      counts.programs++;
      const byte = (_, i) => flash[at + i] & this.mcu.readUint8(from + i);
      write(at, Uint8Array.from({ length }, byte), (PROGRAM_NS * length) / 256);
    });
    return actions;
  }

  /** Go on for a slice of the host's time, or until nothing is to do: true where it waits for input. */
  run() {
    const { core, clock } = this.mcu;
    const until = Date.now() + SLICE_MS;
    let silent = 0;
    this.deliver();
    while (!this.off && Date.now() < until) {
      for (let i = 0; i < 20000 && !this.off; i++) {
        if (core.waiting) {
          const next = clock.nanosToNextAlarm, ns = Math.max(next, 1000);
          silent = next ? 0 : silent + 1;
          clock.tick(ns);
          core.cycles += ns / CYCLE_NS;
          if (silent > NO_ALARM) return true;
          if (ns > 1e6 || clock.nanosToNextAlarm > 1e6) return false;
          continue;
        }
        const act = core.PC < ROM_END && this.rom.get(core.PC & ~1);
        if (act) {
          act();
          continue;
        }
        const cycles = core.executeInstruction();
        this.busyCycles += cycles;
        clock.tick(cycles * CYCLE_NS);
      }
    }
    return false;
  }
}

const commands = {
  stat: () => ({
    ms: pico.mcu.clock.nanos / 1e6,
    busy_ms: (pico.busyCycles * CYCLE_NS) / 1e6,
    samples: pico.chip.samples,
    ...counts,
  }),
  spans: () => pico.window.spans.splice(0),
  cut: ({ after }) => (cutAfter = after),
  power: () => (pico.off = true),
  brownout: () => pico.chip.reset(),
  dead: ({ dead }) => (pico.chip.dead = dead),
  deck: ({ bytes }) => (deck = Buffer.from(bytes, 'base64')).length,
  pile: () => Buffer.concat(pile.splice(0)).toString('base64'),
};

function turn() {
  if (pico.off) {
    input = [];
    pico = new Pico();
  }
  // at the prompt it waits for the host, whose time is not skipped
  if (pico.run() && !input.length) setTimeout(turn, 1);
  else setImmediate(turn);
}

process.stdin.on('data', (bytes) => input.push(...bytes));
process.stdin.on('end', () => process.exit(0));
let said = '';
const control = new net.Socket({ fd: options.control });
control.on('data', (bytes) => {
  const lines = (said + bytes).split('\n');
  said = lines.pop();
  for (const line of lines) {
    const command = JSON.parse(line);
    control.write(JSON.stringify(commands[command.do](command) ?? null) + '\n');
  }
});
pico = new Pico();
turn();
