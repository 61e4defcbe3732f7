#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes config/unicode.txt, the tokenizers' character data, from Python's unicodedata.

    make_unicode.py > config/unicode.txt

A line for each property: its name, then ranges "first-last" in hexadecimal; for mappings
"from=to+to" (ranges of equal shift "first-last=first to"), for classes "first-last=class". Hangul is computed, not listed.
"""
import sys
import unicodedata

LAST = 0x110000
HANGUL = range(0xAC00, 0xD7A4)


def ranges(holds):
    out, start = [], None
    for c in range(LAST + 1):
        if c < LAST and holds(c):
            start = c if start is None else start
        elif start is not None:
            out.append(f"{start:x}" if start == c - 1 else f"{start:x}-{c - 1:x}")
            start = None
    return out


def mappings(to):
    """One-to-one mappings of equal shift as ranges, others one by one."""
    out, run = [], None
    for c in range(LAST):
        mapped = to(c)
        if run and mapped and len(mapped) == 1 and c == run[1] + 1 and mapped[0] - c == run[2] - run[0]:
            run[1] = c
            continue
        if run:
            out.append(f"{run[0]:x}-{run[1]:x}={run[2]:x}" if run[1] > run[0] else f"{run[0]:x}={run[2]:x}")
            run = None
        if mapped and len(mapped) == 1:
            run = [c, c, mapped[0]]
        elif mapped:
            out.append(f"{c:x}=" + "+".join(f"{m:x}" for m in mapped))
    return out


def lower(c):
    text = chr(c).lower()
    return None if text == chr(c) else [ord(x) for x in text]


def decomposition(c):
    """Canonical, one step."""
    text = unicodedata.decomposition(chr(c))
    if not text or text.startswith("<") or c in HANGUL:
        return None
    return [int(x, 16) for x in text.split()]


def excluded(c):
    """Decomposes, but is never composed."""
    return decomposition(c) is not None and unicodedata.normalize("NFC", chr(c)) != chr(c)


def classes():
    out = []
    for k in sorted({unicodedata.combining(chr(c)) for c in range(LAST)} - {0}):
        out += [r + f"={k:x}" for r in ranges(lambda c: unicodedata.combining(chr(c)) == k)]
    return out


def category(*prefixes):
    return ranges(lambda c: unicodedata.category(chr(c)).startswith(prefixes))


def main():
    print(f"# Unicode {unicodedata.unidata_version}, written by scripts/make_unicode.py.")
    rows = {"letter": category("L"), "number": category("N"), "mark": category("Mn"),
            "punctuation": category("P"), "other": category("Cc", "Cf", "Co", "Cs"),
            "separator": category("Zs"),
            "space": ranges(lambda c: chr(c).isspace() and c not in range(0x1C, 0x20)),
            "lower": mappings(lower), "decompose": mappings(decomposition),
            "never_composed": ranges(excluded), "class": classes()}
    for name, items in rows.items():
        print(name, *items)


if __name__ == "__main__":
    sys.exit(main())
