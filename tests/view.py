"""What `lacquer view` wrote, read back: pixels of a PNG, the numbers of a page. For tests/test_view_slow.sh."""
import base64
import html.parser
import json
import re
import struct
import sys
import zlib


def png(path):
    """Width, height and rows of (r, g, b) of an 8-bit RGB or RGBA PNG without interlacing."""
    data, at, packed = open(path, "rb").read(), 8, b""
    assert data[:8] == b"\x89PNG\r\n\x1a\n", path
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        assert struct.unpack(">I", data[at + 8 + size:at + 12 + size])[0] == zlib.crc32(kind + body)
        if kind == b"IHDR":
            width, height, depth, colour, _, _, interlace = struct.unpack(">IIBBBBB", body)
            assert depth == 8 and colour in (2, 6) and interlace == 0
        packed += body if kind == b"IDAT" else b""
        at += size + 12
    step, raw, rows = 3 if colour == 2 else 4, zlib.decompress(packed), []
    last = bytearray(width * step)
    for y in range(height):
        start = y * (width * step + 1)
        last = unfilter(raw[start], bytearray(raw[start + 1:start + 1 + width * step]), last, step)
        rows.append([tuple(last[x * step:x * step + 3]) for x in range(width)])
    return width, height, rows


def unfilter(kind, line, above, step):
    for i in range(len(line) if kind else 0):
        left, corner = (line[i - step], above[i - step]) if i >= step else (0, 0)
        up = above[i]
        p = left + up - corner
        paeth = min((abs(p - left), 0, left), (abs(p - up), 1, up), (abs(p - corner), 2, corner))[2]
        line[i] = (line[i] + (0, left, up, (left + up) // 2, paeth)[kind]) & 255
    return line


def page(path):
    """The data of a page, which must be well-formed and need nothing else."""
    text = open(path, encoding="utf-8").read()
    parser = Tags()
    parser.feed(text)
    parser.close()
    assert not parser.open, parser.open
    return json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', text, re.S)[1])


class Tags(html.parser.HTMLParser):
    """Every element is closed in order; none loads anything."""

    def __init__(self):
        super().__init__()
        self.open = []

    def handle_starttag(self, tag, attributes):
        assert not {"src", "href", "onerror", "onload"} & {name for name, _ in attributes}, attributes
        if tag not in ("meta", "br"):
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open and self.open.pop() == tag, tag


def floats(text):
    data = base64.b64decode(text, validate=True)
    return struct.unpack(f"<{len(data) // 4}f", data)


def colours(data, name):
    text = data["colours"][name]
    return [tuple(bytes.fromhex(text[i:i + 6])) for i in range(0, len(text), 6)]


def check_nodes(image, page_path, nodes_x, nodes_y):
    """Every node of the first slice of a page's table has its colour in the PNG of the same slice."""
    width, height, rows = png(image)
    data = page(page_path)
    values, steps = floats(data["table"]["values"][0])[:nodes_x * nodes_y], colours(data, "value")
    low, high = min(values), max(values)
    # picture/layout.c: the plot of a single panel, 600 x 450 units of 2 px or the next whole number a node.
    left, top = 2 * 66, 2 * (66 + 48)
    across, up = 1199 // (nodes_x - 1), 899 // (nodes_y - 1)
    for j in range(nodes_y):
        for i in range(nodes_x):
            v = values[j * nodes_x + i]
            step = int(255 * (v - low) / (high - low) + 0.5)
            shown = rows[top + up * (nodes_y - 1 - j)][left + across * i]
            near = [steps[k] for k in range(max(step - 1, 0), min(step + 2, 256))]
            assert shown in near, (i, j, v, shown, near)
    print(f"{nodes_x * nodes_y} nodes, {width} x {height}")


def write_npy(path, shape, value):
    """float32 values value(i) of entry i, in C order."""
    count = 1
    for n in shape:
        count *= n
    head = repr({"descr": "<f4", "fortran_order": False, "shape": tuple(shape)}).encode()
    head += b" " * (63 - (len(head) + 10) % 64) + b"\n"
    with open(path, "wb") as out:
        out.write(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head)
        out.write(struct.pack(f"<{count}f", *(value(i) for i in range(count))))


if __name__ == "__main__":
    globals()[sys.argv[1]](*(int(a) if a.isdigit() else a for a in sys.argv[2:]))
