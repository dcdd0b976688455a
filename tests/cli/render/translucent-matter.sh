# A casting of one metal is seen through with --look translucent: a pore in its middle changes the picture. By default it is a wall.
"$PYTHON" - <<'END'
import random
chance, n = random.Random(4), 40
for name, radius in ("whole", 0), ("porous", 5):
    with open(f"{name}_{n}x{n}x{n}_uint8.raw", "wb") as file:
        for z in range(n):
            for y in range(n):
                for x in range(n):
                    inside = max(0, min(1, min(min(p - 4.5, 34.5 - p) for p in (x, y, z)) + 0.5))
                    pore = max(0, min(1, radius + 0.5 - ((x - 19.5)**2 + (y - 19.5)**2 + (z - 19.5)**2)**0.5)) if radius else 0
                    file.write(bytes([round(20 + 180 * inside * (1 - pore) + chance.uniform(-6, 6))]))
END
for name in whole porous; do
  halflight render ${name}_40x40x40_uint8.raw --look translucent --view front --size 64x64 --quiet -o $name.npy
  halflight render ${name}_40x40x40_uint8.raw --view front --size 64x64 --quiet -o $name-surface.npy
done
"$PYTHON" - <<'END'
import struct
def pixels(name):
    data = open(name, "rb").read()[-64 * 64 * 16:]
    return lambda x, y: struct.unpack_from("<4f", data, 16 * (64 * y + x))
whole, porous = pixels("whole.npy"), pixels("porous.npy")
hidden = [pixels(f"{name}-surface.npy") for name in ("whole", "porous")]
print("the matter lets light through:", 0.2 < whole(32, 32)[3] < 0.8)
print("the pore is seen:", sum(abs(a - b) for a, b in zip(whole(32, 32), porous(32, 32))) > 0.03)
print("a surface is a wall:", all(p(32, 32)[3] > 0.99 for p in hidden))
END
