"""Words of a spec are printed as they are, never read as instructions to the terminal."""

import pytest


@pytest.mark.parametrize("words", ["[/x] hi", "[red]hi[/red]", "[link=http://a.example]hi[/link]"])
def test_a_doc_with_brackets_is_printed_as_it_is(spec_file, call, words):
    path = spec_file('doc = "supply voltage"', f'doc = "{words}"')
    answer = call("simulate", path, "--duration", "1e-4", "--times", "2")
    assert answer.code == 0
    assert words in answer.out
