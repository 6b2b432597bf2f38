"""Reads PNG files of 8 bits a channel, not interlaced, as libpng writes them: more a test of pictures does not need."""
import struct
import zlib

CHANNELS = {0: 1, 2: 3, 6: 4}


def mean_difference(one, other):
    """Of the levels of two files, 0 to 255; infinite if they have not the same size."""
    if one.read_bytes() == other.read_bytes():
        return 0.0
    (size, levels), (other_size, other_levels) = (pixels_of(file.read_bytes()) for file in (one, other))
    if size != other_size:
        return float('inf')
    return sum(abs(a - b) for a, b in zip(levels, other_levels)) / len(levels)


def chunks_of(data):
    """(kind, body) of each chunk of a file's bytes."""
    if data[:8] != b'\x89PNG\r\n\x1a\n':
        raise ValueError('no PNG file')
    at = 8
    while at < len(data):
        length, kind = struct.unpack('>I4s', data[at:at + 8])
        yield kind, data[at + 8:at + 8 + length]
        at += 12 + length


def texts_of(data):
    """What a file says of itself, by keyword: Software, Description."""
    texts = (body.decode('latin-1').split('\0', 1) for kind, body in chunks_of(data) if kind == b'tEXt')
    return dict(texts)


def pixels_of(data):
    """((width, height, channels), levels) of a file's bytes."""
    compressed, header = b'', None
    for kind, body in chunks_of(data):
        if kind == b'IHDR':
            header = struct.unpack('>IIBBBBB', body)
        elif kind == b'IDAT':
            compressed += body
    width, height, depth, colour, _, _, interlaced = header
    if depth != 8 or interlaced or colour not in CHANNELS:
        raise ValueError(f'a PNG file of another kind: {header}')
    step = CHANNELS[colour]
    return (width, height, step), unfiltered(zlib.decompress(compressed), width * step, step)


def unfiltered(raw, row_bytes, step):
    levels, above = bytearray(), bytearray(row_bytes)
    for at in range(0, len(raw), row_bytes + 1):
        kind, row = raw[at], bytearray(raw[at + 1:at + 1 + row_bytes])
        for i in range(row_bytes):
            left, corner = (row[i - step], above[i - step]) if i >= step else (0, 0)
            row[i] = (row[i] + predicted(kind, left, above[i], corner)) & 255
        levels += row
        above = row
    return levels


def predicted(kind, left, up, corner):
    if kind == 4:  # Paeth
        guess = left + up - corner
        return min((abs(guess - left), 0, left), (abs(guess - up), 1, up), (abs(guess - corner), 2, corner))[2]
    return (0, left, up, (left + up) // 2)[kind]
