# Channels of one slice are taken as slices where there are more of them than a picture shows: tifffile writes any three axes so.
"$PYTHON" - <<'END'
import struct
def write(path, count, description):
    text = description.encode() + b"\0"
    with open(path, "wb") as file:
        file.write(b"II*\0" + struct.pack("<I", 8 + len(text) + len(text) % 2) + text + b"\0" * (len(text) % 2))
        for k in range(count):
            at = file.tell()
            strip = at + 2 + 10 * 12 + 4
            tags = [(256, 4), (257, 4), (258, 8), (259, 1), (262, 1), (270, 8), (273, strip), (277, 1), (278, 4), (279, 16)]
            file.write(struct.pack("<H", len(tags)))
            for tag, value in tags:
                file.write(struct.pack("<HHII", tag, 2 if tag == 270 else 4, len(text) if tag == 270 else 1, value))
            file.write(struct.pack("<I", strip + 16 if k + 1 < count else 0) + bytes([k]) * 16)
for count in 16, 17:
    write(f"{count}.tif", count, f"ImageJ=1.11a\nimages={count}\nchannels={count}\nhyperstack=true\nmode=grayscale\n")
END
about() { halflight info "$@" 2>&1 | grep -E 'warning|dimensions|channels  |range'; }
about 16.tif
about 17.tif
about 17.tif --channel 5
