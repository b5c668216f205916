"""Small files in foreign formats, written byte by byte from the formats' own descriptions."""

import struct

import numpy as np


def ulog(path, topics):
    """A PX4 ULog (PX4 user guide, ULog file format): {topic: {field: (type, values)}}."""
    types = {"uint64_t": "<u8", "float": "<f4", "float[3]": "<f4"}
    out = [b"ULog\x01\x12\x35\x01" + struct.pack("<Q", 0)]

    def message(kind, body):
        out.append(struct.pack("<HB", len(body), ord(kind)) + body)

    message("B", bytes(40))
    for name, fields in topics.items():
        listed = "".join(f"{kind} {field};" for field, (kind, _) in fields.items())
        message("F", f"{name}:{listed}".encode())
    for number, name in enumerate(topics):
        message("A", struct.pack("<BH", 0, number) + name.encode())
    for number, fields in enumerate(topics.values()):
        columns = [np.asarray(values).astype(types[kind]) for kind, values in fields.values()]
        for row in zip(*columns):
            message("D", struct.pack("<H", number) + b"".join(cell.tobytes() for cell in row))
    path.write_bytes(b"".join(out))


def dataflash(path, rows):
    """An ArduPilot DataFlash log: FMT messages, then IMU rows (TimeUS, I, gyro, accel, T)."""
    head = b"\xa3\x95"

    def described(kind, length, name, letters, labels):
        return head + struct.pack(
            "<BBB4s16s64s", 128, kind, length, name.encode(), letters.encode(), labels.encode()
        )

    out = [described(128, 89, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns")]
    labels = "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,T"
    body = "<QB7f"
    out.append(described(131, 3 + struct.calcsize(body), "IMU", "QBfffffff", labels))
    out += [head + b"\x83" + struct.pack(body, *row) for row in rows]
    path.write_bytes(b"".join(out))


def vectornav_line(rates, accel=(0.0, 0.0, -9.8), temp=26.8):
    """One $VNIMU line with its checksum."""
    mag = "-00.2382,+00.7281,+00.2867"
    acc = ",".join(f"{v:+07.3f}" for v in accel)
    gyro = ",".join(f"{v:+010.6f}" for v in rates)
    text = f"VNIMU,{mag},{acc},{gyro},{temp:+05.1f},+096.559"
    checksum = 0
    for byte in text.encode():
        checksum ^= byte
    return f"${text}*{checksum:02X}"
