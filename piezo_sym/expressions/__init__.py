"""Laws as data: the language, the tree, its calculus and its spelling.

    tree         the nodes, and the walks that every stage shares
    parse        text to a tree; refuses what is too long, too deep or too large
    calculus     sums, products, derivatives; `integrals`, `energies` their antiderivatives
    dimensions   which parts must have equal units
    exact_eval   the exact value: a rational, or a ball that contains it
    text         a tree to text, in the language of a `Style`

Input and output: see each file.  Nothing here knows of elements or models.
"""
