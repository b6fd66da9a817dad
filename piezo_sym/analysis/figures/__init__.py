"""The figures of the paper's section 4: the data of their curves, and their drawing.

Input: the generated module of ``piezo_stack``.  Output: for each an `xarray.Dataset` and a
Matplotlib figure.  Where the paper does not say what it shows, each file says what is shown here.

What section 4 claims, and what the model with Table 1 gives (tests/analysis/test_claims.py):

=========  =====================================  ================================================
figure     claim                                  found
=========  =====================================  ================================================
2          w_T is a dead zone, steeper where it   holds: 5, 1.43, 0.83, 0.59 ohm outside of it at
           is colder                              25, 30, 35, 40 degC
3          the slope of the loop changes with     holds: 15.7, 16.4, 16.9, 17.3 um/V at 25, 30, 35,
           T_e                                    40 degC (100 Hz, tenth period)
4          the static temperature rises with f,   holds up to a fold at 71.4, 69.4, 67.3, 57.5 Hz
           up to a frequency that depends on L    for 0.1, 0.5, 1, 5 mH, where it is 588 to 473 K
4          it falls beyond                        not as one curve: past the fold there is no cool
                                                  steady state.  The temperature runs away to
                                                  thousands of kelvin, and that state falls with f
5          T_e shifts the static displacement     holds: q = V a T_e/(T_0 k), 1.7 % for 5 K
6          the loop gets wider with f             holds after ten periods: 0.23, 1.15, 1.91, 2.38 mm
                                                  at 10, 50, 100, 200 Hz
6          and its slope decreases                holds after ten periods: 20.1, 18.9, 15.7, 8.5
                                                  um/V.  Not once settled: the cool steady states
                                                  at 10 and 50 Hz have 20.2 and 22.7 um/V, and
                                                  those at 100 and 200 Hz (2722 K, 1610 K) move
                                                  against the voltage
6          this combines the effects of 3 and 4   does not hold: heating makes loops steeper.  With
                                                  the temperature frozen the loop at 100 Hz is
                                                  flatter still (12.5 um/V): the lag of damper and
                                                  hysterons flattens it
1, 3, 6    the model has hysteresis               only with rate: width and area go to zero with f
                                                  (0.23, 0.061, 0.020 mm at 10, 3, 1 Hz),
                                                  where piezoelectric ceramics keep theirs
3 to 6     in accordance with reported results    not compared: the paper quotes no number of them
Table 1    values within standard ranges          a = 10 C/m moves the tip 2 mm at 100 V and couples
                                                  a^2/(a^2 + k C) = 0.98 of the energy; measured
                                                  stacks move 0.1 mm or less, and couple about half
=========  =====================================  ================================================
"""

from piezo_sym.analysis.figures.figure import PaperFigure, data_of
from piezo_sym.analysis.figures.figure_2 import FIGURE_2
from piezo_sym.analysis.figures.figure_4 import FIGURE_4
from piezo_sym.analysis.figures.figure_5 import FIGURE_5
from piezo_sym.analysis.figures.hysteresis import FIGURE_3, FIGURE_6

FIGURES = (FIGURE_2, FIGURE_3, FIGURE_4, FIGURE_5, FIGURE_6)

__all__ = ["FIGURES", "PaperFigure", "data_of"]
