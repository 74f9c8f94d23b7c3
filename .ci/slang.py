"""`slang.py FILE ...`: elaborates every module in these files as a top, with slang. Exits 1 for any warning or error."""

import pathlib
import re
import sys

from pyslang.driver import Driver

tops = [word for name in sys.argv[1:]
        for word in re.findall(r"^module (\w+)", pathlib.Path(name).read_text(), re.M)]
driver = Driver()
driver.addStandardArgs()
# -Wno-useless-cast: a cast that is useless with one parameter may be needed with another.
words = ["slang", "-Wextra", "-Werror", "-Wno-useless-cast", "-DSYNTHESIS", *sys.argv[1:]]
words += [word for top in tops for word in ("--top", top)]
good = (tops and driver.parseCommandLine(" ".join(words)) and driver.processOptions()
        and driver.parseAllSources() and driver.runFullCompilation(False))
print(f"{len(tops)} modules")
sys.exit(0 if good else 1)
