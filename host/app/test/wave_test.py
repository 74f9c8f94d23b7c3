"""`wave_test.py TRACE SAVE_FILE`: every signal of GTKWave's save file is in the trace (VCD); exit status 1 if not."""

import pathlib
import re
import sys

trace, save_file = (pathlib.Path(name).read_text() for name in sys.argv[1:])
scopes, there = [], set()
for word, rest in re.findall(r"\$(scope|upscope|var) (.*?) ?\$end", trace):
    if word == "scope":
        scopes.append(rest.split()[1])
    elif word == "upscope":
        scopes.pop()
    else:
        there.add(".".join([*scopes, "".join(rest.split()[3:])]))
shown = re.findall(r"^\+\{[^}]+\} (\S+)$", save_file, re.M)
missing = sorted(set(shown) - there)
print(f"{len(shown)} signals; missing: {', '.join(missing) or 'none'}")
sys.exit(1 if missing or len(shown) < 10 else 0)
