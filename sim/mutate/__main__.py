"""`python3 -m sim.mutate BUILD`: how many single faults of the hardware its tests catch.

For each unit: a netlist with faults (netlist.py) runs the unit's own tests, the fastest first, with one fault after the other. A fault that
survives is no fault if ABC's equivalence check shows that it changes no output for any input. The remaining faults are listed, with their
lines in hw/. `--at-most PERCENT`: checks that no more survive, and stops when that is known."""

import argparse
import collections
import concurrent.futures
import dataclasses
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile

from sim.mutate.netlist import source


YOSYS = (sys.executable, "-m", "synth.yosys")  # followed by Yosys commands


@dataclasses.dataclass
class Outcome:
    """Numbers of a core's faults by outcome, and the surviving faults."""

    core: str
    faults: int
    equivalent: int = 0
    survivors: list[str] = dataclasses.field(default_factory=list)  # their lines in the .list file

    @property
    def caught(self) -> int:
        """Number of faults caught by the tests."""
        return self.faults - self.equivalent - len(self.survivors)


def run(command: list[object], **options: object) -> str:
    """Returns the output of `command`; raises CalledProcessError, with stderr shown, if it fails."""
    return subprocess.run([str(word) for word in command], check=True, text=True,
                          stdout=subprocess.PIPE, **options).stdout


def equivalent(netlist: pathlib.Path, fault: str) -> bool:
    """Returns whether Yosys and ABC prove that the module in NETLIST.il has the same outputs with this fault as without. False if they
    cannot decide."""
    # Registers and black-boxed modules are cut out: their inputs must be equal for any outputs. Only outputs that depend on the fault's
    # multiplexer are compared.
    number, module = re.search(r"-ctrl mutant \d+ (\d+) .*-module (\S+)", fault).groups()
    gates = (f"memory_map; async2sync; dffunmap; expose -evert-dff -evert c:*; cd {module}; "
             "select -set reached w:mutant %co*; delete -output o:* @reached %d; opt_clean; techmap; "
             "setundef -undriven -zero; aigmap; delete -input w:mutant; design -save both")
    with tempfile.TemporaryDirectory() as folder:
        write = "; ".join(f"design -load both; connect -set mutant 16'd{mutant}; write_aiger {folder}/{name}.aig"
                          for name, mutant in (("sound", 0), ("broken", number)))
        try:
            run(["prlimit", "--cpu=60:70", *YOSYS, f"read_rtlil {netlist}.il; {fault}; {gates}; {write}"])
        except subprocess.CalledProcessError as error:
            if error.returncode != -signal.SIGXCPU:
                raise
            return False
        # The first check decides most faults at once, and the others never. The second check takes seconds.
        for seconds, check in ((1, f"&r {folder}/sound.aig; &cec {folder}/broken.aig"), (10, f"cec {folder}/sound.aig {folder}/broken.aig")):
            said = subprocess.run(["prlimit", f"--cpu={seconds}", *YOSYS, "--abc", check], check=False, text=True,
                                  stdout=subprocess.PIPE, stderr=subprocess.DEVNULL).stdout
            if "Networks are" in said:
                return "Networks are equivalent" in said
    return False


def place(fault: str) -> str:
    """Describes a fault, given as a line of the .list file: FILE:LINE in hw/, mode, port and bit."""
    words = dict(re.findall(r"-(mode|port|portbit) (\S+)", fault))
    return f"{source(fault) or '?'} {words['mode']} {words['port']}[{words['portbit']}]"


def run_test(program: pathlib.Path, test: str, fault: int, limit: int) -> tuple[bool, float]:
    """Returns whether one test of a unit passes with this fault (0: no fault) within `limit` seconds of processor time, and these seconds."""
    child = subprocess.Popen(["prlimit", f"--cpu={limit}", program, f"--gtest_filter={test}", "--gtest_throw_on_failure"],
                             env=os.environ | {"RAYGATE_MUTANT": str(fault)}, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    return child.returncode == 0, usage.ru_utime + usage.ru_stime


def timed_tests(program: pathlib.Path) -> list[tuple[str, int]]:
    """Returns a unit's tests, fastest first, each with a limit of seconds: a test that runs longer has detected a fault, which makes it hang.
    Raises ValueError if a test fails without a fault."""
    suite, times = "", {}
    for line in run([program, "--gtest_list_tests"]).splitlines():
        if not line.startswith(" "):  # SUITE. or, in front of the first suite, a remark
            suite = line.split()[0]
            continue
        test = suite + line.split()[0]
        passes, times[test] = run_test(program, test, 0, 3600)
        if not passes:
            raise ValueError(f"{program}: {test} fails without a fault")
    return [(test, round(2 + 1.5 * times[test])) for test in sorted(times, key=lambda test: times[test])]


def test_survivors(program: pathlib.Path, faults: list[str]) -> list[int]:
    """Returns the numbers, from 1, of a unit's faults that its tests do not detect. Reports these and progress on stderr."""
    tests, survivors = timed_tests(program), []
    for fault, line in enumerate(faults, 1):
        if all(run_test(program, test, fault, limit)[0] for test, limit in tests):
            survivors.append(fault)
            print(f"{program.name}: fault {fault} not caught: {place(line)}", file=sys.stderr, flush=True)
        if fault % max(1, len(faults) // 10) == 0:
            print(f"{program.name}: {fault} of {len(faults)} faults tested, {len(survivors)} not caught", file=sys.stderr, flush=True)
    return survivors


def judge(core: str, programs: pathlib.Path, netlists: pathlib.Path, at_most: float) -> Outcome:
    """Runs a core's test with each of its faults. Then drops survivors that change no output, until at most `at_most` percent are left."""
    netlist = netlists / core
    faults = (netlists / f"{core}.list").read_text().splitlines()
    survived = test_survivors(programs / f"{core}_mutants", faults)
    outcome = Outcome(core, len(faults))
    for number in list(survived):
        if 100 * len(survived) <= at_most * len(faults):
            break
        if equivalent(netlist, faults[number - 1]):
            survived.remove(number)
            outcome.equivalent += 1
    outcome.survivors = [faults[number - 1] for number in survived]
    return outcome


def main() -> int:
    """Runs the command line. Returns 1 if too many faults survive or a program fails, 2 for errors that the user can correct."""
    parser = argparse.ArgumentParser(prog="sim.mutate", description=__doc__)
    parser.add_argument("build", type=pathlib.Path, help="CMake's build folder")
    parser.add_argument("cores", nargs="*", help="all if none")
    parser.add_argument("--at-most", type=float, default=0.0, metavar="PERCENT", help="see above")
    parser.add_argument("--jobs", type=int, default=2, help="at once (%(default)s)")
    given = parser.parse_args()
    netlists = given.build / "sim" / "mutate"
    cores = given.cores or sorted(file.stem for file in netlists.glob("*.list"))
    if not cores:
        print(f"sim.mutate: {netlists}: no netlists, expected core.list", file=sys.stderr)
        return 2
    for core in cores:
        if not (netlists / f"{core}.list").exists():
            print(f"sim.mutate: {netlists}: no netlist of {core}, expected {core}.list", file=sys.stderr)
            return 2
    outcomes = []
    print("| core | faults | caught | equivalent | survive |\n|---|---:|---:|---:|---:|", flush=True)
    try:
        with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
            for one in pool.map(lambda core: judge(core, given.build / "sim", netlists, given.at_most), cores):
                outcomes.append(one)
                print(f"| {one.core} | {one.faults} | {one.caught} | {one.equivalent} | {len(one.survivors)} |", flush=True)
    except (subprocess.CalledProcessError, FileNotFoundError, ValueError) as error:
        print(f"sim.mutate: {error}", file=sys.stderr)
        return 1
    faults = sum(one.faults for one in outcomes)
    survivors = [(one.core, fault) for one in outcomes for fault in one.survivors]
    if survivors and not given.at_most:
        print("\nSurvivors, by line:")
        lines = collections.Counter(f"{core}: {place(fault)}" for core, fault in survivors)
        for line, count in sorted(lines.items()):
            print(f"  {line}" + (f"  x {count}" if count > 1 else ""))
    share = 100.0 * len(survivors) / max(faults, 1)
    print(f"{faults} faults: {sum(one.caught for one in outcomes)} caught, "
          f"{sum(one.equivalent for one in outcomes)} proven to be none, {len(survivors)} survive")
    if faults == 0 or given.at_most and share > given.at_most:
        print(f"sim.mutate: {share:.1f} % survive, expected at most {given.at_most:g}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
