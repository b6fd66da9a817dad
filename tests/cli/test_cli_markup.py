"""Words of a spec are printed as they are, never read as instructions to the terminal."""

#: What the actuator's inputs are, and what a reader of markup would make something else of.
WORDS = {
    "supply voltage": "[/x] hi",
    "external force on the tip": "[red]hi[/red]",
    "temperature of the environment": "[link=http://a.example]hi[/link]",
}


def test_a_doc_with_brackets_is_printed_as_it_is(spec_file, call):
    path = spec_file()
    text = path.read_text(encoding="utf-8")
    for doc, words in WORDS.items():
        assert text.count(f'doc = "{doc}"') == 1
        text = text.replace(f'doc = "{doc}"', f'doc = "{words}"')
    path.write_text(text, encoding="utf-8")
    answer = call("simulate", path, "--duration", "1e-4", "--times", "2")
    assert answer.code == 0
    for words in WORDS.values():
        assert words in answer.out
