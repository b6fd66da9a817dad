"""The order in which the unknowns of a step are eliminated, compared with one found by trial."""

import random

from piezo_sym.codegen.coupling import elimination


def fill(places, left, pivot):
    rows = {row for row, col in places if col == pivot and row in left} - {pivot}
    cols = {col for row, col in places if row == pivot and col in left} - {pivot}
    return {(row, col) for row in rows for col in cols}, len(rows) * len(cols)


def test_the_pivot_with_the_least_fill_in_comes_first():
    draw = random.Random(5)
    for size in (1, 2, 9, 30):
        cells = [(row, col) for row in range(size) for col in range(size)]
        given = {cell for cell in cells if draw.random() < 3 / size}
        places, left, order = given | {(n, n) for n in range(size)}, set(range(size)), []
        while left:
            order.append(min(left, key=lambda n: (fill(places, left, n)[1], n)))
            left.remove(order[-1])
            places |= fill(places, left, order[-1])[0]
        found = elimination(size, given)
        assert found.order == tuple(order)
        assert found.slots.keys() == places
