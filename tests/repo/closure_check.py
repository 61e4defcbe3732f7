#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Proves that a set of archives knows nothing of some namespaces: no symbol, defined or wanted.

    closure_check.py NM NAMESPACE[,NAMESPACE...] ARCHIVE...
"""
import subprocess
import sys


def main():
    nm, namespaces, archives = sys.argv[1], sys.argv[2].split(","), sys.argv[3:]
    found, seen = [], 0
    for archive in archives:
        text = subprocess.run([nm, "--demangle", archive], capture_output=True, text=True,
                              check=True).stdout
        symbols = text.splitlines()
        seen += len(symbols)
        found += [f"{archive}: {symbol.strip()}" for symbol in symbols
                  if any(f"crossnav::{name}::" in symbol for name in namespaces)]
    if not seen:
        found.append("no symbol at all: wrong archives?")
    print("\n".join(found[:20]) if found else
          f"{len(archives)} archives, {seen} symbols, none of {', '.join(namespaces)}")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
