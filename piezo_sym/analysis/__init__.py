"""Analysis of results: the figures of the paper."""
