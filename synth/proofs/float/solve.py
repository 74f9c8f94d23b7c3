"""`solve.py FILE SECONDS [TERM ...]` prints Bitwuzla's answer to an SMT-LIB file, as a line of JSON.

{"answer": "sat", "unsat", or "unknown" if SECONDS of processor time (0: no limit) are not enough,
"seconds": processor time, "megabytes": peak memory,
"values": {TERM: value in bits}, empty unless the answer is "sat"}
"""

import json
import math
import os
import pathlib
import resource
import signal
import sys

import bitwuzla


def bits(term: bitwuzla.Term) -> str:
    """Returns the value of a Boolean, a bit vector or a float, in bits."""
    if term.sort().is_bool():
        return str(int(term.value()))
    if term.sort().is_fp():
        return term.value(fp_as_tuple=False)
    return term.value(2)


def report(answer: str, values: dict[str, str], usage: resource.struct_rusage) -> None:
    """Prints the line of JSON."""
    print(json.dumps({"answer": answer, "seconds": round(usage.ru_utime + usage.ru_stime, 1),
                      "megabytes": usage.ru_maxrss // 1024, "values": values}), flush=True)


def main() -> None:
    """Solves the file and prints the values of the terms."""
    file, limit, *terms = sys.argv[1:]
    if float(limit):  # solve in a child process, which may exceed its time limit
        child = os.fork()
        if child:
            status = os.waitpid(child, 0)[1]
            if os.WIFSIGNALED(status) and os.WTERMSIG(status) == signal.SIGXCPU:
                report("unknown", {}, resource.getrusage(resource.RUSAGE_CHILDREN))
                status = 0
            sys.exit(os.waitstatus_to_exitcode(status) != 0)
        most = math.ceil(float(limit))
        resource.setrlimit(resource.RLIMIT_CPU, (most, most + 1))
    options = bitwuzla.Options()
    options.set(bitwuzla.Option.PRODUCE_MODELS, bool(terms))
    parser = bitwuzla.Parser(bitwuzla.TermManager(), options)
    parser.parse(pathlib.Path(file).read_text(), True, False)
    solver = parser.bitwuzla()
    answer = {bitwuzla.Result.SAT: "sat", bitwuzla.Result.UNSAT: "unsat"}.get(
        solver.check_sat(), "unknown")
    values = {}
    if answer == "sat":
        values = {term: bits(solver.get_value(parser.parse_term(term))) for term in terms}
    report(answer, values, resource.getrusage(resource.RUSAGE_SELF))


main()
