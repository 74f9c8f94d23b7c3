"""Runs jobs two at a time and says how far it is."""

import concurrent.futures
import dataclasses
import sys
import time
from collections.abc import Callable

from synth import tools


@dataclasses.dataclass(frozen=True)
class Job:
    """Something to run. `work` returns its result and whether that was kept from an earlier run; `tell` makes a few words of
    the result for the line of progress; without it there is none."""

    name: str
    work: Callable[[], tuple[dict, bool]]
    tell: Callable[[dict], str] | None = None


def run_all(jobs: list[Job], workers: int, ended: Callable[[int, dict | None], None] = lambda *_: None,
            ) -> tuple[list[dict | None], list[str]]:
    """The results in the order of `jobs` (None where one failed), and what went wrong. `ended` is called with the place and the
    result of each job as it ends.

    A missing tool stops everything; a design that fails leaves the others running.
    """
    results: list[dict | None] = [None] * len(jobs)
    failures = []
    start = time.monotonic()
    with concurrent.futures.ThreadPoolExecutor(workers) as pool:
        places = {pool.submit(job.work): place for place, job in enumerate(jobs)}
        try:
            for done, future in enumerate(concurrent.futures.as_completed(places), 1):
                job = jobs[places[future]]
                head = f"[{done:{len(str(len(jobs)))}}/{len(jobs)} {time.monotonic() - start:4.0f} s]"
                try:
                    result, kept = future.result()
                except tools.ToolFailed as error:
                    failures.append(f"{job.name}: {error}")
                    print(head, job.name, "FAILED", file=sys.stderr, flush=True)
                    ended(places[future], None)
                    continue
                results[places[future]] = result
                if job.tell:
                    print(head, job.name, job.tell(result), "(kept)" if kept else "", file=sys.stderr, flush=True)
                ended(places[future], result)
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise
    return results, failures
