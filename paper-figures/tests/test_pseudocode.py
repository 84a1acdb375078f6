"""The tables of pseudocode point at lines that are there, and leave none out."""

import importlib.util

import pytest

from mirrorfigures import paths, pseudocode

# Lines that only open a branch or say what is so.
WITHOUT_CODE = {4: {3, 5, 10, 13}, 7: {7}}


def paper(figure):
    file = paths.FIGURES / "patow-1995" / f"fig{figure:02}.py"
    spec = importlib.util.spec_from_file_location(f"fig{figure}", file)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.PAPER


@pytest.mark.parametrize("figure", [4, 7])
def test_every_line_of_the_paper_stands_in_the_shader(figure):
    found = pseudocode.places("z_buffered_map", figure)
    lines = set(range(1, len(paper(figure)) + 1))
    assert set(found) == lines - WITHOUT_CODE[figure]


@pytest.mark.parametrize("figure", [4, 7])
def test_a_place_is_the_code_below_a_comment_that_quotes_the_line(figure):
    folder = pseudocode.SHADERS / "z_buffered_map"
    for line, places in pseudocode.places("z_buffered_map", figure).items():
        quoted = paper(figure)[line - 1].strip().strip("{} ").split("{")[0]
        words = quoted.replace("<-", "").split()[:3]
        for file, number, code in places:
            lines = (folder / file).read_text(encoding="utf-8").splitlines()
            assert lines[number - 1].strip() == code and not code.startswith("//")
            above = " ".join(lines[max(0, number - 9) : number])
            assert all(word in above for word in words), (figure, line, words)
