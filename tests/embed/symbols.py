#!/usr/bin/env python3
"""symbols.py PREFIX: what the shared libraries export is what the installed headers declare, and nothing else."""
import pathlib
import re
import subprocess
import sys

prefix = pathlib.Path(sys.argv[1])
words = set()
for header in prefix.glob("include/candela/**/*.hpp"):
    words.update(re.findall(r"\w+", header.read_text()))

exported = 0
strangers = []
for library in sorted(prefix.glob("lib*/libcandela-*.so")):
    listing = subprocess.run(["nm", "-D", "-C", "--defined-only", library], check=True, capture_output=True, text=True)
    for line in listing.stdout.splitlines():
        symbol = re.sub(r"^[0-9a-f]+ \w ", "", line)
        # The name: without the arguments of templates and functions, and without "typeinfo for" and the like.
        name = re.sub(r"\[abi:\w+\]", "", re.sub(r"<[^<>]*>", "", symbol)).split("(")[0].split(" ")[-1]
        parts = [part.lstrip("~") for part in name.split("::")]
        exported += 1
        if parts[0] != "candela" or not all(part in words or part.startswith("operator") for part in parts):
            strangers.append(f"{library.name}: {symbol}")
if strangers or exported < 50:
    sys.exit("\n".join(strangers + [f"{len(strangers)} of {exported} exported symbols are not in public headers"]))
print(f"{exported} exported symbols, all of them in public headers")
