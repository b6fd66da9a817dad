"""Laws as data: the language, the tree, its calculus and its spelling.

    tree         the nodes, and the walks that every stage shares
    parse        text to a tree; `lexer` and `size` refuse what is too long or too deep
    calculus     sums, products, derivatives; `integrals`, `energies` their antiderivatives
    dimensions   which parts must have equal units
    exact_eval   the value for certain: a rational, or a ball
    text         a tree to text, in the language of a `Style`

Input and output: each file says its own.  Nothing here knows of elements or models.
"""
