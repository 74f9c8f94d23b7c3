"""The report generator: rows and a Jinja2 template make a page of Markdown, beside its plots and long tables, and one of HTML."""

import base64
import pathlib
import re

import jinja2
import markdown
import pandas

from host.lab.report.statistics import median_seconds, spread, times
from host.lab.rows import of, scene_name

STYLE = """
body { font: 16px/1.5 system-ui, sans-serif; max-width: 1100px; margin: 2em auto; padding: 0 1em;
       color: #1b1b1b; background: #fff; }
table { border-collapse: collapse; font-size: 13px; display: block; overflow-x: auto; }
td, th { padding: 3px 9px; border-bottom: 1px solid #ddd; white-space: nowrap; }
th { border-bottom: 2px solid #999; }
img { max-width: 100%; height: auto; }
code { background: #f3f3f3; padding: 0 3px; font-size: 13px; }
"""


# "HEAD = EXPRESSION :FORMAT": a column of a table. Without an expression the head names the row's value; without a
# format the cells are text.
COLUMN = re.compile(r"(?P<head>.*?)(?: = (?P<expression>.*?))?(?: :(?P<form>\S*))?$")
ENVIRONMENT = jinja2.Environment(loader=jinja2.FileSystemLoader(pathlib.Path(__file__).parent),
                                 undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True)


def number(value: object, form: str, dash: str = "-") -> str:
    """A cell: text as it is, numbers by `form`, `dash` where there is none."""
    if isinstance(value, str):
        return value
    return dash if value is None or pandas.isna(value) else format(value, form)


def cells_of(rows: list[dict], columns: tuple[str | list[str], ...], dash: str, comma: str) -> tuple[list[str], list[str], list[list[str]]]:
    """Heads, formats, and the cells of each row: `dash` where it has no value, thousands apart by `comma`.

    Columns see the row's values, `row`, and what templates see.
    """
    parts = [COLUMN.match(column) for column in (one for each in columns for one in ([each] if isinstance(each, str) else each))]
    forms = [part["form"] or "" for part in parts]
    values = [ENVIRONMENT.compile_expression(part["expression"] or part["head"].replace(" ", "_")) for part in parts]

    def cell(value: object, row: dict, form: str) -> str:
        try:
            return number(value(**row, row=row), form.replace(",", comma), dash)
        except (KeyError, TypeError, ZeroDivisionError, jinja2.UndefinedError):  # of something that the row does not have
            return dash

    return ([part["head"] for part in parts], forms,
            [[cell(value, row, form) for value, form in zip(values, forms, strict=True)] for row in rows])


def table(rows: list[dict], *columns: str | list[str]) -> str:
    """Markdown: a line for each row."""
    if not rows:
        return "(none)\n"
    heads, forms, cells = cells_of(rows, columns, "-", ",")
    return pandas.DataFrame(cells).to_markdown(
        index=False, headers=heads, disable_numparse=True, colalign=["right" if form else "left" for form in forms]) + "\n"


def save(file: pathlib.Path, rows: list[dict], *columns: str | list[str]) -> str:
    """A table that is too long for a page: CSV beside it. Gives the link to it."""
    heads, _, cells = cells_of(rows, columns, "", "")
    pandas.DataFrame(cells, columns=heads).to_csv(file, index=False)
    return f"[{file.name}]({file.name})"


def each(values: list, *columns: str) -> list[str]:
    """The columns for each of the values, which take the place of {}."""
    return [column.replace("{}", str(value)) for column in columns for value in values]


def rate(count: int, of_all: int) -> str:
    """Per million; 0 only where there was none."""
    value = 1e6 * count / of_all if of_all else 0.0
    return "-" if not of_all else "0" if not count else f"{value:,.0f}" if value >= 10 else f"{value:.2g}"


ENVIRONMENT.globals |= {"table": table, "each": each, "rate": rate, "scene_name": scene_name, "median_seconds": median_seconds,
                        "spread_percent": lambda row: 100 * spread(times(row))}


def render(template: str, folder: pathlib.Path, rows: list[dict], **values: object) -> str:
    """The Markdown of host/lab/report/<template>; `of(table, ...)` in it gives rows."""
    def figure(file: pathlib.Path, caption: str) -> str:
        return f"![{file.stem}]({file.relative_to(folder)})\n\n{caption}\n"

    def saved(name: str, rows: list[dict], *columns: str | list[str]) -> str:
        return save(folder / f"{name}.csv", rows, *columns)

    return ENVIRONMENT.get_template(template).render(
        values, figure=figure, saved=saved, of=lambda name, **wanted: of(rows, name, **wanted), machine=rows[0])


def measured(about: dict) -> str:
    """A report's last line: when and where it was measured."""
    return (f"\nMeasured by `{about['command']}` at commit {about['commit']} ({about['changed_files']} files changed), "
            f"{about['date']}, on {about['processor']}, {about['processors']} processors.\n")


def page(text: str, folder: pathlib.Path) -> str:
    """The report as one HTML page, pictures and all."""
    body = markdown.markdown(text, extensions=["tables"])

    def inside(match: re.Match) -> str:
        data = base64.b64encode((folder / match[1]).read_bytes()).decode()
        return f'src="data:image/png;base64,{data}"'

    body = re.sub(r'src="([^":]+\.png)"', inside, body)
    title = re.search(r"^# (.*)", text, re.MULTILINE)
    return (f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">\n'
            f"<title>{title[1] if title else ''}</title><style>{STYLE}</style></head>\n"
            f"<body>\n{body}\n</body></html>\n")


def write(text: str, folder: pathlib.Path, name: str = "report") -> None:
    """NAME.md and NAME.html."""
    (folder / f"{name}.md").write_text(text)
    (folder / f"{name}.html").write_text(page(text, folder))
