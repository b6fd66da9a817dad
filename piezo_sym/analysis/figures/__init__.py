"""The figures of the paper's section 4: the data of their curves, and their drawing.

Input: the generated module of ``piezo_stack``.  Output: for each an `xarray.Dataset` and a
Matplotlib figure.  Where the paper does not say what it shows, each file says what is shown here.

Notebook 06 and tests/analysis/test_claims.py say which claims of section 4 hold with Table 1.
"""

from piezo_sym.analysis.figures.figure import PaperFigure, data_of
from piezo_sym.analysis.figures.figure_4 import FIGURE_4
from piezo_sym.analysis.figures.lines import FIGURE_2, FIGURE_3, FIGURE_5, FIGURE_6

FIGURES = (FIGURE_2, FIGURE_3, FIGURE_4, FIGURE_5, FIGURE_6)

__all__ = ["FIGURES", "PaperFigure", "data_of"]
