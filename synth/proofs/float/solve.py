"""`solve.py FILE [TERM ...]`: Bitwuzla's answer to an SMT-LIB file, as a line of JSON.

{"answer": "sat" or "unsat" or "unknown", "seconds": of processor time, "megabytes": at most,
"values": {TERM: its value in bits, where the answer is "sat"}}
"""

import json
import pathlib
import resource
import sys

import bitwuzla


def bits(term: bitwuzla.Term) -> str:
    """The value of a Boolean, a bit vector or a float, in bits."""
    if term.sort().is_bool():
        return str(int(term.value()))
    if term.sort().is_fp():
        return term.value(fp_as_tuple=False)
    return term.value(2)


def main() -> None:
    """Solves the file named first, and prints the terms named after it."""
    file, *terms = sys.argv[1:]
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
    usage = resource.getrusage(resource.RUSAGE_SELF)
    print(json.dumps({"answer": answer, "seconds": round(usage.ru_utime + usage.ru_stime, 1),
                      "megabytes": usage.ru_maxrss // 1024, "values": values}))


main()
