"""The figures of the paper's section 4, each in a file: its data, part by part, and its drawing.

Input: the generated module of ``piezo_stack``.  Output: an `xarray.Dataset` and a Matplotlib figure
each.  The paper does not say when its loops are taken; each file says what is shown, and why.
"""

from piezo_sym.analysis.figures.figure import PaperFigure, data_of
from piezo_sym.analysis.figures.figure_2 import FIGURE_2
from piezo_sym.analysis.figures.figure_3 import FIGURE_3
from piezo_sym.analysis.figures.figure_4 import FIGURE_4
from piezo_sym.analysis.figures.figure_5 import FIGURE_5
from piezo_sym.analysis.figures.figure_6 import FIGURE_6

FIGURES = (FIGURE_2, FIGURE_3, FIGURE_4, FIGURE_5, FIGURE_6)

__all__ = ["FIGURES", "PaperFigure", "data_of"]
