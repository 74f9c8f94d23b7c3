"""Reports: a Jinja2 template of Markdown, beside its plots, also as one HTML page."""

import base64
import pathlib
import re

import jinja2
import markdown
import pandas

STYLE = """
body { font: 16px/1.5 system-ui, sans-serif; max-width: 1100px; margin: 2em auto; padding: 0 1em;
       color: #1b1b1b; background: #fff; }
table { border-collapse: collapse; font-size: 13px; display: block; overflow-x: auto; }
td, th { padding: 3px 9px; border-bottom: 1px solid #ddd; white-space: nowrap; }
th { border-bottom: 2px solid #999; }
img { max-width: 100%; height: auto; }
code { background: #f3f3f3; padding: 0 3px; font-size: 13px; }
"""


def number(value: object, form: str) -> str:
    """A cell: text as it is, numbers by `form`, a dash where there is none."""
    if isinstance(value, str):
        return value
    return "-" if value is None or pandas.isna(value) else format(value, form)


def table(columns: dict[str, str], rows: list[list[object]]) -> str:
    """Markdown: the head of each column with the format of its numbers; "" is text."""
    if not rows:
        return "(none)\n"
    cells = [[number(value, form) for value, form in zip(row, columns.values(), strict=True)]
             for row in rows]
    return pandas.DataFrame(cells, columns=list(columns)).to_markdown(
        index=False, disable_numparse=True,
        colalign=["right" if form else "left" for form in columns.values()]) + "\n"


def render(template: str, folder: pathlib.Path, **values: object) -> str:
    """The Markdown of host/lab/report/<template>."""
    loader = jinja2.FileSystemLoader(pathlib.Path(__file__).parent)
    environment = jinja2.Environment(loader=loader, undefined=jinja2.StrictUndefined,
                                     trim_blocks=True, lstrip_blocks=True)
    environment.globals["figure"] = lambda file, caption: (
        f"![{caption}]({file.relative_to(folder)})\n\n{caption}\n")
    return environment.get_template(template).render(values)


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
