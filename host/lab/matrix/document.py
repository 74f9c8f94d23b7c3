"""A report as a list of blocks, written as Markdown and as one self-contained HTML page."""

import base64
import dataclasses
import html
import pathlib
import re

from synth import tables

STYLE = """
body { font: 16px/1.5 system-ui, sans-serif; max-width: 1100px; margin: 2em auto; padding: 0 1em;
       color: #1b1b1b; background: #fff; }
h1, h2, h3 { line-height: 1.2; margin-top: 1.6em; }
table { border-collapse: collapse; font-size: 13px; display: block; overflow-x: auto; }
td, th { padding: 3px 9px; border-bottom: 1px solid #ddd; text-align: left; white-space: nowrap; }
td.number { text-align: right; font-variant-numeric: tabular-nums; }
th { border-bottom: 2px solid #999; position: sticky; top: 0; background: #fff; }
figure { margin: 1.5em 0; } figure svg, figure img { max-width: 100%; height: auto; }
figcaption { color: #555; font-size: 14px; }
code { background: #f3f3f3; padding: 0 3px; font-size: 13px; }
"""


@dataclasses.dataclass(frozen=True)
class Heading:
    """A title of level 1, 2, ..."""

    level: int
    text: str


@dataclasses.dataclass(frozen=True)
class Text:
    """A paragraph; `code` and **strong** as in Markdown."""

    text: str


@dataclasses.dataclass(frozen=True)
class Table:
    """Cells are text; a column of numbers is set to the right."""

    header: list[str]
    rows: list[list[str]]


@dataclasses.dataclass(frozen=True)
class Figure:
    """A picture file beside the report."""

    file: pathlib.Path
    caption: str


Block = Heading | Text | Table | Figure


def markdown(blocks: list[Block], folder: pathlib.Path) -> str:
    """The report as Markdown; pictures are named relative to `folder`, where it will be."""
    parts = []
    for block in blocks:
        match block:
            case Heading(level, text):
                parts.append(f"{'#' * level} {text}\n")
            case Text(text):
                parts.append(f"{text}\n")
            case Table(header, rows):
                parts.append(tables.markdown(header, rows))
            case Figure(file, caption):
                parts.append(f"![{caption}]({file.relative_to(folder)})\n\n{caption}\n")
    return "\n".join(parts)


def _inline(text: str) -> str:
    text = html.escape(text, quote=False)
    text = re.sub(r"`([^`]+)`", r"<code>\1</code>", text)
    return re.sub(r"\*\*([^*]+)\*\*", r"<strong>\1</strong>", text)


def _number(cell: str) -> bool:
    return bool(re.match(r"[-+]?[\d.]|-$|$", cell))


def _table(table: Table) -> str:
    right = [all(_number(row[i]) for row in table.rows) for i in range(len(table.header))]
    head = "".join(f"<th>{_inline(cell)}</th>" for cell in table.header)
    rows = ["".join(f'<td class="number">{_inline(cell)}</td>' if right[i]
                    else f"<td>{_inline(cell)}</td>" for i, cell in enumerate(row))
            for row in table.rows]
    body = "\n".join(f"<tr>{row}</tr>" for row in rows)
    return f"<table><thead><tr>{head}</tr></thead><tbody>\n{body}\n</tbody></table>"


def _picture(file: pathlib.Path, caption: str) -> str:
    kind = {".svg": "svg+xml", ".png": "png"}[file.suffix]
    data = base64.b64encode(file.read_bytes()).decode()
    return (f'<img alt="{html.escape(caption)}" src="data:image/{kind};base64,{data}">')


def page(blocks: list[Block], title: str) -> str:
    """The report as one HTML page with everything in it."""
    parts = []
    for block in blocks:
        match block:
            case Heading(level, text):
                parts.append(f"<h{level}>{_inline(text)}</h{level}>")
            case Text(text):
                parts.append(f"<p>{_inline(text)}</p>")
            case Table():
                parts.append(_table(block))
            case Figure(file, caption):
                parts.append(f"<figure>{_picture(file, caption)}"
                             f"<figcaption>{_inline(caption)}</figcaption></figure>")
    return (f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">\n'
            f"<title>{html.escape(title)}</title><style>{STYLE}</style></head><body>\n"
            + "\n".join(parts) + "\n</body></html>\n")
