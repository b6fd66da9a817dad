"""Signs of laws that solvers of polynomials cannot decide: one real variable, rigorous intervals.

stage       from -> to                            by
cases       law -> guards and laws                the choices on parameters
            law -> terms of one scale each        expanding products of sums
reduce      term -> prefactors * f(s)             measuring the letter in parameters
decide      f -> PROVED | REFUTED | OPEN          windows, Taylor series at zeros, both ends
enclosures  tree, window -> interval and jet      intervals, jets, shift
certificate proof -> data                         for a checker
"""
