"""Runs jobs, several at once, and prints their progress."""

import concurrent.futures
import dataclasses
import pathlib
import sys
import time
from collections.abc import Callable, Iterator

from synth import tools


@dataclasses.dataclass(frozen=True)
class Job:
    """A job. `work` returns the result, and whether the result was kept from an earlier run. `tell` describes the result in a line of
    progress; None prints no line."""

    name: str
    work: Callable[[], tuple[dict, bool]]
    tell: Callable[[dict], str] | None = None


def run(jobs: list[Job], workers: int, failures: list[str]) -> Iterator[dict | None]:
    """Yields the results in the order of `jobs`. For a job that fails, yields None and appends the error to `failures`.

    A job that raises ToolFailed does not stop the others; any other exception, such as MissingTool, stops all jobs.
    """
    start = time.monotonic()
    with concurrent.futures.ThreadPoolExecutor(workers) as pool:
        futures = [pool.submit(job.work) for job in jobs]
        try:
            for done, (job, future) in enumerate(zip(jobs, futures, strict=True), 1):
                try:
                    result, kept = future.result()
                    told = job.tell and f"{job.tell(result)}{' (kept)' * kept}"
                except tools.ToolFailed as error:
                    result, told = None, "FAILED"
                    failures.append(f"{job.name}: {error}")
                if told:
                    sys.stderr.write(f"[{done:{len(str(len(jobs)))}}/{len(jobs)} {time.monotonic() - start:4.0f} s] {job.name} {told}\n")
                yield result
        finally:
            pool.shutdown(wait=False, cancel_futures=True)


def run_all(jobs: list[Job], workers: int) -> tuple[list[dict | None], list[str]]:
    """Returns all results of `run`, and the failures."""
    failures: list[str] = []
    return list(run(jobs, workers, failures)), failures


def step(what: str, log: pathlib.Path, work: Callable[[], dict]) -> dict:
    """Prints which step begins and the name of its log file, then returns the result of `work`."""
    sys.stderr.write(f"{what}: {str(log).removeprefix(f'{tools.ROOT}/')}\n")  # print would write the newline separately, after another thread's text
    return work()


def status(failures: list[str]) -> int:
    """Prints the failures and returns the exit status."""
    for failure in failures:
        print("failed:", failure, file=sys.stderr)
    return 1 if failures else 0
