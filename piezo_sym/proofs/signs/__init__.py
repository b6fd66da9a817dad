"""Signs of laws that solvers of polynomials cannot decide: one real variable, rigorous intervals.

stage       from -> to                            in
cases       law -> guards and laws                choices that parameters make
            law -> terms of one scale each        products of sums multiplied out
reduce      term -> prefactors * f(s)             a letter in units of parameters
decide      f -> PROVED | REFUTED | OPEN          windows, Taylor series at zeros, both ends
enclosures  tree, window -> interval and jet      intervals, jets, shift
certificate what was shown, as data               for a checker
"""
