"""Generates reports from rows and a Jinja2 template: a Markdown page with plots and long tables."""

import csv
import pathlib
import re
import textwrap

import jinja2

from host.lab.rows import of, scene_name
from synth import tables

# A table column, "HEAD = EXPRESSION :FORMAT". By default, EXPRESSION is the row's value named HEAD. Without FORMAT, cells are text.
COLUMN = re.compile(r"(?P<head>.*?)(?: = (?P<expression>.*?))?(?: :(?P<form>\S*))?$")
ENVIRONMENT = jinja2.Environment(undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True)


def number(value: object, form: str, dash: str = "-") -> str:
    """Returns the text of a cell: strings unchanged, numbers in format `form`, `dash` for missing values."""
    if isinstance(value, str):
        return value
    return dash if value is None or value != value else format(value, form)


def cells_of(rows: list[dict], columns: tuple[str | list[str], ...], dash: str, comma: str) -> tuple[list[str], list[list[str]]]:
    """Returns the heads of the columns, and the cells of each row. `dash` replaces missing values; `comma` separates thousands.

    A column's expression can use the row's values by name, the whole row as `row`, and all names of templates.
    """
    parts = [COLUMN.match(column) for column in (one for each in columns for one in ([each] if isinstance(each, str) else each))]
    forms = [part["form"] or "" for part in parts]
    values = [ENVIRONMENT.compile_expression(part["expression"] or part["head"].replace(" ", "_")) for part in parts]

    def cell(value: object, row: dict, form: str) -> str:
        try:
            return number(value(**row, row=row), form.replace(",", comma), dash)
        except (KeyError, TypeError, ZeroDivisionError, jinja2.UndefinedError):  # the row lacks a value
            return dash

    return ([part["head"] for part in parts], [[cell(value, row, form) for value, form in zip(values, forms, strict=True)] for row in rows])


def table(rows: list[dict], *columns: str | list[str]) -> str:
    """Returns a Markdown table."""
    if not rows:
        return "(none)\n"
    heads, cells = cells_of(rows, columns, "-", ",")
    return tables.markdown(heads, cells)


def save(file: pathlib.Path, rows: list[dict], *columns: str | list[str]) -> str:
    """Writes a table that is too long for the page as a CSV file, and returns a link to it."""
    heads, cells = cells_of(rows, columns, "", "")
    with file.open("w", newline="") as out:
        csv.writer(out, lineterminator="\n").writerows([heads, *cells])
    return f"[{file.name}]({file.name})"


def each(values: list, *columns: str) -> list[str]:
    """Returns the columns once for each value, with {} replaced by the value."""
    return [column.replace("{}", str(value)) for column in columns for value in values]


def rate(count: int, of_all: int) -> str:
    """Returns `count` per million of `of_all`; "0" only if `count` is 0."""
    value = 1e6 * count / of_all if of_all else 0.0
    return "-" if not of_all else "0" if not count else f"{value:,.0f}" if value >= 10 else f"{value:.2g}"


ENVIRONMENT.globals |= {"table": table, "each": each, "rate": rate, "scene_name": scene_name}


def wrap(page: str) -> str:
    """Returns a Markdown page whose paragraphs and items have lines of at most 120 characters, without repeated empty lines."""
    def filled(paragraph: re.Match) -> str:
        text = paragraph[0]
        return textwrap.fill(" ".join(text.split()), 120, subsequent_indent="  " if text.startswith("* ") else "",
                             break_long_words=False, break_on_hyphens=False)

    # A paragraph or an item: lines up to one that begins a table, a heading, an image or an item.
    page = re.sub(r"^(?:\* |[^|#!*\s]|\*\*).*(?:\n(?!\* |[|#!])[^\n]+)*", filled, page, flags=re.MULTILINE)
    return re.sub(r"\n{3,}", "\n\n", page)


def render(template: str, folder: pathlib.Path, rows: list[dict], **values: object) -> str:
    """Returns the Markdown of a template, in which `of(table, ...)` returns rows."""
    def figure(file: pathlib.Path, caption: str) -> str:
        return f"![{file.stem}]({file.relative_to(folder)})\n\n{caption}\n"

    def saved(name: str, rows: list[dict], *columns: str | list[str]) -> str:
        return save(folder / f"{name}.csv", rows, *columns)

    return wrap(ENVIRONMENT.from_string(template).render(
        values, figure=figure, saved=saved, of=lambda name, **wanted: of(rows, name, **wanted), machine=rows[0])).rstrip() + "\n"


def measured(about: dict) -> str:
    """Returns the last line of a report: date, commit and machine."""
    return "\n" + wrap(f"Measured by `{about['command']}` at commit {about['commit']}{' and changed files' * bool(about['changed_files'])}, "
                       f"{about['date']}, on {about['processor']}, {about['processors']} processors.\n")
