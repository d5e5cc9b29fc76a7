# Pictures in memory and their PNG form, by the standard library alone: the small pictures of tools/gallery.
# SPDX-License-Identifier: MIT
"""PNG of 8 bits a channel, without interlacing: what `sightline cull --report` writes."""
import struct
import zlib

SIGNATURE = b"\x89PNG\r\n\x1a\n"
CHANNELS = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}  # by the colour type of the header
MOST_PIXELS = 1 << 26


class PngError(ValueError):
    """What is wrong with a file, in one line."""


class Picture:
    """Pixels row by row, the top row first: `rows[y]` holds width times `channels` bytes, 3 (RGB) or 4 (with alpha)."""

    def __init__(self, width, height, channels, rows):
        self.width, self.height, self.channels, self.rows = width, height, channels, rows

    def __eq__(self, other):
        return (self.width, self.height, self.channels) == (other.width, other.height, other.channels) and all(
            bytes(a) == bytes(b) for a, b in zip(self.rows, other.rows))

    def pixel(self, x, y):
        return tuple(self.rows[y][x * self.channels:(x + 1) * self.channels])


def chunks(data):
    """(type, body) of every chunk up to IEND; each checked against its sum."""
    if data[:8] != SIGNATURE:
        raise PngError("not a PNG file")
    at = 8
    while at + 12 <= len(data):
        (size,), kind = struct.unpack_from(">I", data, at), data[at + 4:at + 8]
        body = data[at + 8:at + 8 + size]
        if at + 12 + size > len(data):
            break
        if struct.unpack_from(">I", data, at + 8 + size)[0] != zlib.crc32(kind + body):
            raise PngError(f"the sum of chunk {kind.decode('latin-1')} is wrong")
        yield kind, body
        if kind == b"IEND":
            return
        at += 12 + size
    raise PngError("the file ends early")


def unfiltered(raw, width, height, channels):
    """The rows of pixels from what deflate held: each row behind the number of its filter."""
    stride = width * channels
    if len(raw) != height * (stride + 1):
        raise PngError("it holds another number of pixels than its header says")
    above, rows = bytes(stride), []
    for y in range(height):
        start = y * (stride + 1)
        kind, row = raw[start], bytearray(raw[start + 1:start + 1 + stride])
        if kind == 1:
            for i in range(channels, stride):
                row[i] = row[i] + row[i - channels] & 255
        elif kind == 2:
            row = bytearray([a + b & 255 for a, b in zip(row, above)])
        elif kind == 3:
            for i in range(stride):
                left = row[i - channels] if i >= channels else 0
                row[i] = row[i] + (left + above[i] >> 1) & 255
        elif kind == 4:
            undo_paeth(row, above, channels)
        elif kind != 0:
            raise PngError(f"row {y} has filter {kind}, which is none")
        rows.append(row)
        above = row
    return rows


def undo_paeth(row, above, channels):
    for i in range(min(channels, len(row))):
        row[i] = row[i] + above[i] & 255
    for i in range(channels, len(row)):
        a, b, c = row[i - channels], above[i], above[i - channels]
        to_a, to_b, to_c = abs(b - c), abs(a - c), abs(a + b - c - c)
        row[i] = row[i] + (a if to_a <= to_b and to_a <= to_c else b if to_b <= to_c else c) & 255


def widened(rows, kind, palette, alphas):
    """Rows of RGB or RGBA from rows of the header's colour type; and how many channels they have."""
    if kind in (2, 6):
        return rows, CHANNELS[kind]
    if kind == 3:
        if len(palette) % 3 or not palette:
            raise PngError("its palette is broken")
        count = len(palette) // 3
        alphas = alphas + b"\xff" * (count - len(alphas))
        clear = any(a != 255 for a in alphas)
        table = [palette[3 * i:3 * i + 3] + (alphas[i:i + 1] if clear else b"") for i in range(count)]
        if any(max(row) >= count for row in rows):
            raise PngError("a pixel lies beyond the palette")
        return [bytearray(b"".join([table[v] for v in row])) for row in rows], 4 if clear else 3
    if kind == 0:
        return [bytearray(b"".join([bytes((v, v, v)) for v in row])) for row in rows], 3
    pairs = [zip(row[::2], row[1::2]) for row in rows]
    return [bytearray(b"".join([bytes((v, v, v, a)) for v, a in pair])) for pair in pairs], 4


def decode(data):
    """The Picture that a PNG file's bytes hold. Throws PngError."""
    header, palette, alphas, packed = None, b"", b"", []
    for kind, body in chunks(data):
        if kind == b"IHDR" and len(body) == 13:
            header = struct.unpack(">IIBBBBB", body)
        elif kind == b"PLTE":
            palette = body
        elif kind == b"tRNS":
            alphas = body
        elif kind == b"IDAT":
            packed.append(body)
    if header is None:
        raise PngError("it has no header")
    width, height, depth, kind, _, _, interlaced = header
    if depth != 8 or kind not in CHANNELS or interlaced:
        raise PngError("only 8 bits a channel without interlacing are read")
    if not 0 < width * height <= MOST_PIXELS:
        raise PngError("it has no pixels, or too many")
    size = height * (width * CHANNELS[kind] + 1)
    try:
        raw = zlib.decompressobj().decompress(b"".join(packed), size + 1)
    except zlib.error as error:
        raise PngError(f"its pixels cannot be unpacked: {error}") from error
    rows, channels = widened(unfiltered(raw, width, height, CHANNELS[kind]), kind, palette, alphas)
    return Picture(width, height, channels, rows)


def over(top, bottom):
    """`top`, which has alpha or not, laid over `bottom` of the same size: RGB."""
    if (top.width, top.height) != (bottom.width, bottom.height):
        raise ValueError("pictures of two sizes cannot be laid over one another")
    if top.channels == 3:
        return top
    rows = []
    for upper, lower in zip(top.rows, bottom.rows):
        row = bytearray(lower)
        for x, alpha in enumerate(upper[3::4]):
            if alpha:
                for c in range(3):
                    row[3 * x + c] = (upper[4 * x + c] * alpha + row[3 * x + c] * (255 - alpha) + 127) // 255
        rows.append(row)
    return Picture(top.width, top.height, 3, rows)


def plain(width, height, colour):
    return Picture(width, height, 3, [bytearray(bytes(colour) * width) for _ in range(height)])


def shares(source, target):
    """For each of `target` places the (index, part) of the `source` places under it; parts of a place sum to 1."""
    out, scale = [], source / target
    for place in range(target):
        begin, end, parts = place * scale, (place + 1) * scale, []
        index = int(begin)
        while index < source and index < end - 1e-9:
            parts.append((index, (min(end, index + 1) - max(begin, index)) / scale))
            index += 1
        out.append(parts)
    return out


def downscaled(picture, width):
    """An RGB picture of that width in the same proportions, each pixel the mean of what it covers; never larger."""
    if picture.channels != 3:
        raise ValueError("lay it over something first")
    if width >= picture.width:
        return picture
    height = max(1, round(picture.height * width / picture.width))
    across, rows = shares(picture.width, width), []
    for parts in shares(picture.height, height):
        sums = [0.0] * (3 * picture.width)
        for index, part in parts:
            sums = [s + part * v for s, v in zip(sums, picture.rows[index])]
        row = bytearray(3 * width)
        for c in range(3):
            line = sums[c::3]
            row[c::3] = bytes([int(sum([line[i] * part for i, part in cover]) + 0.5) for cover in across])
        rows.append(row)
    return Picture(width, height, 3, rows)


def filtered(row, above, step):
    """The row behind its filter: the one of the five, but for the mean, whose bytes lie nearest to zero."""
    left, corner = bytes(step) + row[:-step], bytes(step) + above[:-step]
    tries = [(0, row), (1, bytes([v - a & 255 for v, a in zip(row, left)])),
             (2, bytes([v - b & 255 for v, b in zip(row, above)]))]
    paeth = bytearray(len(row))
    for i, (v, a, b, c) in enumerate(zip(row, left, above, corner)):
        to_a, to_b, to_c = abs(b - c), abs(a - c), abs(a + b - c - c)
        paeth[i] = v - (a if to_a <= to_b and to_a <= to_c else b if to_b <= to_c else c) & 255
    tries.append((4, bytes(paeth)))
    kind, best = min(tries, key=lambda entry: sum([v if v < 128 else 256 - v for v in entry[1]]))
    return bytes([kind]) + best


def chunk(kind, body):
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))


def encode(picture):
    """The bytes of a PNG file: by a palette where an RGB picture has at most 256 colours."""
    channels = picture.channels
    palette = None
    if channels == 3:
        colours = set()
        for row in picture.rows:
            colours.update(zip(row[::3], row[1::3], row[2::3]))
            if len(colours) > 256:
                break
        if len(colours) <= 256:
            palette = sorted(colours)
    if palette:
        place = {colour: i for i, colour in enumerate(palette)}
        lines = [b"\0" + bytes([place[c] for c in zip(row[::3], row[1::3], row[2::3])]) for row in picture.rows]
        kind = 3
    else:
        kind, lines, above = {3: 2, 4: 6}[channels], [], bytes(picture.width * channels)
        for row in picture.rows:
            lines.append(filtered(bytes(row), above, channels))
            above = bytes(row)
    out = SIGNATURE + chunk(b"IHDR", struct.pack(">IIBBBBB", picture.width, picture.height, 8, kind, 0, 0, 0))
    if palette:
        out += chunk(b"PLTE", b"".join(bytes(c) for c in palette))
    return out + chunk(b"IDAT", zlib.compress(b"".join(lines), 9)) + chunk(b"IEND", b"")
