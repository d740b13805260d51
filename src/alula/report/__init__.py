"""One self-contained HTML page that shows why to believe a result.

`render(ReportInput(...))` returns the page as text; `alula.base.files.write_whole` writes it.
The plots are drawn by `alula_plot.js`, static pictures are SVG made here.
"""

from alula.report.input import ReportInput
from alula.report.page import render

__all__ = ["ReportInput", "render"]
